//! stub
use std::io;
/// stub
pub fn write_pdf(_: &super::Drawing, _: impl io::Write) -> io::Result<()> {
    Err(io::Error::other("stub"))
}
