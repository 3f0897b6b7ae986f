//! Names of what files are made of: a hash of all that the picture depends on, program included.
//!
//! Equal names mean equal pictures on one adapter. Parts are told apart by what they are called and by their lengths; the
//! program is known by its sources ([`SOURCES`]), which tell more than a commit: they know uncommitted changes, and not those
//! of the documentation.

use xxhash_rust::xxh3::Xxh3;

/// Number of what names are made of and how files bear them: raised when either changes.
pub(crate) const FORMAT: u32 = 1;
/// Hash of the sources of this program.
pub(crate) const SOURCES: &str = env!("HACHURE_SOURCES");

/// A name in the making.
#[derive(Clone)]
pub struct Naming(Xxh3);

impl Naming {
    /// Of what this program makes of it.
    pub fn new() -> Self {
        Self::bare().with("format", FORMAT.to_le_bytes()).with("program", SOURCES)
    }

    /// Of what is the same whatever the program.
    pub fn bare() -> Self {
        Self(Xxh3::new())
    }

    /// With a part called so.
    #[must_use]
    pub fn with(mut self, called: &str, part: impl AsRef<[u8]>) -> Self {
        for bytes in [called.as_bytes(), part.as_ref()] {
            self.0.update(&(bytes.len() as u64).to_le_bytes());
            self.0.update(bytes);
        }
        self
    }

    /// The name.
    pub fn name(&self) -> u128 {
        self.0.digest128()
    }
}

impl Default for Naming {
    fn default() -> Self {
        Self::new()
    }
}

/// The name as text: 32 digits.
pub(crate) fn text(name: u128) -> String {
    format!("{name:032x}")
}

/// The name that a text has.
pub(crate) fn parse(text: &str) -> Option<u128> {
    u128::from_str_radix(text, 16).ok().filter(|_| text.len() == 32)
}
