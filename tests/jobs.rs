//! Lists of frames, shards, names of files, seals, manifests: what jobs are told apart and found again by.

use std::cell::Cell;
use std::collections::HashSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use hachure::cache::Cache;
use hachure::door::job::manifest::SequenceKey;
use hachure::door::job::name::Naming;
use hachure::door::job::{Frames, Job, JobFile, Manifest, Merged, Pattern, Shard};
use hachure::ink::Seal;

#[test]
fn lists_of_frames_read_as_farms_write_them() {
    let cases = [
        ("3, 5-10, 47-50", "3,5-10,47-50"),
        ("0", "0"),
        ("0-4:2", "0,2,4"),
        ("7,3,5,4,3", "3-5,7"),
        (" 1 - 3 ", "1-3"),
    ];
    for (text, read) in cases {
        let frames: Frames = text.parse().expect("frames");
        assert_eq!(frames.to_string(), read, "{text}");
        assert_eq!(frames.to_string().parse::<Frames>().expect("as it is written"), frames, "{text}");
    }
    for text in ["", ",", "3,", "-1", "5-", "a", "1.5", "3-1", "1-5:0", "1:2", "0-9999999999", "1-2-3", "4000000000"] {
        assert!(text.parse::<Frames>().is_err(), "{text}");
    }
    assert_eq!("9-5".parse::<Frames>().expect_err("backwards"), "9-5 runs backwards; write 5-9");
}

#[test]
fn shards_share_every_frame_once_and_evenly() {
    for (frames, count) in [(0, 3), (1, 4), (10, 3), (1000, 7), (7, 7), (12, 5)] {
        let all = Frames::first(frames);
        let shares: Vec<Frames> = (0..count).map(|index| Shard { index, count }.of(&all)).collect();
        let lengths: Vec<usize> = shares.iter().map(|share| share.numbers().len()).collect();
        assert!(lengths.iter().max().expect("some") - lengths.iter().min().expect("some") <= 1, "{lengths:?}");
        let together: Vec<u32> = shares.iter().flat_map(|share| share.numbers().to_vec()).collect();
        assert_eq!(together, all.numbers(), "in their order, each once");
    }
    for (text, what) in [("4/4", "no shard 4 of 4"), ("0/0", "no shards"), ("1", "want i/n"), ("-1/2", "want i/n")] {
        let said = text.parse::<Shard>().expect_err(text);
        assert!(said.contains(what), "{text}: {said}");
    }
    assert_eq!("2/4".parse::<Shard>(), Ok(Shard { index: 2, count: 4 }));
}

#[test]
fn farms_name_their_shards_in_the_environment() {
    let shard = |variables: &[(&str, &str)]| {
        Shard::from_env(|name| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned()))
    };
    let slurm = [("SLURM_ARRAY_TASK_ID", "7"), ("SLURM_ARRAY_TASK_MIN", "1"), ("SLURM_ARRAY_TASK_STEP", "2")];
    assert_eq!(shard(&[&slurm[..], &[("SLURM_ARRAY_TASK_COUNT", "4")]].concat()), Ok(Shard { index: 3, count: 4 }));
    let aws = [("AWS_BATCH_JOB_ARRAY_INDEX", "0"), ("AWS_BATCH_JOB_ARRAY_SIZE", "10")];
    assert_eq!(shard(&aws), Ok(Shard { index: 0, count: 10 }));
    assert_eq!(shard(&[("JOB_COMPLETION_INDEX", "2"), ("HACHURE_SHARDS", "3")]), Ok(Shard { index: 2, count: 3 }));
    for (variables, what) in [
        (&[][..], "no shard is named"),
        (&[("JOB_COMPLETION_INDEX", "2")], "set HACHURE_SHARDS"),
        (&[("JOB_COMPLETION_INDEX", "x"), ("HACHURE_SHARDS", "3")], "JOB_COMPLETION_INDEX is no number"),
        (&[("JOB_COMPLETION_INDEX", "3"), ("HACHURE_SHARDS", "3")], "no shard 3 of 3"),
    ] {
        let said = shard(variables).expect_err(what);
        assert!(said.contains(what), "{variables:?}: {said}");
    }
}

#[test]
fn files_are_named_after_their_frames() {
    let path = |text: &str| Pattern::parse(text).map(|pattern| pattern.path(42));
    for (text, read) in [
        ("out/%05d.png", "out/00042.png"),
        ("%d.svg", "42.svg"),
        ("a-####.pdf", "a-0042.pdf"),
        ("50%%/f%03d-%%.png", "50%/f042-%.png"),
    ] {
        assert_eq!(path(text), Ok(PathBuf::from(read)), "{text}");
    }
    for (text, what) in [
        ("frame.png", "no number"),
        ("%05d-%05d.png", "two numbers"),
        ("%5d.png", "no number of a frame"),
        ("%s.png", "no number of a frame"),
        ("%05d/frame.png", "name of a folder"),
        ("%0d.png", "no number of a frame"),
        ("%0999999999999d.png", "no number of a frame"),
    ] {
        let said = path(text).expect_err(text);
        assert!(said.contains(what), "{text}: {said}");
    }
    assert_eq!(Pattern::parse("%d.png").expect("a pattern").folder(), Path::new("."));
    assert_eq!(Pattern::parse("a/b/%d.png").expect("a pattern").folder(), Path::new("a/b"));
}

#[test]
fn names_tell_parts_apart() {
    let names = [
        Naming::new().name(),
        Naming::bare().name(),
        Naming::new().with("a", "bc").name(),
        Naming::new().with("ab", "c").name(),
        Naming::new().with("a", "b").with("c", "").name(),
        Naming::new().with("a", "").with("b", "c").name(),
    ];
    assert_eq!(HashSet::from(names).len(), names.len());
    assert_eq!(Naming::new().with("a", "b").name(), Naming::new().with("a", [b'b']).name());
}

/// A job of one file that holds what whole files hold.
fn made(folder: &Path, number: u32) -> Job {
    let path = folder.join(format!("{number}.svg"));
    let name = Naming::new().with("number", number.to_le_bytes()).name();
    let seal = Seal { job: name, adapter: "none".to_owned() };
    fs::write(&path, format!("<svg><metadata>{seal}</metadata>{}</svg>\n", " ".repeat(100))).expect("a file");
    Job { number, called: format!("number {number}"), files: vec![JobFile { path, name }] }
}

#[test]
fn a_job_is_done_where_its_files_are_whole_and_of_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = made(folder.path(), 3);
    let path = &job.files[0].path;
    assert!(job.is_done());
    let other = Job { files: vec![JobFile { name: job.files[0].name + 1, path: path.clone() }], ..job.clone() };
    assert!(!other.is_done(), "of another name");
    let text = fs::read_to_string(path).expect("its text");
    for (broken, what) in [
        (text[..text.len() - 8].to_owned(), "cut off"),
        (text.replace("hachure-job", "hachure-jab"), "without a name"),
        (format!("{}{text}", " ".repeat(5000)), "with its name too far behind"),
        (String::new(), "empty"),
    ] {
        fs::write(path, broken).expect("a file");
        assert!(!job.is_done(), "{what}");
    }
    fs::remove_file(path).expect("it is there");
    assert!(!job.is_done(), "gone");
}

fn sequence(count: u32, job: u128) -> SequenceKey {
    SequenceKey {
        of: format!("{count} numbers"),
        sequence: u128::from(count) << 100,
        job,
        count,
        fps: Some(25.0),
        inks: None,
    }
}

#[test]
fn manifests_together_say_what_is_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert!(Merged::all(folder).expect_err("no manifest").to_string().contains("no manifest is in it"));
    let write = |index: u32, job: u128| {
        let shard = Shard { index, count: 3 };
        let jobs: Vec<Job> = shard.of(&Frames::first(10)).numbers().iter().map(|n| made(folder, *n)).collect();
        Manifest::new(&sequence(10, job), shard, None, &jobs, folder).write(folder).expect("a manifest");
    };
    write(0, 1);
    write(2, 1);
    let merged = || Merged::all(folder).expect("manifests of one sequence").remove(0);
    let two = merged();
    assert_eq!((two.whole.to_string(), two.unknown.to_string()), ("0-2,6-9".to_owned(), "3-5".to_owned()));
    assert_eq!((&two.absent[..], two.missing()), (&[Shard { index: 1, count: 3 }][..], 3));
    write(1, 1);
    assert_eq!((merged().missing(), merged().absent), (0, vec![]));
    fs::write(folder.join("4.svg"), "<svg></svg>").expect("a file");
    assert_eq!((merged().broken.to_string(), merged().missing()), ("4".to_owned(), 1));
    Manifest::new(&sequence(10, 1), Shard { index: 0, count: 7 }, None, &[], folder).write(folder).expect("a manifest");
    assert_eq!(merged().absent, [], "shards that would hold nothing that is unknown are not missed");
    write(1, 2);
    assert!(Merged::all(folder).expect_err("another look").to_string().contains("of another look"));
    fs::write(folder.join("hachure-0-of-3.json"), "{").expect("a file");
    assert!(Merged::all(folder).expect_err("broken").to_string().contains("it is no manifest"));
}

#[test]
fn a_folder_takes_one_sequence() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert!(Manifest::refuse_others(&folder.join("none"), &sequence(10, 1)).is_ok(), "no folder, no other");
    Manifest::new(&sequence(10, 1), Shard::WHOLE, None, &[], folder).write(folder).expect("a manifest");
    assert!(Manifest::refuse_others(folder, &sequence(10, 2)).is_ok(), "another look of the same is drawn over");
    let said = Manifest::refuse_others(folder, &sequence(12, 1)).expect_err("another sequence").to_string();
    assert!(said.contains("it is the manifest of 10 numbers, this is 12 numbers; give another folder"), "{said}");
    let list = |count| SequenceKey { fps: None, ..sequence(count, 1) };
    assert!(Manifest::refuse_others(folder, &list(12)).is_ok(), "lists of drawings stand beside others");
    for count in [4, 5] {
        Manifest::new(&list(count), Shard::WHOLE, None, &[], folder).write(folder).expect("a manifest");
    }
    let sequences = Merged::all(folder).expect("manifests");
    assert_eq!(sequences.len(), 3, "each is held against its own files");
    assert!(sequences.iter().all(|merged| merged.missing() > 0));
}

#[test]
fn what_a_dem_holds_follows_its_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, cache) = (folder.path().join("a.asc"), Cache::in_folder(folder.path().join("cache")));
    let asked = Cell::new(0);
    let content = |files: &[&str]| {
        let files: Vec<PathBuf> = files.iter().map(|name| folder.path().join(name)).collect();
        let found = cache.content(7, "a", &|warning| panic!("{warning}"), || {
            asked.set(asked.get() + 1);
            Ok(files)
        });
        found.expect("content").hash().to_owned()
    };
    fs::write(&path, "heights").expect("a file");
    let first = content(&["a.asc"]);
    assert_eq!((content(&["a.asc"]), asked.get()), (first.clone(), 1), "it is known");
    fs::write(folder.path().join("a.prj"), "a system").expect("a file");
    let both = content(&["a.asc", "a.prj"]);
    assert!(both != first && asked.get() == 2, "a file beside it may belong to it");
    fs::write(folder.path().join("b.prj"), "another's").expect("a file");
    assert_eq!((content(&["a.asc", "a.prj"]), asked.get()), (both.clone(), 2), "another's file does not");
    fs::write(&path, "Heights").expect("a file");
    let other = content(&["a.asc", "a.prj"]);
    assert!(other != both && asked.get() == 3, "other bytes");
    fs::rename(&path, folder.path().join("c.asc")).expect("it is there");
    assert_ne!(content(&["c.asc", "a.prj"]), other, "a name may be a part of what is read");
    let old = File::options().write(true).open(folder.path().join("c.asc")).expect("a file");
    old.set_modified(SystemTime::UNIX_EPOCH - Duration::from_secs(3600)).expect("a time");
    content(&["c.asc", "a.prj"]);
}

#[test]
fn a_manifest_keeps_what_an_older_one_of_the_same_jobs_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let jobs: Vec<Job> = (0..3).map(|n| made(folder, n)).collect();
    let manifest = |job| Manifest::new(&sequence(3, job), Shard::WHOLE, None, &jobs, folder);
    let mut first = manifest(1);
    first.note(1, Ok(12.5));
    first.note(2, Err("it broke".to_owned()));
    first.write(folder).expect("a manifest");
    let times = |manifest: Manifest| manifest.jobs.iter().map(|entry| entry.ms).collect::<Vec<_>>();
    assert_eq!(times(manifest(1).after(folder)), [None, Some(12.5), None]);
    assert_eq!(times(manifest(2).after(folder)), [None; 3], "of another look nothing is known");
    assert_eq!(Merged::all(folder).expect("a manifest")[0].failed, [], "what failed once and is there is whole");
}

#[test]
fn manifests_that_no_process_writes_are_refused_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let manifest = Manifest::new(&sequence(4, 1), Shard::WHOLE, None, &[], folder);
    manifest.write(folder).expect("a manifest");
    let path = folder.join(manifest.file_name());
    let text = fs::read_to_string(&path).expect("a manifest");
    assert!(Merged::all(folder).is_ok());
    let job = r#""jobs":[{"n":4,"files":[]}]"#;
    for (is, becomes, why) in [
        (r#""count":4"#, r#""count":4294967295"#, "4294967295 jobs are more than 10000000"),
        (r#""shard":[0,1]"#, r#""shard":[0,4000000000]"#, "4000000000 shards are too many"),
        (r#""shard":[0,1]"#, r#""shard":[3,3]"#, "there is no shard 3 of 3"),
        (r#""shard":[0,1]"#, r#""shard":[0,0]"#, "there are no shards"),
        (r#""part":null"#, r#""part":"x""#, "want numbers and ranges"),
        (r#""jobs":[]"#, job, "a job of 4 has a higher number"),
    ] {
        assert!(text.contains(is), "{is} in {text}");
        fs::write(&path, text.replace(is, becomes)).expect("a manifest");
        let said = Merged::all(folder).expect_err(becomes).to_string();
        assert!(said.contains("it is no manifest (") && said.contains(why), "{said}");
        assert!(said.ends_with("; remove it, or give another folder"), "{said}");
    }
    #[cfg(unix)]
    {
        // Nobody writes to it: it would be waited for.
        fs::remove_file(&path).expect("it is there");
        assert!(std::process::Command::new("mkfifo").arg(&path).status().expect("mkfifo runs").success());
        let said = Merged::all(folder).expect_err("a pipe").to_string();
        assert!(said.contains("it cannot be read (it is no regular file)"), "{said}");
        let said = hachure::door::formats::views(&path).expect_err("a pipe").to_string();
        assert!(said.contains("it is no regular file; name a file of JSON"), "{said}");
    }
}
