//! What a file may make GDAL open: formats on the list, local files, a VRT's own folder; the rest is refused unseen.

mod server;
mod vrts;

use std::fs;
use std::path::Path;
use std::process::Command;

use gdal::{Dataset, DriverManager, config};
use hachure::dem::Dem;
use hachure::geo::{ReadOptions, read};
use server::Server;

use super::refused::{refused, refused_with};
use super::{copy, folder, hill, read_all, vrt};

/// Reads as with `--allow-remote`.
fn trusting() -> ReadOptions {
    ReadOptions { allow_remote: true, ..Default::default() }
}

fn trusted(name: &str) -> Dem {
    read(Path::new(name), &trusting()).unwrap()
}

/// Refused with the flag and without.
fn refused_always(name: &str, words: &[&str]) {
    refused(Path::new(name), words);
    refused_with(Path::new(name), &trusting(), words);
}

/// A server of the hill as `hill.tif` and a GDAL_WMS file that points to it.
fn hill_server(folder: &Path) -> (Server, String) {
    let tif = fs::read(hill().write("GTiff", &folder.join("served.tif"))).unwrap();
    let server = Server::new(&[("hill.tif", tif)]);
    let service = format!(
        "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>{}</ServerUrl></Service><DataWindow><UpperLeftX>0</UpperLeftX>\
         <UpperLeftY>9</UpperLeftY><LowerRightX>9</LowerRightX><LowerRightY>0</LowerRightY><SizeX>9</SizeX>\
         <SizeY>9</SizeY></DataWindow><Projection>EPSG:32610</Projection><BlockSizeX>9</BlockSizeX>\
         <BlockSizeY>9</BlockSizeY><BandsCount>1</BandsCount></GDAL_WMS>",
        server.url("hill.tif")
    );
    (server, service)
}

#[test]
fn a_file_on_a_network_is_read_with_the_flag_alone() {
    let dir = folder();
    let (server, _) = hill_server(dir.path());
    let url = server.url("hill.tif");
    let names =
        [url.clone(), url.replace("http", "HTTP"), format!("/vsicurl/{url}"), format!("/vsigzip//vsicurl/{url}")];
    for name in &names {
        refused(Path::new(name), &["lies on a network", "--allow-remote"]);
    }
    assert_eq!(server.asked(), [""; 0], "nothing is asked of a server that is not trusted");
    for name in &names[..3] {
        assert_eq!(
            trusted(name).held().unwrap().heights(),
            read_all(&dir.path().join("served.tif")).held().unwrap().heights(),
            "{name}"
        );
    }
    assert!(server.asked().iter().any(|line| line.contains("hill.tif")), "{:?}", server.asked());
    refused_with(Path::new(&server.url("gone.tif")), &trusting(), &["cannot be opened", "gdalinfo"]);
}

#[test]
fn every_way_to_a_network_needs_the_flag() {
    for name in [
        "https://h/x.tif",
        "ftp://h/x.tif",
        "s3://b/x.tif",
        "gs://b/x.tif",
        "az://b/x.tif",
        "/vsis3/b/x.tif",
        "/vsigs/b/x.tif",
        "/vsiaz/b/x.tif",
        "/vsiadls/b/x.tif",
        "/vsioss/b/x.tif",
        "/vsiswift/b/x.tif",
        "/vsihdfs/b/x.tif",
        "/vsiwebhdfs/b/x.tif",
        "/vsizip//vsicurl/http://h/x.zip/x.tif",
    ] {
        refused(Path::new(name), &["lies on a network", "--allow-remote"]);
    }
}

#[test]
fn what_is_no_file_is_never_opened() {
    for name in [
        "/vsistdin/",
        "/vsimem/x.tif",
        "/vsisparse/x.xml",
        "/vsisubfile/0_9,x.tif",
        "/vsicrypt/key=a,file=x.tif",
        "/vsicached?file=x.tif",
        "/vsicurl_streaming/http://h/x.tif",
        "/vsicurl?url=http://h/x.tif",
        "/vsizip/{/tmp/x.zip}/x.tif",
        "/vsizip//vsigzip//tmp/x.zip.gz/x.tif",
        "MEM:::DATAPOINTER=1,PIXELS=2,LINES=2",
        "PG:dbname=x",
        "WMS:http://h/",
        "WCS:http://h/",
        "vrt://x.tif?bands=1",
        "<VRTDataset/>",
        "NETCDF:http://h/x.nc:dem",
        "NETCDF:\"http://h/x.nc\":dem",
        "NETCDF:/\"vsicurl/http://h\"/x.nc:dem",
        "HDF5:\"/vsicurl/http://h/x\"://dem",
    ] {
        refused_always(name, &["is no file", "save the raster to a file"]);
    }
    // What only looks like it is a file that is not there.
    for name in ["dem:old.tif", "/vsizip/gone.zip/x.tif", "GTIFF_DIR:1:gone.tif", "/VSICURL/x.tif", "C:\\x.tif"] {
        refused_always(name, &["no such file"]);
    }
}

#[test]
fn archives_and_grids_of_local_files_are_read() {
    let dir = folder();
    let tif = hill().write("GTiff", &dir.path().join("hill.tif"));
    let truth = read_all(&tif);
    let at = |before: &str, name: &str, after: &str| format!("{before}{}{after}", dir.path().join(name).display());
    copy(&tif, "AAIGrid", Path::new(&at("/vsizip/", "hill.zip", "/inner/hill.asc")));
    copy(&tif, "AAIGrid", Path::new(&at("/vsigzip/", "hill.asc.gz", "")));
    copy(&tif, "netCDF", &dir.path().join("hill.nc"));
    copy(&tif, "GPKG", &dir.path().join("hill.gpkg"));
    let tar = Command::new("tar").args(["-cf", "hill.tar", "hill.tif"]).current_dir(dir.path()).status().unwrap();
    assert!(tar.success());
    for name in [
        at("/vsizip/", "hill.zip", "/inner/hill.asc"),
        at("/vsigzip/", "hill.asc.gz", ""),
        at("/vsitar/", "hill.tar", "/hill.tif"),
        at("GTIFF_DIR:1:", "hill.tif", ""),
        at("NETCDF:", "hill.nc", ":Band1"),
        at("NETCDF:\"", "hill.nc", "\":Band1"),
        at("GPKG:", "hill.gpkg", ":hill"),
    ] {
        assert_eq!(read_all(Path::new(&name)).held().unwrap().heights(), truth.held().unwrap().heights(), "{name}");
    }
    let beside = Path::new("NETCDF:Cargo.toml:Band1");
    refused(beside, &["Cargo.toml", "cannot be opened"]);
}

#[test]
fn formats_off_the_list_are_refused() {
    let dir = folder();
    let (server, service) = hill_server(dir.path());
    fs::write(dir.path().join("service.xml"), service).unwrap();
    fs::write(
        dir.path().join("hill.xpm"),
        "/* XPM */\nstatic char *hill[] = {\n\"2 2 2 1\",\n\". c #000000\",\n\"o c #ffffff\",\n\".o\",\n\"o.\"\n};\n",
    )
    .unwrap();
    for name in ["service.xml", "hill.xpm"] {
        refused_always(
            dir.path().join(name).to_str().unwrap(),
            &["no raster format that hachure reads", "gdal_translate"],
        );
    }
    assert_eq!(server.asked(), [""; 0]);
}

/// The walls behind the checks: what slips past those still meets a GDAL without network, Python and other drivers.
#[test]
fn gdal_itself_is_restricted() {
    let dir = folder();
    let (server, service) = hill_server(dir.path());
    let local = read_all(&dir.path().join("served.tif"));
    fs::write(dir.path().join("service.xml"), service).unwrap();
    assert!(Dataset::open(format!("/vsicurl/{}", server.url("hill.tif"))).is_err());
    assert!(Dataset::open(dir.path().join("service.xml")).is_err());
    assert_eq!(server.asked(), [""; 0]);
    assert_eq!(
        trusted(&server.url("hill.tif")).held().unwrap().heights(),
        local.held().unwrap().heights(),
        "the next file may be trusted"
    );
    // Samples that stay in their files are read on any thread: there, too.
    let dem = read(dir.path().join("served.tif"), &ReadOptions { memory: 1, ..Default::default() }).unwrap();
    let url = format!("/vsicurl/{}", server.url("hill.tif"));
    let asked = server.asked();
    let opened = |reads: bool| {
        let work = || (reads && dem.window([0, 0], [1, 1]).is_err(), Dataset::open(&url).is_ok());
        std::thread::scope(|scope| scope.spawn(work).join().unwrap())
    };
    assert_eq!(opened(true), (false, false));
    assert_eq!(server.asked(), asked);
    assert_eq!(opened(false), (false, true), "a thread that reads no DEM is free: the check can fail");
    for driver in ["WMS", "WCS", "WMTS", "HTTP", "STACIT", "PostGISRaster", "PCIDSK", "ERS", "MRF", "Zarr"] {
        assert!(DriverManager::get_driver_by_name(driver).is_err(), "{driver}");
    }
    for driver in ["GTiff", "VRT", "MEM", "netCDF", "HFA", "GeoJSON"] {
        assert!(DriverManager::get_driver_by_name(driver).is_ok(), "{driver}");
    }
    assert_eq!(config::get_config_option("GDAL_VRT_ENABLE_PYTHON", "").unwrap(), "NO");
}

#[test]
fn the_band_is_the_one_asked_for() {
    let dir = folder();
    let path = dir.path().join("bands.tif");
    let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
    let mut file = driver.create_with_band_type::<i16, _>(&path, 2, 2, 3).unwrap();
    file.set_geo_transform(&super::TRANSFORM).unwrap();
    (1..=3).for_each(|band| file.rasterband(band).unwrap().fill(band as f64 * 100.0, None).unwrap());
    file.close().unwrap();
    let asked = |band| ReadOptions { band: Some(band), ..Default::default() };
    assert_eq!(read(&path, &asked(3)).unwrap().range(), Some([300.0, 300.0]));
    for band in [0, 4, usize::MAX] {
        refused_with(&path, &asked(band), &["has 3 bands", &format!("band {band};"), "`--band N` with N from 1 to 3"]);
    }
    let single = hill().write("GTiff", &dir.path().join("hill.tif"));
    refused_with(&single, &asked(2), &["has 1 band,", "band 2"]);
}

#[test]
fn files_that_cannot_be_read() {
    let dir = folder();
    let tif = hill().write("GTiff", &dir.path().join("hill.tif"));
    refused(&tif.join("inside"), &["cannot be read", "check the file and the disk"]);
    refused(Path::new(&"x".repeat(300)), &["cannot be read", "check the file"]);
    fs::write(dir.path().join("none.h5"), hdf5_of_nothing()).unwrap();
    refused(&dir.path().join("none.h5"), &["holds no grid", "raster band"]);
    // A file that not even root may read.
    #[cfg(target_os = "linux")]
    refused(Path::new("/sys/bus/platform/drivers_probe"), &["may not be read", "permission"]);
}

/// An HDF5 file whose root group is empty: superblock, object header, B-tree and heap of names, all of version 0 or 1.
fn hdf5_of_nothing() -> Vec<u8> {
    let addresses = |of: &[u64]| of.iter().flat_map(|a| a.to_le_bytes()).collect::<Vec<_>>();
    let nowhere = u64::MAX;
    [
        b"\x89HDF\r\n\x1a\n\0\0\0\0\0\x08\x08\0\x04\0\x10\0\0\0\0\0".to_vec(),
        addresses(&[0, nowhere, 720, nowhere, 0, 96, 1, 136, 680]),
        b"\x01\0\x01\0\x01\0\0\0\x18\0\0\0\0\0\0\0\x11\0\x10\0\0\0\0\0".to_vec(),
        addresses(&[136, 680]),
        [b"TREE\0\0\0\0".to_vec(), addresses(&[nowhere; 2]), vec![0; 520]].concat(),
        [b"HEAP\0\0\0\0".to_vec(), addresses(&[8, 1, 712, 0])].concat(),
    ]
    .concat()
}
