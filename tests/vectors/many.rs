//! Many strokes: the same bytes however many cores write them, soon, and in little memory.

use std::io;
use std::process::Command;
use std::time::Instant;

use glam::dvec2;
use hachure::door::measure::memory::{peak, reset_peak};
use hachure::ink::{Drawing, write_pdf, write_svg};
use rayon::ThreadPoolBuilder;

use super::pictures::{pdf, svg};
use super::samples::{all, centre_lines, drawing, layer, widths};
use crate::tolerances::{SVG_BYTES, SVG_SECONDS};

/// Short curves all over the sheet.
fn many(count: u32) -> Drawing {
    let stroke = |i: u32| {
        let at = dvec2(f64::from(i % 997) / 10.0, f64::from(i / 997 % 797) / 10.0);
        let points = (0..6).map(|k| f64::from(k) / 5.0);
        widths(points.map(|t| (at + dvec2(3.0 * t, (4.0 * t + f64::from(i)).sin()), 1.0 - t)))
    };
    drawing(vec![layer("1 curves", 0.3, [0; 3], 1.0, (0..count).map(stroke).collect())])
}

#[test]
fn bytes_are_the_same_twice_and_on_any_number_of_cores() {
    let mut drawings = vec![all(), many(30_000)];
    drawings.push(drawing(many(30_000).layers.into_iter().map(centre_lines).collect()));
    for drawing in drawings {
        let [first, again] = [(); 2].map(|()| [svg(&drawing), pdf(&drawing)]);
        assert!(first == again, "differs the second time");
        for cores in [1, 4] {
            let pool = ThreadPoolBuilder::new().num_threads(cores).build().expect("threads");
            let files = pool.install(|| [svg(&drawing), pdf(&drawing)]);
            assert!(first == files, "differs on {cores} cores");
        }
        let paths = String::from_utf8_lossy(&first[0]).matches("<path ").count();
        assert_eq!(paths, drawing.layers.iter().map(|layer| layer.strokes.len()).sum::<usize>());
        let mut moved = drawing.clone();
        moved.layers[0].strokes[0].points[0].place += 0.001;
        assert!([svg(&moved), pdf(&moved)].iter().zip(&first).all(|(a, b)| a != b), "a micrometre is not noticed");
    }
}

#[test]
fn errors_of_the_writer_are_told() {
    struct Full(usize);
    impl io::Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::StorageFull)?;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let drawing = many(20_000);
    for room in [0, 100, 1000, 1_000_000] {
        let errors = [write_svg(&drawing, Full(room)), write_pdf(&drawing, Full(room))];
        assert!(
            errors.iter().all(|error| error.as_ref().is_err_and(|e| e.kind() == io::ErrorKind::StorageFull)),
            "{room}"
        );
    }
    assert!(write_svg(&drawing, Full(1 << 30)).is_ok());
}

#[test]
fn a_million_strokes_are_written_soon_in_little_memory() {
    // Alone in a process, for the peak is the process's.
    let test = std::env::current_exe().expect("this program");
    let child = "vectors::many::child_writes_a_million_strokes";
    let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().expect("a child");
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    let failed = String::from_utf8_lossy(&ran.stderr).into_owned();
    println!("{said}");
    assert!(ran.status.success() && said.contains("a million strokes: "), "{said}{failed}");
}

#[test]
#[ignore = "run by a_million_strokes_are_written_soon_in_little_memory in a process of its own"]
fn child_writes_a_million_strokes() {
    struct Counted(u64);
    impl io::Write for Counted {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 += bytes.len() as u64;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let drawing = many(1_000_000);
    reset_peak();
    let before = peak();
    let mut file = Counted(0);
    let began = Instant::now();
    write_svg(&drawing, &mut file).expect("an SVG");
    let seconds = began.elapsed().as_secs_f64();
    let grown = peak().zip(before).map(|(after, before)| after - before);
    println!("a million strokes: {seconds:.2} s, {} MB of SVG, {grown:?} bytes more at once", file.0 / 1_000_000);
    assert!(seconds < SVG_SECONDS, "{seconds} s");
    assert!(grown.is_none_or(|bytes| bytes < SVG_BYTES), "{grown:?} bytes");
    assert!(file.0 > 4 * SVG_BYTES, "a file that would fit is no test");
}
