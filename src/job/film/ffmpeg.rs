//! A motion picture by ffmpeg, into which the files of the pictures are piped.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;

use super::Inks;
use crate::error::{Error, Result, Setting};
use crate::files::Output;

/// Bytes of what ffmpeg says that are listened to.
const MOST_SAID: u64 = 1 << 16;

/// Whether ffmpeg is there.
///
/// # Errors
/// [`Error::Setting`] where it is not, or does not run.
pub(super) fn look() -> Result<()> {
    let missing = |why: String| {
        let remedy = "install it (`apt-get install ffmpeg`, `brew install ffmpeg`), or name a .gif or .png";
        Error::setting(Setting::Video, format!("ffmpeg makes it, {why}"), remedy)
    };
    let asked = Command::new("ffmpeg").arg("-version").stdin(Stdio::null()).output();
    match asked {
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => Err(missing(format!("which does not run here ({})", output.status))),
        Err(error) => Err(missing(format!("which is not to be found ({error})"))),
    }
}

/// Writes pictures, so many a second, in the format of this name; tells which are on their way.
///
/// # Errors
/// [`Error::Input`] for a picture that cannot be read, [`Error::Output`] with ffmpeg's words.
pub(super) fn write(
    output: &mut Output,
    format: &str,
    fps: f64,
    inks: &Inks,
    pictures: &[PathBuf],
    done: &dyn Fn(usize),
) -> Result<()> {
    let mut wrong = None;
    let written = output.write_by_name(|path| {
        let mut child = start(path, format, fps, inks)?;
        let said = child.stderr.take();
        let listen = thread::spawn(move || {
            let mut text = String::new();
            let _ = said.map(|said| said.take(MOST_SAID).read_to_string(&mut text));
            text
        });
        let piped = pipe(&mut child, pictures, done);
        let status = child.wait()?;
        let said = listen.join().unwrap_or_default();
        match piped {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
            _ if status.success() => Ok(()),
            _ => {
                let last = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it says nothing");
                Err(io::Error::other(format!("ffmpeg: {last}")))
            }
        }
        .inspect_err(|error| wrong = error.get_ref().and_then(|inner| inner.downcast_ref::<Error>()).cloned())
    });
    wrong.map_or(written, Err)
}

fn start(path: &Path, format: &str, fps: f64, inks: &Inks) -> io::Result<Child> {
    let paper = inks.0.first().map_or_else(|| "white".to_owned(), |paper| paper.to_string().replace('#', "0x"));
    // Colours in half as many pixels want an even number of them.
    let even = format!("pad=ceil(iw/2)*2:ceil(ih/2)*2:color={paper}");
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error", "-y", "-f", "image2pipe", "-c:v", "png", "-framerate", &fps.to_string(), "-i", "-"]);
    command.args(["-vf", &even, "-pix_fmt", "yuv420p"]);
    if format == "mp4" || format == "mov" {
        command.args(["-movflags", "+faststart"]);
    }
    command.args(["-f", format]).arg(path);
    // What a terminal sends to all that runs in it is not for ffmpeg.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn()
}

fn pipe(child: &mut Child, pictures: &[PathBuf], done: &dyn Fn(usize)) -> io::Result<()> {
    let Some(mut stdin) = child.stdin.take() else { return Err(io::ErrorKind::BrokenPipe.into()) };
    for (i, path) in pictures.iter().enumerate() {
        let unreadable = |error: io::Error| {
            let what = format!("it cannot be read ({error})");
            io::Error::other(Error::input(path, what, "draw it anew"))
        };
        let mut file = File::open(path).map_err(unreadable)?;
        io::copy(&mut file, &mut stdin)?;
        done(i);
    }
    Ok(())
}
