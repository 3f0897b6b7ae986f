//! Motion pictures: each read back by a stranger, picture by picture, beside the pictures that they were made of.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use glam::DVec2;
use hachure::door::ink::drawing::{Layer, Pen, StrokeForm};
use hachure::door::job::{Film, Inks};
use hachure::ink::Surround;
use hachure::ink::plot::Journey;
use hachure::ink::{Colour, Drawing, Sheet, Stroke, StrokePoint, write_png};

const PAPER: Colour = Colour([250, 246, 235]);
const INKS: [Colour; 2] = [Colour([38, 32, 26]), Colour([30, 60, 140])];
/// Pixels across and down: odd, as half of all coders do not like them.
const SIZE: [u32; 2] = [121, 63];

/// Pictures of two strokes, one of which moves from frame to frame; in the third nothing does.
fn pictures(folder: &Path, count: u32) -> Vec<PathBuf> {
    let stroke = |a: [f64; 2], b: [f64; 2]| Stroke {
        chain: None,
        piece: 0,
        points: [a, b].map(|at| StrokePoint { place: DVec2::from(at), width: 1.0 }).to_vec(),
        closed: false,
    };
    let layer = |colour, stroke| Layer {
        name: "1 a".to_owned(),
        pen: Pen { width: 1.3, colour, opacity: 1.0 },
        form: StrokeForm::Outlines,
        found: Journey::default(),
        strokes: vec![stroke],
        areas: Vec::new(),
    };
    let frame = |n: u32| {
        let x = 5.0 + 7.0 * f64::from(if n == 2 { 1 } else { n });
        let layers =
            vec![layer(INKS[0], stroke([4.0, 50.0], [115.0, 57.0])), layer(INKS[1], stroke([x, 5.0], [x + 8.0, 40.0]))];
        let sheet = Sheet { size: DVec2::new(121.0, 63.0), margin: 0.0, surround: Surround::NONE };
        let drawing = Drawing { sheet, paper: PAPER, layers, title: None, seal: None };
        let path = folder.join(format!("{n}.png"));
        write_png(&drawing, 1.0, File::create(&path).expect("a file")).expect("a picture");
        path
    };
    (0..count).map(frame).collect()
}

fn inks() -> Inks {
    Inks([&[PAPER][..], &INKS].concat())
}

/// Red, green and blue of a picture.
fn rgb(path: &Path) -> Vec<u8> {
    image::open(path).expect("a picture").to_rgb8().into_raw()
}

/// Greatest difference of a channel.
fn apart(a: &[u8], b: &[u8]) -> u8 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// Pictures of a GIF as they are seen, with their delays in hundredths of a second.
fn gif(path: &Path) -> Vec<(Vec<u8>, u16)> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(path).expect("a file")).expect("a GIF");
    assert_eq!([decoder.width(), decoder.height()].map(u32::from), SIZE);
    let mut seen = vec![0; (SIZE[0] * SIZE[1] * 3) as usize];
    let mut all = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        for (i, pixel) in frame.buffer.chunks_exact(4).enumerate() {
            let (x, y) = (i % usize::from(frame.width), i / usize::from(frame.width));
            let at = 3 * ((y + usize::from(frame.top)) * SIZE[0] as usize + x + usize::from(frame.left));
            if pixel[3] > 0 {
                seen[at..at + 3].copy_from_slice(&pixel[..3]);
            }
        }
        all.push((seen.clone(), frame.delay));
    }
    all
}

/// Pictures of an animated PNG as they are seen, with their delays in seconds.
fn apng(path: &Path) -> Vec<(Vec<u8>, f64)> {
    let decoder = png::Decoder::new(std::io::BufReader::new(File::open(path).expect("a file")));
    let mut reader = decoder.read_info().expect("a PNG");
    let count = reader.info().animation_control.expect("it is animated").num_frames;
    let mut seen = vec![0; (SIZE[0] * SIZE[1] * 3) as usize];
    let mut all = Vec::new();
    for _ in 0..count {
        let mut part = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut part).expect("a frame");
        let about = *reader.info().frame_control().expect("of a frame");
        for y in 0..about.height as usize {
            let row = 3 * about.width as usize;
            let at = 3 * ((y + about.y_offset as usize) * SIZE[0] as usize + about.x_offset as usize);
            seen[at..at + row].copy_from_slice(&part[y * row..(y + 1) * row]);
        }
        all.push((seen.clone(), f64::from(about.delay_num) / f64::from(about.delay_den)));
    }
    all
}

#[test]
fn a_gif_shows_the_pictures_for_as_long_as_they_last() {
    let folder = tempfile::tempdir().expect("a folder");
    let pictures = pictures(folder.path(), 7);
    for fps in [24.0, 30.0, 25.0, 50.0, 12.5, 7.0] {
        let path = folder.path().join("film.gif");
        Film::new(&path, fps).expect("a film").make(&pictures, &inks(), &|_| ()).expect("a GIF");
        let shown = gif(&path);
        assert_eq!(shown.len(), pictures.len());
        for (i, ((seen, _), path)) in shown.iter().zip(&pictures).enumerate() {
            // Two ramps of 127 steps between colours at most 224 apart: half a step, and what joints mix.
            let apart = apart(seen, &rgb(path));
            assert!(apart <= 3, "picture {i} at {fps}: {apart} of 255");
        }
        let mut due = 0.0;
        for (i, (_, delay)) in shown.iter().enumerate() {
            due += f64::from(*delay) / 100.0;
            let wanted = (i + 1) as f64 / fps;
            assert!((due - wanted).abs() <= 0.005 + 1e-9, "picture {i} at {fps} ends at {due}, not {wanted}");
        }
    }
}

#[test]
fn an_animated_png_shows_the_very_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let pictures = pictures(folder.path(), 6);
    for fps in [24.0, 23.976, 0.5, 120.0, 59.94] {
        let path = folder.path().join("film.png");
        Film::new(&path, fps).expect("a film").make(&pictures, &inks(), &|_| ()).expect("a PNG");
        let shown = apng(&path);
        assert_eq!(shown.len(), pictures.len());
        for ((seen, delay), path) in shown.iter().zip(&pictures) {
            assert_eq!(apart(seen, &rgb(path)), 0, "{}", path.display());
            assert!((delay * fps - 1.0).abs() < 1e-4, "{delay} s at {fps}");
        }
    }
}

#[test]
fn ffmpeg_is_given_every_picture() {
    if !is_there("ffmpeg") || !is_there("ffprobe") {
        println!("SKIP no ffmpeg");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let pictures = pictures(folder.path(), 12);
    for ending in ["mp4", "mkv"] {
        let path = folder.path().join(format!("film.{ending}"));
        Film::new(&path, 24.0).expect("a film").make(&pictures, &inks(), &|_| ()).expect("a film");
        let asked = ["-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries"];
        let of = "stream=width,height,r_frame_rate,nb_read_frames";
        let output =
            Command::new("ffprobe").args(asked).args([of, "-of", "csv=p=0"]).arg(&path).output().expect("it runs");
        let said = String::from_utf8_lossy(&output.stdout).trim().trim_end_matches(',').to_owned();
        assert_eq!(said, "122,64,24/1,12", "{ending}: even sides, all pictures");
    }
    let names: Vec<_> =
        fs::read_dir(folder.path()).expect("a folder").flatten().map(|entry| entry.file_name()).collect();
    assert_eq!(names.len(), pictures.len() + 2, "nothing half made is left: {names:?}");
}

fn is_there(program: &str) -> bool {
    Command::new(program).arg("-version").output().is_ok_and(|output| output.status.success())
}

#[test]
fn what_cannot_be_a_film_is_told_at_once() {
    let of = |name: &str, fps: f64| Film::new(Path::new(name), fps).expect_err(name).to_string();
    assert!(of("film.avi", 24.0).contains("film.avi does not end in .gif, .png or .mp4, .mov, .mkv, .webm"));
    assert!(of("film", 24.0).contains("does not end in"));
    assert!(of("film.gif", 60.0).contains("a GIF shows at most 50 pictures a second, not 60"));
}

#[test]
fn a_picture_that_is_none_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let pictures = pictures(folder.path(), 3);
    let whole = fs::read(&pictures[1]).expect("a picture");
    for film in ["film.gif", "film.png"] {
        let path = folder.path().join(film);
        let make = || Film::new(&path, 24.0).expect("a film").make(&pictures, &inks(), &|_| ());
        fs::write(&pictures[1], &whole[..whole.len() / 2]).expect("a file");
        let said = make().expect_err("half a picture").to_string();
        assert!(said.contains("1.png: it is no whole picture"), "{said}");
        fs::remove_file(&pictures[1]).expect("it is there");
        let said = make().expect_err("no picture").to_string();
        assert!(said.contains("1.png: it cannot be read"), "{said}");
        assert!(!path.exists(), "nothing half made has its name");
        fs::write(&pictures[1], &whole).expect("a file");
        make().expect("all pictures");
    }
}
