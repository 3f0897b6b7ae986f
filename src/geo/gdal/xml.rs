//! What GDAL would take a file for, and the XML of a VRT as GDAL itself parses it.
//!
//! A VRT is recognised and parsed by GDAL's own code, so that no file means one thing to the inspection and another to
//! GDAL (its parser forgives what every other refuses). The tree is copied out once, names in lower case as GDAL does
//! not tell them apart. The safe crate has none of these calls. Cost: the file's length in memory, twice.

use std::ffi::{CStr, c_char};
use std::path::Path;
use std::{iter, ptr};

use gdal::GdalOpenFlags;
use gdal_sys::{CPLXMLNode, CPLXMLNodeType};

use super::lossless;
use super::source::heard;
use super::vsi::c_string;

/// A text of the tree.
#[derive(Debug)]
pub(super) struct XmlText {
    /// Name of the element or attribute around it.
    pub name: String,
    /// The text.
    pub text: String,
    /// The `relativeToVRT` of that element.
    pub relative: Option<String>,
    /// The `key` of that element.
    pub key: Option<String>,
    /// Whether it stands in a band of raw bytes, whose source is no raster file.
    pub raw: bool,
    /// Whether it stands in metadata, which may speak of anything.
    pub metadata: bool,
}

/// Whether GDAL would open `name` as a VRT.
pub(super) fn is_vrt(name: &Path) -> bool {
    is_claimed(name, Some(c"VRT"))
}

/// Whether any driver that is left would open `name`.
pub(super) fn is_raster(name: &Path) -> bool {
    is_claimed(name, None)
}

/// Whether `driver`, or any, claims `name` by its head.
fn is_claimed(name: &Path, driver: Option<&CStr>) -> bool {
    let Some(name) = c_string(name) else { return false };
    let list = [driver.map_or(ptr::null(), CStr::as_ptr), ptr::null()];
    let allowed = if driver.is_some() { list.as_ptr() } else { ptr::null() };
    let flags = GdalOpenFlags::GDAL_OF_RASTER.bits();
    // SAFETY: the strings and the list, which ends in null, outlive the call.
    let (claims, _) = heard(|| unsafe { gdal_sys::GDALIdentifyDriverEx(name.as_ptr(), flags, allowed, ptr::null()) });
    !claims.is_null()
}

/// All texts of the XML file `name`, and GDAL's complaint if there is none that it can parse.
pub(super) fn entries(name: &Path) -> Result<Vec<XmlText>, Option<String>> {
    let Some(name) = c_string(name) else { return Err(None) };
    let (entries, complaint) = heard(|| {
        let mut bytes = ptr::null_mut();
        // SAFETY: GDAL allocates `bytes` and ends them in 0 as it does for itself, the tree ends in null pointers
        // everywhere; both are freed once, after the last use.
        unsafe {
            gdal_sys::VSIIngestFile(ptr::null_mut(), name.as_ptr(), &mut bytes, ptr::null_mut(), -1);
            let tree = if bytes.is_null() { ptr::null_mut() } else { gdal_sys::CPLParseXMLString(bytes.cast()) };
            gdal_sys::VSIFree(bytes.cast());
            let entries = flattened(tree);
            gdal_sys::CPLDestroyXMLNode(tree);
            (!tree.is_null()).then_some(entries)
        }
    });
    entries.ok_or(complaint)
}

/// The texts under `tree` and its siblings, without recursion: a file may be nested as deep as it likes.
///
/// # Safety
/// `tree` is null or a tree of GDAL's.
unsafe fn flattened(tree: *const CPLXMLNode) -> Vec<XmlText> {
    let mut entries = Vec::new();
    let mut open = vec![(tree, false, false)];
    while let Some((first, in_raw, in_metadata)) = open.pop() {
        for node in unsafe { siblings(first) } {
            let child = |name: &str| {
                let mut children = unsafe { siblings(node.psChild) };
                let child = children.find(|c| c.eType != CPLXMLNodeType::CXT_Text && lower(c.pszValue) == name)?;
                let mut texts = unsafe { siblings(child.psChild) };
                texts.find(|t| t.eType == CPLXMLNodeType::CXT_Text).map(|t| text(t.pszValue))
            };
            let raw = in_raw || child("subclass").is_some_and(|class| class == "VRTRawRasterBand");
            let metadata = in_metadata || lower(node.pszValue) == "metadata";
            for value in unsafe { siblings(node.psChild) }.filter(|c| c.eType == CPLXMLNodeType::CXT_Text) {
                entries.push(XmlText {
                    name: lower(node.pszValue),
                    text: text(value.pszValue),
                    relative: child("relativetovrt"),
                    key: child("key"),
                    raw,
                    metadata,
                });
            }
            open.push((node.psChild, raw, metadata));
        }
    }
    entries
}

/// # Safety
/// `first` is null or a node of a tree of GDAL's that lives for `'a`.
unsafe fn siblings<'a>(first: *const CPLXMLNode) -> impl Iterator<Item = &'a CPLXMLNode> {
    iter::successors(unsafe { first.as_ref() }, |node| unsafe { node.psNext.as_ref() })
}

fn lower(value: *const c_char) -> String {
    text(value).to_ascii_lowercase()
}

/// A string of a node, see [`lossless`].
fn text(value: *const c_char) -> String {
    // SAFETY: called on the values of nodes alone, which GDAL ends in 0.
    if value.is_null() { String::new() } else { lossless::text_of(unsafe { CStr::from_ptr(value) }.to_bytes()) }
}
