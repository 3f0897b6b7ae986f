//! Names of numbered files: `%05d` is the number with at least five digits, `%d` the bare number, `####` four digits, `%%` a
//! percent sign.

use std::path::{Path, PathBuf};

use crate::files::straight;

/// Most digits.
const MOST: usize = 12;

/// A path with one number in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// Reads a pattern; says in words what is wrong with it.
    ///
    /// # Errors
    /// The words.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (mut before, mut digits, mut rest) = (String::new(), None, text);
        let mut after = String::new();
        while let Some(at) = rest.find(['%', '#']) {
            let (plain, mark) = rest.split_at(at);
            let so_far = if digits.is_none() { &mut before } else { &mut after };
            so_far.push_str(plain);
            if let Some(behind) = mark.strip_prefix("%%") {
                so_far.push('%');
                rest = behind;
                continue;
            }
            let (width, behind) = number(mark).ok_or_else(|| {
                format!("{} is no number of a frame; want %05d, or %% for a percent sign", first_of(mark))
            })?;
            if digits.replace(width).is_some() {
                return Err("it has two numbers; want one, as frame-%05d.png".to_owned());
            }
            rest = behind;
        }
        let digits =
            digits.ok_or("it has no number, so that each frame would replace the last; name it as %05d.png")?;
        after.push_str(rest);
        if after.contains(std::path::is_separator) {
            return Err("the number stands in the name of a folder; want it in that of the file".to_owned());
        }
        Ok(Self { before, digits, after })
    }

    /// The path of a number.
    pub fn path(&self, number: u32) -> PathBuf {
        let Self { before, digits, after } = self;
        PathBuf::from(format!("{before}{number:0digits$}{after}"))
    }

    /// Whether both may name one file, if only of other numbers.
    pub fn meets(&self, other: &Self) -> bool {
        let plain = |pattern: &Self| {
            let path = Self { digits: MOST, ..pattern.clone() }.path(0);
            straight(&std::path::absolute(&path).unwrap_or(path))
        };
        plain(self) == plain(other)
    }

    /// The folder in which its files stand.
    pub fn folder(&self) -> PathBuf {
        let path = self.path(0);
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.unwrap_or(Path::new(".")).to_owned()
    }
}

/// The digits that a mark at the beginning stands for, and what follows it.
fn number(mark: &str) -> Option<(usize, &str)> {
    let hashes = mark.len() - mark.trim_start_matches('#').len();
    if hashes > 0 {
        return (hashes <= MOST).then_some((hashes, &mark[hashes..]));
    }
    let (width, behind) = mark.strip_prefix('%')?.split_once('d')?;
    let width = match width {
        "" => 1,
        _ => width.strip_prefix('0')?.parse().ok().filter(|width| (1..=MOST).contains(width))?,
    };
    Some((width, behind))
}

fn first_of(mark: &str) -> String {
    mark.chars().take(4).collect()
}
