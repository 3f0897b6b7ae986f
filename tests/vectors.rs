//! Drawings as SVG and PDF, judged by strangers: resvg, poppler, GDAL and an XML parser.

mod files;
mod many;
mod outlines;
pub mod pictures;
mod samples;
pub mod strangers;
