//! Jobs that come one by one: a line of JSON each, `{"id": 7, "frames": "3,5-10"}`.
//!
//! The id is any JSON and comes back with the answer; frames are a number or a [list](Frames). A line that is no job is refused
//! in words, and the next one is read. Cost: at most [`LONGEST`] bytes of a line are held.

use std::io::{self, BufRead, Read};

use serde_json::{Map, Value};

use super::Frames;

/// Longest line, bytes.
pub const LONGEST: u64 = 1 << 20;
/// What a line holds.
pub const WANTED: &str = r#"{"id": 7, "frames": "3,5-10"}"#;

/// What somebody asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// What the answer is known by.
    pub id: Value,
    /// The frames or drawings to make.
    pub frames: Frames,
}

/// A line that is no job.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// The id, if it has one.
    pub id: Value,
    /// Why, in words.
    pub why: String,
}

/// The next job, or what is no job; `None` at the end. Empty lines are passed over.
///
/// # Errors
/// The system's, where the lines cannot be read.
pub fn next(lines: &mut impl BufRead) -> io::Result<Option<Result<Request, Refusal>>> {
    loop {
        let mut line = Vec::new();
        if lines.by_ref().take(LONGEST).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        if line.len() as u64 == LONGEST && line.last() != Some(&b'\n') {
            lines.skip_until(b'\n')?;
            let why = format!("the line is longer than {LONGEST} bytes; send less at a time");
            return Ok(Some(Err(Refusal { id: Value::Null, why })));
        }
        if !line.trim_ascii().is_empty() {
            return Ok(Some(Request::parse(&line)));
        }
    }
}

impl Request {
    fn parse(line: &[u8]) -> Result<Self, Refusal> {
        let refused = |id: &Value, why: String| Refusal { id: id.clone(), why: format!("{why}; want {WANTED}") };
        let mut keys: Map<String, Value> = serde_json::from_slice(line).map_err(|error| {
            let why = match error.is_eof() {
                true => "the line ends in the middle of a job".to_owned(),
                false => format!("the line is no job ({error})"),
            };
            refused(&Value::Null, why)
        })?;
        let id = keys.remove("id").unwrap_or_default();
        let frames = match keys.remove("frames") {
            Some(Value::String(list)) => list.parse().map_err(|why| refused(&id, format!("frames {list:?}: {why}")))?,
            Some(Value::Number(number)) => {
                number.to_string().parse().map_err(|why| refused(&id, format!("frames {number}: {why}")))?
            }
            Some(other) => return Err(refused(&id, format!("frames {other} are neither a number nor a list"))),
            None => return Err(refused(&id, "the job names no frames".to_owned())),
        };
        match keys.keys().next() {
            Some(key) => Err(refused(&id, format!("unknown key {key:?}"))),
            None if id.is_null() => Err(refused(&id, "the job has no id".to_owned())),
            None => Ok(Self { id, frames }),
        }
    }
}
