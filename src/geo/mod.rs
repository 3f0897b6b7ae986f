//! Rasters on the disk as DEMs, and the systems of coordinates that they name.
//!
//! GDAL and PROJ are known in `gdal/` alone, behind the traits of [`dem`](crate::dem): [`Tiles`](crate::dem::Tiles) and
//! [`Transform`](crate::dem::Transform). A build without the feature `gdal` has the same names and reads nothing: each
//! says so. Of vectors the way of a flight is read, see `track`, and
//! lines of the user's own, see [`own_lines`]; lines of a drawing are written, see [`write_lines`].

mod elevation_unit;
mod encoding;
#[cfg(feature = "gdal")]
pub(crate) mod gdal;
mod info;
mod mapped;
mod nodata;
mod own;
mod read;
pub(crate) mod track;
#[cfg(not(feature = "gdal"))]
mod without;

pub use elevation_unit::ElevationUnit;
pub use encoding::Encoding;
pub(crate) use info::info_and_dem;
pub use info::{Info, info};
pub use mapped::{MapFormat, MapLine};
pub use nodata::Nodata;
pub use own::{OwnLayer, OwnLine, OwnLines};
pub use read::{Order, ReadOptions, ReadStage, read, read_all};
pub(crate) use track::{Track, with_layer};
#[cfg(not(feature = "gdal"))]
pub(crate) use without::{Reading, track};
#[cfg(not(feature = "gdal"))]
pub use without::{available, own_lines, write, write_lines};

#[cfg(feature = "gdal")]
pub(crate) use self::gdal::{Reading, track};
#[cfg(feature = "gdal")]
pub use self::gdal::{available, own_lines, write, write_lines};
