//! The raster formats that hachure reads, and what GDAL must leave alone in this process.
//!
//! GDAL opens the parts of a VRT, masks and overviews with any driver it has, whatever list the first file was opened
//! with. So the raster drivers off the list are deregistered, once, for the whole process: a part can then call no
//! web service, database or script. Not handled: a local file that names another local one inside (HFA spills, HDF5
//! external storage); its numbers reach a picture on the user's own screen, no further.

use std::sync::Once;

use gdal::{DriverManager, Metadata, config};

use super::{handles, quiet};

/// Memory in which GDAL keeps blocks of files, MiB: by itself a twentieth of the machine's, for files that are read once.
const CACHE_MIB: &str = "32";
/// GDAL's names of the formats in which people bring elevations. Left out are those that name other files or addresses
/// to be opened by any driver (ERS, ISIS3, MRF, PCIDSK, PDS, Zarr …), services and products that are no elevations.
pub(super) const FORMATS: [&str; 38] = [
    "GTiff",
    "COG",
    "AAIGrid",
    "GRASSASCIIGrid",
    "EHdr",
    "ENVI",
    "HFA",
    "netCDF",
    "GMT",
    "HDF5",
    "HDF5Image",
    "BAG",
    "HDF4",
    "HDF4Image",
    "USGSDEM",
    "SDTS",
    "SRTMHGT",
    "DTED",
    "JDEM",
    "ACE2",
    "PNG",
    "BMP",
    "PNM",
    "JP2OpenJPEG",
    "BT",
    "SAGA",
    "GSAG",
    "GSBG",
    "GS7BG",
    "RST",
    "AIG",
    "GRIB",
    "XYZ",
    "GPKG",
    "Terragen",
    "LCP",
    "ZMap",
    "RRASTER",
];

/// Opened only after inspection (VRT) or never by name, but used inside GDAL (MEM).
const GUARDED: [&str; 2] = ["VRT", "MEM"];

/// Formats of points, lines and areas that are told apart from unknown ones; all of them plain files.
pub(super) const VECTORS: [&str; 11] = [
    "ESRI Shapefile",
    "GeoJSON",
    "GeoJSONSeq",
    "TopoJSON",
    "GPKG",
    "KML",
    "LIBKML",
    "GPX",
    "FlatGeobuf",
    "MapInfo File",
    "DXF",
];

/// GDAL's option that names the one file `/vsicurl/` and its kin may open.
const ONLY_REMOTE: &str = "CPL_VSIL_CURL_ALLOWED_FILENAME";

/// Restricts GDAL, and lets this thread read from the network, or not, until it opens the next file.
///
/// The network is a second wall behind the checks of names, for those that stand where nobody looks, as in the metadata
/// of a TIFF. The rest happens once, for the process: another thread should not be inside GDAL meanwhile.
pub(super) fn restrict(allow_remote: bool) {
    static ONCE: Once = Once::new();
    ONCE.call_once(restrict_process);
    quiet::hush();
    // These options exist in every GDAL that the bindings know; setting them fails for names with a NUL alone.
    let _ = if allow_remote {
        config::clear_thread_local_config_option(ONLY_REMOTE)
    } else {
        config::set_thread_local_config_option(ONLY_REMOTE, "none")
    };
}

/// Takes from GDAL the drivers off the list, Python in VRTs, the habit of leaving files beside a .gz, and most of its
/// cache and of the files that it keeps open for VRTs, unless the user has set those.
fn restrict_process() {
    if config::get_config_option("GDAL_CACHEMAX", "").is_ok_and(|size| size.is_empty()) {
        let _ = config::set_config_option("GDAL_CACHEMAX", CACHE_MIB);
    }
    if config::get_config_option("GDAL_MAX_DATASET_POOL_SIZE", "").is_ok_and(|size| size.is_empty()) {
        let _ = config::set_config_option("GDAL_MAX_DATASET_POOL_SIZE", &handles::most().to_string());
    }
    let _ = config::set_config_option("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO");
    let _ = config::set_config_option("GDAL_VRT_ENABLE_PYTHON", "NO");
    // From the end, so that the places of those not yet looked at stay the same.
    for driver in (0..DriverManager::count()).rev().filter_map(|place| DriverManager::get_driver(place).ok()) {
        let name = driver.short_name();
        let kept = FORMATS.contains(&name.as_str()) || GUARDED.contains(&name.as_str());
        if driver.metadata_item("DCAP_RASTER", "").is_some() && !kept {
            DriverManager::deregister_driver(&driver);
        }
    }
}
