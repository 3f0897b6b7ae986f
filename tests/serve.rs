//! `--serve`: jobs as lines, an answer each; the frames are those of an ordinary run, to the last byte.

use std::cell::Cell;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Output, Stdio};
use std::time::{Duration, Instant};

use clap::Parser;
use hachure::door::cli::Arguments;
use hachure::door::cli::jobs::JobShare;
use hachure::door::cli::progress::Progress;
use hachure::door::cli::talk::Talk;
use hachure::door::cli::work::JobWork;
use hachure::door::job::manifest::SequenceKey;
use hachure::door::job::serve;
use hachure::door::job::serve::{LONGEST, Refusal};
use hachure::door::job::{Frames, Job, Shard};
use hachure::error::Error;
use serde_json::{Value, json};

use crate::cli::{Place, stderr};
use crate::fly::{FLY, bytes, fly, frames, half_made, undisturbed, wait_for};

/// A process that serves, and its pipes.
pub struct Server {
    pub child: Child,
    jobs: Option<ChildStdin>,
    answers: Option<BufReader<ChildStdout>>,
}

impl Server {
    fn start(place: &Place, arguments: &[&str]) -> Self {
        let mut command = place.command(&[arguments, &["--serve"]].concat());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        let (jobs, answers) = (child.stdin.take(), child.stdout.take().map(BufReader::new));
        Self { child, jobs, answers }
    }

    fn send(&mut self, line: &str) {
        writeln!(self.jobs.as_mut().expect("open"), "{line}").expect("it reads");
    }

    fn answer(&mut self) -> Value {
        let mut line = String::new();
        self.answers.as_mut().expect("open").read_line(&mut line).expect("it answers");
        serde_json::from_str(&line).unwrap_or_else(|_| panic!("{line:?} is no answer"))
    }

    fn ask(&mut self, job: &Value) -> Value {
        self.send(&job.to_string());
        self.answer()
    }

    /// Ends its input; what it says and how it ends.
    fn end(mut self) -> Output {
        drop(self.jobs.take());
        self.child.wait_with_output().expect("it ends")
    }
}

/// Made, skipped and failed of an answer.
fn counts(answer: &Value) -> [u64; 3] {
    ["made", "skipped", "failed"].map(|key| answer[key].as_u64().expect("a number"))
}

#[test]
fn jobs_are_answered_by_their_ids_with_the_frames_of_a_run() {
    let place = Place::new();
    let whole = undisturbed(&place);
    let mut server = Server::start(&place, &fly("served/%05d.png", &[]));
    for (id, list, done) in [
        (json!(7), json!("3, 5-10"), [7, 0, 0]),
        (json!("again"), json!("10-11"), [1, 1, 0]),
        (json!({"deep": [1]}), json!(3), [0, 1, 0]),
    ] {
        let answer = server.ask(&json!({"id": id, "frames": list}));
        assert_eq!((&answer["id"], &answer["ok"], counts(&answer)), (&id, &json!(true), done), "{answer}");
        assert!(answer["ms"].as_f64() > Some(0.0) && answer["adapter"].is_string(), "{answer}");
        assert!(answer["exit"].is_null() && answer["error"].is_null(), "{answer}");
    }
    let merged = |missing: &str| {
        let merged = place.run(&["merge", "served"]);
        let said = String::from_utf8_lossy(&merged.stdout).into_owned();
        assert!(said.contains(missing), "{said}");
        merged.status.code()
    };
    assert_eq!(merged("in no manifest: 0-2,4,12-15"), Some(1));
    assert_eq!(counts(&server.ask(&json!({"id": 8, "frames": "0-15"}))), [8, 8, 0]);
    assert_eq!(merged("16 of 16 are whole, by 4 manifests"), Some(0));
    let output = server.end();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert_eq!(said.matches("adapter:").count(), 1, "opened once for all jobs: {said}");
    assert_eq!(bytes(&frames(&place.path("served"))), bytes(&whole));
}

#[test]
fn lines_are_read_as_jobs_or_refused_in_words() {
    let read = |line: &str| {
        let mut lines = line.as_bytes();
        let first = serve::next(&mut lines).expect("it can be read").expect("a line");
        assert_eq!(serve::next(&mut lines).expect("it can be read"), None, "{line}: one line");
        first
    };
    for line in ["\n\n {\"frames\": \"1-3\", \"id\": 0} \r\n\n", "{\"id\": 0, \"frames\": \"3,2,1\"}"] {
        let request = read(line).expect("a job");
        assert_eq!((request.id, request.frames.to_string()), (json!(0), "1-3".to_owned()));
    }
    for (line, id, words) in [
        ("draw it\n", json!(null), "the line is no job (expected value at line 1 column 1); want {\"id\": 7"),
        ("[1, 2]\n", json!(null), "the line is no job (invalid type: sequence, expected a map"),
        ("{\"id\": 1, \"fra", json!(null), "the line ends in the middle of a job"),
        ("{\"frames\": \"1\"}", json!(null), "the job has no id"),
        ("{\"id\": 1}", json!(1), "the job names no frames"),
        ("{\"id\": 1, \"frame\": \"1\"}", json!(1), "the job names no frames"),
        ("{\"id\": 1, \"frames\": \"1\", \"frame\": 2}", json!(1), "unknown key \"frame\""),
        ("{\"id\": \"a\", \"frames\": \"4-1\"}", json!("a"), "frames \"4-1\": 4-1 runs backwards; write 1-4"),
        ("{\"id\": 1, \"frames\": -3}", json!(1), "frames -3: want numbers and ranges from 0 on"),
        ("{\"id\": 1, \"frames\": [1]}", json!(1), "frames [1] are neither a number nor a list"),
        ("{\"id\": 1, \"frames\": \"0-9999999,0-9999999\"}", json!(1), "it names more than 10000000 frames"),
    ] {
        let Refusal { id: of, why } = read(line).expect_err(line);
        assert_eq!(of, id, "{line}");
        assert!(why.contains(words) && !why.contains('\n'), "{line}: {why}");
    }
    let deep = format!("{{\"id\": {}\n", "[".repeat(10_000));
    assert!(read(&deep).expect_err("it is too deep").why.contains("the line is no job (recursion limit"));
    assert!(serve::next(&mut &b"\xff\xfe\n"[..]).expect("it can be read").expect("a line").is_err());
    let long = format!("{{\"id\": \"{}\", \"frames\": 1}}\n", "x".repeat(LONGEST as usize));
    let both = format!("{long}{{\"id\": 2, \"frames\": 1}}");
    let mut lines = both.as_bytes();
    let refused = serve::next(&mut lines).expect("it can be read").expect("a line").expect_err("it is too long");
    assert!(refused.why.contains("longer than 1048576 bytes"), "{}", refused.why);
    let next = serve::next(&mut lines).expect("it can be read").expect("a line").expect("a job");
    assert_eq!(next.id, json!(2), "the line behind it");
}

#[test]
fn a_bad_job_is_answered_and_costs_itself_alone() {
    let place = Place::new();
    let whole = undisturbed(&place);
    fs::create_dir_all(place.path("bad/00005.png")).expect("a folder in the way");
    let mut server = Server::start(&place, &fly("bad/%05d.png", &[]));
    server.send("nonsense");
    let answer = server.answer();
    assert_eq!((&answer["id"], &answer["ok"], &answer["exit"]), (&json!(null), &json!(false), &json!(2)), "{answer}");
    for (list, exit, done, words) in [
        ("14-16", 2, [0, 0, 0], "there is no 16; the 16 frames count from 0 to 15"),
        ("4-6", 1, [2, 0, 1], "1 of 3 frames failed, the first with: bad/00005.png: cannot be written"),
    ] {
        let answer = server.ask(&json!({"id": list, "frames": list}));
        assert_eq!((&answer["id"], &answer["ok"], &answer["exit"]), (&json!(list), &json!(false), &json!(exit)));
        assert_eq!(counts(&answer), done, "{answer}");
        assert!(answer["error"].as_str().is_some_and(|error| error.contains(words)), "{answer}");
    }
    assert_eq!(counts(&server.ask(&json!({"id": 1, "frames": "3-4"}))), [1, 1, 0]);
    let output = server.end();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let made = frames(&place.path("bad"));
    assert_eq!(made.len(), 3);
    made.iter().for_each(|(name, (bytes, _))| assert_eq!(*bytes, whole[name].0, "{name}"));
}

#[test]
fn jobs_that_were_sent_are_answered_after_the_input_has_ended() {
    let place = Place::new();
    let mut server = Server::start(&place, &fly("sent/%05d.png", &[]));
    for n in 0..3 {
        server.send(&json!({"id": n, "frames": n}).to_string());
    }
    write!(server.jobs.as_mut().expect("open"), "{{\"id\": 3, \"frames").expect("it reads");
    drop(server.jobs.take());
    for n in 0..3 {
        let answer = server.answer();
        assert_eq!((&answer["id"], counts(&answer)), (&json!(n), [1, 0, 0]), "{answer}");
    }
    let cut = server.answer();
    assert_eq!((&cut["ok"], &cut["exit"]), (&json!(false), &json!(2)), "{cut}");
    assert!(cut["error"].as_str().is_some_and(|error| error.starts_with("the line ends in the middle")), "{cut}");
    assert_eq!(server.end().status.code(), Some(0));
    let made: Vec<String> = frames(&place.path("sent")).into_keys().collect();
    assert_eq!(made, ["00000.png", "00001.png", "00002.png"]);
}

/// A flight that lasts.
fn long_flight(folder: &str) -> Vec<&str> {
    let at = FLY.iter().position(|flag| *flag == "16").expect("its count");
    let mut flags = fly(folder, &[]);
    flags[at] = "1000";
    flags
}

#[test]
fn work_that_nobody_hears_of_ends_with_the_frame_at_hand() {
    let place = Place::new();
    // The driver is killed, or it reads no more.
    for (name, is_killed) in [("killed", true), ("deaf", false)] {
        let folder = place.path(name);
        let pattern = format!("{name}/%05d.png");
        let mut server = Server::start(&place, &long_flight(&pattern));
        server.send(&json!({"id": 1, "frames": "0-999"}).to_string());
        wait_for(&folder, 2, &mut server.child);
        drop(server.answers.take());
        let jobs = server.jobs.take().filter(|_| !is_killed);
        let output = server.child.wait_with_output().expect("it ends");
        drop(jobs);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(75), "{said}");
        let errors: Vec<&str> = said.lines().filter(|line| line.starts_with("error:")).collect();
        assert!(
            matches!(errors[..], [line] if line.contains("nobody reads the answers on standard output any more")),
            "{said}"
        );
        assert!((2..900).contains(&frames(&folder).len()), "it did not end at once");
        assert_eq!(half_made(&folder), Vec::<String>::new());
    }
}

#[test]
fn a_server_without_a_job_ends_in_silence_when_it_is_left() {
    let place = Place::new();
    for is_asked in [false, true] {
        let mut server = Server::start(&place, &fly("left/%05d.png", &[]));
        server.ask(&json!({"id": 1, "frames": 0}));
        if is_asked {
            let asked = Command::new("kill").args(["-TERM", &server.child.id().to_string()]).status();
            assert!(asked.expect("kill runs").success());
        } else {
            drop(server.answers.take());
        }
        let (jobs, left) = (server.jobs.take(), Instant::now());
        let output = server.child.wait_with_output().expect("it ends");
        drop(jobs);
        assert!(left.elapsed() < Duration::from_secs(20), "it stayed for {:?}", left.elapsed());
        assert_eq!(output.status.code(), Some(if is_asked { 75 } else { 0 }));
        assert!(!stderr(&output).contains("error"), "{}", stderr(&output));
    }
}

#[test]
fn a_server_that_is_asked_to_end_answers_with_75() {
    let place = Place::new();
    let mut server = Server::start(&place, &long_flight("asked/%05d.png"));
    server.send(&json!({"id": 1, "frames": "0-999"}).to_string());
    wait_for(&place.path("asked"), 2, &mut server.child);
    let asked = Command::new("kill").args(["-TERM", &server.child.id().to_string()]).status().expect("kill runs");
    assert!(asked.success());
    let answer = server.answer();
    assert_eq!((&answer["id"], &answer["ok"], &answer["exit"]), (&json!(1), &json!(false), &json!(75)), "{answer}");
    let [made, skipped, failed] = counts(&answer);
    assert_eq!((made as usize, skipped, failed), (frames(&place.path("asked")).len(), 0, 0), "{answer}");
    let jobs = server.jobs.take();
    let output = server.child.wait_with_output().expect("it ends");
    drop(jobs);
    assert_eq!(output.status.code(), Some(75), "{}", stderr(&output));
}

#[test]
fn a_lost_device_ends_the_process_and_leaves_the_rest_unanswered() {
    let folder = tempfile::tempdir().expect("a folder");
    let all = Frames::first(5);
    let job = |n: &u32| Job { number: *n, called: format!("frame {n}"), files: Vec::new() };
    let sequence = SequenceKey { of: "nothing".to_owned(), sequence: 1, job: 2, count: 5, fps: None, inks: None };
    let work = JobWork {
        sequence,
        share: JobShare { part: None, shard: Shard::WHOLE, frames: all.clone() },
        called: "frames",
        jobs: all.numbers().iter().map(job).collect(),
        folder: folder.path().to_owned(),
        dems: Vec::new(),
    };
    let talk = Arguments::parse_from(["hachure", "styles", "-q"]).talk();
    let asked: String = (0..5).map(|n| format!("{{\"id\": {n}, \"frames\": {n}}}\n")).collect();
    let answers = |lost_at: u32| {
        let (mut said, begun) = (Vec::new(), Cell::new(0));
        let make = |work: &JobWork, _: &Progress, _: &Talk| {
            begun.set(begun.get() + 1);
            match work.jobs[0].number {
                // One that fails by itself is answered, and that is all.
                1 => Err(Error::Gpu { what: "too many".to_owned() }),
                n if n == lost_at => Err(Error::DeviceLost { what: "it fell off the bus".to_owned() }),
                _ => Ok(()),
            }
        };
        let ended = hachure::door::cli::serve::run(&work, &talk, asked.as_bytes(), &mut said, make);
        let text = String::from_utf8(said).expect("text");
        let exits = text.lines().map(|line| serde_json::from_str::<Value>(line).expect("JSON")["exit"].as_u64());
        (ended, exits.collect::<Vec<_>>(), begun.get())
    };
    let (ended, exits, begun) = answers(3);
    assert!(matches!(ended, Err(Error::DeviceLost { .. })), "{ended:?}");
    assert_eq!((exits, begun), (vec![None, Some(1), None, Some(75)], 4), "the last one is the driver's to repeat");
    let (ended, exits, _) = answers(9);
    assert!(ended.is_ok());
    assert_eq!(exits, [None, Some(1), None, None, None]);
}

#[test]
fn drawings_of_a_list_are_served_by_their_numbers() {
    let place = Place::new();
    let drawing = |name: &str, eye: &str| {
        format!(
            "[[drawing]]\ndem = \"hill.asc\"\noutput = \"{name}.png\"\nsize = \"80x40\"\nhachures = \"none\"\n{eye}\n"
        )
    };
    let list = |folder: &str| {
        let views = ["eye = \"500195,4000020,+30\"", "eye = \"500020,4000195,+30\"\nazimuth = 90"];
        let [south, west] = [0, 1].map(|i| drawing(&format!("{folder}/{i}"), views[i]));
        let plan =
            format!("[[drawing]]\ndem = \"hill.asc\"\noutput = \"{folder}/2.svg\"\nplan = true\nscale = \"1:5000\"\n");
        fs::write(place.path(&format!("{folder}.toml")), south + &west + &plan).expect("a file");
    };
    list("whole");
    list("served");
    let output = place.run(&["batch", "whole.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let mut server = Server::start(&place, &["batch", "served.toml"]);
    assert_eq!(counts(&server.ask(&json!({"id": 1, "frames": "1-2"}))), [2, 0, 0]);
    assert!(!place.path("served/0.png").exists() && place.path("served/1.png").exists(), "those that were asked for");
    assert_eq!(counts(&server.ask(&json!({"id": 2, "frames": "0-2"}))), [1, 2, 0]);
    let beyond = server.ask(&json!({"id": 3, "frames": 3}));
    assert!(
        beyond["error"].as_str().is_some_and(|error| error.contains("the 3 drawings count from 0 to 2")),
        "{beyond}"
    );
    assert_eq!(server.end().status.code(), Some(0));
    for name in ["0.png", "1.png", "2.svg"] {
        let [whole, served] = ["whole", "served"].map(|folder| fs::read(place.path(folder).join(name)).expect(name));
        assert!(whole == served, "{name} differs");
    }
}

#[test]
fn what_cannot_be_served_is_told_before_any_job() {
    let place = Place::new();
    let refused = |more: &[&str], code: i32, words: &str| {
        let output = place.command(&fly("a/%05d.png", &[&["--serve"], more].concat())).stdin(Stdio::null()).output();
        let output = output.expect("it runs");
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{more:?}: {said}");
        assert!(said.contains(words), "{more:?} should say `{words}`: {said}");
        assert!(output.stdout.is_empty(), "no answer without a job");
    };
    for with in
        [&["--frames", "1"][..], &["--shard", "0/2"], &["--list"], &["--progress", "json"], &["--video", "a.gif"]]
    {
        refused(with, 2, "cannot be used with");
    }
    refused(&["--adapter", "99"], 1, "no GPU adapter: none has the number 99; there is: 0 ");
    refused(&["--style", "none"], 2, "--style");
    assert_eq!(place.written(), Vec::<String>::new());
    let list = "[[drawing]]\ndem = \"hill.asc\"\noutput = \"a.png\"\nsize = \"80x40\"\n";
    fs::write(place.path("list.toml"), list).expect("a file");
    let output = place.run(&["batch", "list.toml", "--serve", "--adapter", "99"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("none has the number 99"), "{}", stderr(&output));
    let unreadable = place
        .command(&fly("a/%05d.png", &["--serve"]))
        .stdin(fs::File::open(Path::new("/")).expect("it is there"))
        .output();
    let output = unreadable.expect("it runs");
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("standard input: it cannot be read"), "{}", stderr(&output));
}

#[test]
fn a_server_that_is_left_while_it_starts_ends() {
    let place = Place::new();
    let mut server = Server::start(&place, &fly("early/%05d.png", &[]));
    drop(server.answers.take());
    let began = Instant::now();
    while server.child.try_wait().expect("a child").is_none() {
        assert!(began.elapsed() < Duration::from_secs(20), "it is still there");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(frames(&place.path("early")).is_empty());
}
