//! stub
use std::io;
/// stub
pub fn write_svg(_: &super::Drawing, _: impl io::Write) -> io::Result<()> {
    Err(io::Error::other("stub"))
}
