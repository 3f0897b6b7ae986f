//! A web server on this machine that gives files, whole or in part, and remembers what it was asked.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;

pub struct Server {
    port: u16,
    asked: Arc<Mutex<Vec<String>>>,
}

impl Server {
    /// Serves `files` by name until the process ends.
    pub fn new(files: &[(&str, Vec<u8>)]) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let files: HashMap<_, _> = files.iter().map(|(name, bytes)| (format!("/{name}"), bytes.clone())).collect();
        let asked = Arc::new(Mutex::new(Vec::new()));
        let log = asked.clone();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                log.lock().unwrap().push(answer(stream, &files).unwrap_or_default());
            }
        });
        Self { port, asked }
    }

    pub fn url(&self, name: &str) -> String {
        format!("http://127.0.0.1:{}/{name}", self.port)
    }

    /// The first lines of all requests so far.
    pub fn asked(&self) -> Vec<String> {
        self.asked.lock().unwrap().clone()
    }
}

/// Answers one request and returns its first line.
fn answer(mut stream: TcpStream, files: &HashMap<String, Vec<u8>>) -> std::io::Result<String> {
    let lines: Vec<_> = BufReader::new(&stream).lines().map_while(Result::ok).take_while(|l| !l.is_empty()).collect();
    let first = lines.first().cloned().unwrap_or_default();
    let (method, rest) = first.split_once(' ').unwrap_or_default();
    let name = rest.split(' ').next().unwrap_or_default();
    let Some(bytes) = files.get(name) else {
        stream.write_all(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")?;
        return Ok(first);
    };
    let range = lines.iter().find_map(|line| {
        let (from, to) = line
            .to_ascii_lowercase()
            .strip_prefix("range: bytes=")?
            .split_once('-')
            .map(|(a, b)| (a.parse::<usize>().unwrap_or(0), b.parse::<usize>().unwrap_or(usize::MAX)))?;
        Some((from.min(bytes.len()), to.saturating_add(1).min(bytes.len())))
    });
    let (from, to) = range.unwrap_or((0, bytes.len()));
    let status = match range {
        Some(_) => format!("206 Partial Content\r\nContent-Range: bytes {from}-{}/{}", to - 1, bytes.len()),
        None => "200 OK".to_owned(),
    };
    let length = to - from;
    write!(
        stream,
        "HTTP/1.1 {status}\r\nAccept-Ranges: bytes\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    )?;
    if method == "GET" {
        stream.write_all(&bytes[from..to])?;
    }
    Ok(first)
}
