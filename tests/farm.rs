//! The farm files of the examples, run: by Ray and by Open Job Description's own runner, by stand-ins for Slurm and Kubernetes.

use std::collections::HashMap;
use std::fs;
use std::io::{Write, stderr as own_stderr};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::{current, sleep};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::cli::{Place, stderr};
use crate::fly::{Files, bytes, frames, half_made, wait_for};

/// Longest wait for what is to happen soon.
const SOON: Duration = Duration::from_secs(60);
const HACHURE: &str = env!("CARGO_BIN_EXE_hachure");

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/farm").join(name)
}

/// A program of the folder into which `tests/setup.sh` installs what farms run on. `None`, with a line that says so, without it.
fn tool(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/ray/bin").join(name);
    if !path.exists() {
        let _ = writeln!(own_stderr(), "SKIP {}: install ray and openjd-cli", current().name().unwrap_or("test"));
        return None;
    }
    Some(path)
}

/// A flight over the hill of a place, in words that farms pass on, with the place's own paths.
struct Flight {
    place: Place,
    count: u32,
}

impl Flight {
    fn new(count: u32) -> Self {
        let place = Place::new();
        let keys = |east: f64| format!("[[key]]\nplace = [{east}, 4000080, \"+40\"]\nazimuth = 20\naltitude = -10\n");
        fs::write(place.path("path.toml"), keys(500_090.0) + &keys(500_300.0)).expect("a file");
        Self { place, count }
    }

    fn text(&self, name: &str) -> String {
        self.place.path(name).to_string_lossy().into_owned()
    }

    /// The arguments of `hachure`, with frames of so many pixels in a folder.
    fn arguments(&self, size: &str, folder: &str) -> Vec<String> {
        let (dem, path, out) = (self.text("hill.asc"), self.text("path.toml"), self.text(folder) + "/%05d.png");
        let count = self.count.to_string();
        let flags = ["fly", &dem, "--path", &path, "--count", &count, "--size", size, "--output", &out];
        flags.into_iter().chain(["--hachures", "none", "--creases", "none"]).map(str::to_owned).collect()
    }

    /// One process draws all.
    fn alone(&self, size: &str) -> Files {
        let output = Command::new(HACHURE).args(self.arguments(size, "alone")).output().expect("hachure runs");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let frames = frames(&self.place.path("alone"));
        assert_eq!(frames.len() as u32, self.count);
        frames
    }

    fn merged(&self, folder: &str) -> Option<i32> {
        self.place.run(&["merge", folder]).status.code()
    }
}

/// Numbers of processes that serve frames into a folder, each with its parent's.
fn servers(folder: &str) -> HashMap<u32, u32> {
    let processes = fs::read_dir("/proc").expect("processes").flatten();
    let numbers = processes.filter_map(|entry| entry.file_name().to_string_lossy().parse::<u32>().ok());
    let serves = |pid: &u32| {
        let line = fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default();
        let words: Vec<&[u8]> = line.split(|byte| *byte == 0).collect();
        words.first() == Some(&HACHURE.as_bytes())
            && words.contains(&&b"--serve"[..])
            && words.iter().any(|word| word.starts_with(folder.as_bytes()))
    };
    let parent = |pid: u32| {
        let stat = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
        // Behind its name, which may hold anything: state, parent.
        let parent = stat.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse().ok()?;
        Some((pid, parent))
    };
    numbers.filter(serves).filter_map(parent).collect()
}

fn kill(pid: u32) {
    let killed = Command::new("kill").args(["-KILL", &pid.to_string()]).status().expect("kill runs");
    assert!(killed.success(), "{pid} was gone already");
}

/// Waits until something is so.
fn until(what: &str, is_so: impl Fn() -> bool) {
    let began = Instant::now();
    while !is_so() {
        assert!(began.elapsed() < SOON, "not within a minute: {what}");
        sleep(Duration::from_millis(10));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn ray_draws_the_same_frames_whatever_is_killed() {
    let Some(python) = tool("python") else { return };
    let flight = Flight::new(160);
    let whole = flight.alone("320x180");
    let (folder, text) = (flight.place.path("ray"), flight.text("ray"));
    let mut driver = Command::new(python);
    driver.arg(example("ray_driver.py")).args([
        "--frames",
        "0-159",
        "--range",
        "5",
        "--workers",
        "2",
        "--no-gpu",
        "--",
        HACHURE,
    ]);
    driver.args(flight.arguments("320x180", "ray")).current_dir(flight.place.path("."));
    driver
        .env("RAY_USAGE_STATS_ENABLED", "0")
        .env("RAY_AUTH_MODE", "disabled")
        .env("RAY_TMPDIR", flight.place.path("logs"));
    let mut driver = driver.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("python starts");
    wait_for(&folder, 10, &mut driver);
    let first = *servers(&text).keys().next().expect("a hachure that serves");
    kill(first);
    wait_for(&folder, 40, &mut driver);
    until("two serve again", || servers(&text).len() == 2);
    let (left, actor) = servers(&text).into_iter().next().expect("another one");
    let at_work = frames(&folder).len();
    kill(actor);
    until("the hachure of an actor that is gone is gone too", || !servers(&text).contains_key(&left));
    let output = driver.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(at_work < 150, "the actor was killed after its work: {at_work} frames were there");
    let answers: Vec<Value> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("{line} is no answer")))
        .collect();
    assert_eq!(answers.len(), 32, "an answer a range");
    assert!(answers.iter().all(|answer| answer["ok"] == true), "{answers:?}");
    until("none is left", || servers(&text).is_empty());
    assert_eq!(bytes(&frames(&folder)), bytes(&whole));
    assert!(half_made(&folder).len() <= 2, "at most one half-made file of a kill");
    assert_eq!(flight.merged("ray"), Some(0));
}

#[test]
fn open_job_description_runs_its_template() {
    let Some(openjd) = tool("openjd") else { return };
    let flight = Flight::new(6);
    let run = |folder: &str, dem: &str| {
        let values = [
            ("Hachure", HACHURE.to_owned()),
            ("Dem", flight.text(dem)),
            ("Path", flight.text("path.toml")),
            ("Count", "6".to_owned()),
            ("Frames", "0-5".to_owned()),
            ("Range", "4".to_owned()),
            ("Out", flight.text(folder)),
            ("Size", "160x90".to_owned()),
        ];
        let mut command = Command::new(&openjd);
        command
            .arg("run")
            .arg(example("openjd_template.yaml"))
            .args(["--step", "Fly"])
            .current_dir(flight.place.path("."));
        command.args(values.iter().flat_map(|(key, value)| ["-p".to_owned(), format!("{key}={value}")]));
        let output = command.output().expect("openjd runs");
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (code, said) = run("openjd", "hill.asc");
    assert_eq!(code, Some(0), "{said}");
    for words in [
        "Frames(CHUNK[INT]) = 0-2",
        "Frames(CHUNK[INT]) = 3-5",
        "openjd_progress: 33.333",
        "openjd_progress: 100",
        "openjd_status: 2 of 3,",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let arguments = flight.arguments("160x90", "alone");
    let alone = Command::new(HACHURE).args(&arguments[..arguments.len() - 4]).output().expect("hachure runs");
    assert_eq!(alone.status.code(), Some(0), "{}", stderr(&alone));
    assert_eq!(bytes(&frames(&flight.place.path("openjd"))), bytes(&frames(&flight.place.path("alone"))));
    assert_eq!(flight.merged("openjd"), Some(0));
    let (code, said) = run("none", "none.asc");
    assert_ne!(code, Some(0), "{said}");
    assert!(said.contains("openjd_fail: ") && said.contains("none.asc: there is no such file"), "{said}");
}

/// A task of an array of three, as Slurm starts it, with stand-ins for what Slurm has on its machines.
fn task(flight: &Flight, index: u32, restarts: u32) -> Command {
    let bin = flight.place.path("bin");
    if !bin.exists() {
        fs::create_dir(&bin).expect("a folder");
        std::os::unix::fs::symlink(HACHURE, bin.join("hachure")).expect("a link");
        let scontrol = bin.join("scontrol");
        fs::write(&scontrol, "#!/bin/sh\necho \"$@\" >>\"$(dirname \"$0\")/requeued\"\n").expect("a file");
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        fs::set_permissions(&scontrol, mode).expect("its mode");
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([bin].into_iter().chain(std::env::split_paths(&path))).expect("paths");
    let mut command = Command::new("bash");
    command.arg(example("slurm_array.sh")).args(flight.arguments("160x90", "slurm")).env("PATH", path);
    command.env("SLURM_ARRAY_JOB_ID", "4242").env("SLURM_ARRAY_TASK_ID", index.to_string());
    command
        .env("SLURM_ARRAY_TASK_COUNT", "3")
        .env("SLURM_ARRAY_TASK_MIN", "0")
        .env("SLURM_RESTART_COUNT", restarts.to_string());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Starts a task and asks it to end at its first frame, as Slurm does before its time is up.
fn cut_short(flight: &Flight, index: u32, restarts: u32) -> Output {
    let folder = flight.place.path("slurm");
    let before = frames(&folder).len();
    let mut child = task(flight, index, restarts).spawn().expect("bash starts");
    wait_for(&folder, before + 1, &mut child);
    let asked = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill runs");
    assert!(asked.success());
    child.wait_with_output().expect("it ends")
}

#[test]
#[cfg(unix)]
fn slurm_puts_a_task_back_that_was_asked_to_end() {
    let flight = Flight::new(120);
    let whole = flight.alone("160x90");
    let requeued = || fs::read_to_string(flight.place.path("bin/requeued")).unwrap_or_default();
    let run = |index: u32, restarts: u32| task(&flight, index, restarts).output().expect("bash runs");
    let output = run(0, 0);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let output = cut_short(&flight, 1, 0);
    assert_eq!(output.status.code(), Some(0), "Slurm takes it from here: {}", stderr(&output));
    assert_eq!(requeued(), "requeue 4242_1\n", "{}", stderr(&output));
    let drawn = frames(&flight.place.path("slurm")).len();
    assert!((41..80).contains(&drawn), "{drawn}: it ended in the middle");
    let output = run(1, 1);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let output = cut_short(&flight, 2, 3);
    assert_eq!(output.status.code(), Some(75), "three times is enough: {}", stderr(&output));
    assert_eq!(flight.merged("slurm"), Some(1));
    assert_eq!(run(2, 0).status.code(), Some(0));
    let mut wrong = task(&flight, 2, 0);
    assert_eq!(wrong.arg("--wrong").output().expect("bash runs").status.code(), Some(2));
    assert_eq!(requeued(), "requeue 4242_1\n", "wrong usage stays wrong");
    assert_eq!(bytes(&frames(&flight.place.path("slurm"))), bytes(&whole));
    assert_eq!(flight.merged("slurm"), Some(0));
}

#[test]
fn kubernetes_shares_out_all_frames() {
    let Some(python) = tool("python") else { return };
    let read = "import json, sys, yaml; print(json.dumps(yaml.safe_load(open(sys.argv[1]))))";
    let output =
        Command::new(python).args(["-c", read]).arg(example("kubernetes_job.yaml")).output().expect("python runs");
    let job: Value = serde_json::from_slice(&output.stdout).expect("a job");
    let (spec, pod) = (&job["spec"], &job["spec"]["template"]["spec"]);
    let container = &pod["containers"][0];
    assert_eq!((&spec["completionMode"], &pod["restartPolicy"]), (&Value::from("Indexed"), &Value::from("Never")));
    let shards = &container["env"][0];
    assert_eq!(
        (&shards["name"], &shards["value"]),
        (&"HACHURE_SHARDS".into(), &spec["completions"].to_string().into())
    );
    let codes = &spec["podFailurePolicy"]["rules"][1]["onExitCodes"];
    assert_eq!((&codes["operator"], &codes["values"][0]), (&"NotIn".into(), &75.into()));
    assert_eq!(codes["containerName"], container["name"]);
    let flight = Flight::new(200);
    let words = ["command", "args"].map(|key| container[key].as_array().expect("words").clone()).concat();
    let here = |word: &Value| match word.as_str().expect("text") {
        "hachure" => HACHURE.to_owned(),
        "25000" => "200".to_owned(),
        "1920x1080" => "160x90".to_owned(),
        "/shared/my-dem.tif" => flight.text("hill.asc"),
        "/shared/route.gpx" => flight.text("path.toml"),
        word => word.replace("/shared", &flight.text(".")),
    };
    let words: Vec<String> = words.iter().map(here).collect();
    for index in ["0", "99"] {
        let mut pod = Command::new(&words[0]);
        pod.args(&words[1..])
            .env("JOB_COMPLETION_INDEX", index)
            .env("HACHURE_SHARDS", shards["value"].as_str().expect("text"));
        let output = pod.output().expect("hachure runs");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let drawn: Vec<String> = frames(&flight.place.path("frames")).into_keys().collect();
    assert_eq!(drawn, ["00000.png", "00001.png", "00198.png", "00199.png"]);
}
