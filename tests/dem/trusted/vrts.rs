//! What a VRT may name, and what stands beside a raster.

use super::*;

/// A VRT of one source of this name, attributes of the name before it.
fn of_source(path: &Path, attributes: &str, name: &str) -> std::path::PathBuf {
    let name = name.replace('&', "&amp;").replace('<', "&lt;");
    vrt(path, "", &format!("<SimpleSource><SourceFilename{attributes}>{name}</SourceFilename></SimpleSource>"))
}

const RELATIVE: &str = " relativeToVRT=\"1\"";

#[test]
fn a_vrt_names_files_of_its_folder() {
    let dir = folder();
    let inner = dir.path().join("inner");
    fs::create_dir_all(inner.join("deeper")).unwrap();
    let secret = hill().write("GTiff", &dir.path().join("secret.tif"));
    let truth = read_all(&secret);
    let tif = hill().write("GTiff", &inner.join("hill.tif"));
    hill().write("GTiff", &inner.join("deeper/hill.tif"));
    copy(&tif, "netCDF", &inner.join("hill.nc"));
    copy(&tif, "AAIGrid", Path::new(&format!("/vsigzip/{}", inner.join("hill.asc.gz").display())));
    let at = |before: &str, name: &str, after: &str| format!("{before}{}{after}", inner.join(name).display());
    let path = inner.join("hill.vrt");
    for (attributes, name) in [
        (RELATIVE, "hill.tif".to_owned()),
        (RELATIVE, "./deeper/hill.tif".to_owned()),
        (RELATIVE, at("", "hill.tif", "")),
        (" relativeToVRT=\"0\"", at("", "hill.tif", "")),
        ("", at("", "deeper/hill.tif", "")),
        ("", at("NETCDF:", "hill.nc", ":Band1")),
        (RELATIVE, "NETCDF:hill.nc:Band1".to_owned()),
        ("", at("GTIFF_DIR:1:", "hill.tif", "")),
        ("", at("/vsigzip/", "hill.asc.gz", "")),
    ] {
        assert_eq!(
            read_all(&of_source(&path, attributes, &name)).held().unwrap().heights(),
            truth.held().unwrap().heights(),
            "{name}"
        );
    }
    let outside = ["lies outside its folder", "--allow-remote"];
    for (attributes, name) in [
        (RELATIVE, "../secret.tif".to_owned()),
        (RELATIVE, "deeper/../../secret.tif".to_owned()),
        (RELATIVE, secret.display().to_string()),
        ("", secret.display().to_string()),
        ("", at("", "../secret.tif", "")),
        ("", format!("GTIFF_DIR:1:{}", secret.display())),
    ] {
        refused(&of_source(&path, attributes, &name), &[&outside[..], &[name.as_str()]].concat());
    }
    // Without relativeToVRT a name counts from the working folder, even where that is the VRT's own.
    let path = of_source(&path, "", "hill.tif");
    let command = Command::new(env!("CARGO_BIN_EXE_hachure")).args(["info", "hill.vrt"]).current_dir(&inner).output();
    let said = String::from_utf8(command.unwrap().stderr).unwrap();
    assert!(said.contains("another file in each working folder; write it with relativeToVRT=\"1\""), "{said}");
    let raw: Vec<_> = truth.held().unwrap().heights().iter().flat_map(|height| height.to_le_bytes()).collect();
    fs::write(inner.join("raw"), raw).unwrap();
    let band = "dataType=\"Float32\" band=\"1\" subClass=\"VRTRawRasterBand\"><ByteOrder>LSB</ByteOrder>\
                <SourceFilename relativeToVRT=\"1\">raw</SourceFilename>";
    assert_eq!(
        read_all(&vrt(&inner.join("raw.vrt"), "", band)).held().unwrap().heights(),
        truth.held().unwrap().heights()
    );
    // A part that is cut short is noticed, each time.
    let bytes = fs::read(&tif).unwrap();
    fs::write(inner.join("cut.tif"), &bytes[..bytes.len() - 20]).unwrap();
    refused(&of_source(&path, RELATIVE, "cut.tif"), &["damaged or cut short"]);
    fs::write(inner.join("cut.tif"), &bytes[..9]).unwrap();
    refused_with(&of_source(&path, RELATIVE, "cut.tif"), &trusting(), &["damaged or cut short"]);
    refused_with(&of_source(&path, RELATIVE, "cut.tif"), &trusting(), &["damaged or cut short"]);
    assert_eq!(
        trusted(of_source(&path, RELATIVE, "../secret.tif").to_str().unwrap()).held().unwrap().heights(),
        truth.held().unwrap().heights()
    );
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, inner.join("link.tif")).unwrap();
        refused(&of_source(&path, RELATIVE, "link.tif"), &outside);
        // A link to a VRT: what it names lies beside the VRT, not beside the link.
        let real = of_source(&path, RELATIVE, "hill.tif");
        std::os::unix::fs::symlink(&real, dir.path().join("link.vrt")).unwrap();
        assert_eq!(read_all(&dir.path().join("link.vrt")).held().unwrap().heights(), truth.held().unwrap().heights());
    }
}

#[test]
fn a_vrt_names_nothing_but_local_rasters() {
    let dir = folder();
    let (server, service) = hill_server(dir.path());
    let path = dir.path().join("hill.vrt");
    let url = server.url("hill.tif");
    for name in [url.clone(), format!("/vsicurl/{url}"), format!("/vsigzip//vsicurl/{url}")] {
        refused(&of_source(&path, "", &name), &[&name, "lies on a network", "--allow-remote"]);
    }
    fs::write(dir.path().join("service.xml"), &service).unwrap();
    fs::write(dir.path().join("notes.txt"), "no raster").unwrap();
    fs::create_dir(dir.path().join("folder")).unwrap();
    for (name, words) in [
        ("service.xml", ["no raster format that hachure reads", "gdal_translate"]),
        ("notes.txt", ["no raster format that hachure reads", "gdal_translate"]),
        ("folder", ["which is no file", "raster file itself"]),
        ("gone.tif", ["is not there", "download it again"]),
        ("/vsistdin/", ["which is no file", "gdal_translate"]),
        ("MEM:::DATAPOINTER=1,PIXELS=4,LINES=3", ["which is no file", "gdal_translate"]),
        ("NETCDF:\"http://127.0.0.1:1/x.nc\":dem", ["which is no file", "gdal_translate"]),
        ("vrt://served.tif", ["which is no file", "gdal_translate"]),
        (&service, ["which is no file", "gdal_translate"]),
    ] {
        let path = of_source(&path, RELATIVE, name);
        refused_always(path.to_str().unwrap(), &words);
    }
    assert_eq!(server.asked(), [""; 0], "nothing is asked of a server that is not trusted");
    refused_with(&of_source(&path, "", &url), &trusting(), &["write `/vsicurl/http://127.0.0.1:"]);
    let remote = of_source(&path, "", &format!("/vsicurl/{url}"));
    assert_eq!(
        trusted(remote.to_str().unwrap()).held().unwrap().heights(),
        read_all(&dir.path().join("served.tif")).held().unwrap().heights()
    );
    refused_always(of_source(&path, " relativeToVRT=\"2\"", "served.tif").to_str().unwrap(), &["neither 0 nor 1"]);
}

#[test]
fn every_element_that_names_a_raster_is_seen() {
    let dir = folder();
    let inner = dir.path().join("inner");
    fs::create_dir(&inner).unwrap();
    let path = inner.join("hill.vrt");
    hill().write("GTiff", &dir.path().join("secret.tif"));
    let secret = "<SourceFilename relativeToVRT=\"1\">../secret.tif</SourceFilename>";
    let outside = ["\"../secret.tif\"", "outside its folder"];
    for band in [
        format!("<Overview>{secret}</Overview>"),
        format!(
            "<MaskBand><VRTRasterBand dataType=\"Byte\"><SimpleSource>{secret}</SimpleSource></VRTRasterBand></MaskBand>"
        ),
        format!("<SimpleSource>{}</SimpleSource>", secret.replace("SourceFilename", "SOURCEFILENAME")),
        "<SimpleSource SourceFilename=\"../secret.tif\"/>".to_owned(),
        format!("<SimpleSource>{}</SimpleSource>", secret.replace("../secret.tif", "<![CDATA[../secret.tif]]>")),
        format!("dataType=\"Byte\" band=\"1\" subClass=\"VRTRawRasterBand\">{secret}"),
        "<GDALWarpOptions><SourceDataset relativeToVRT=\"1\">../secret.tif</SourceDataset></GDALWarpOptions>"
            .to_owned(),
        "<RPCTransformer><DEMPath>../secret.tif</DEMPath></RPCTransformer>".to_owned(),
    ] {
        refused(&vrt(&path, "", &band), &outside);
    }
    let address = "/vsicurl/http://127.0.0.1:1/x.tif";
    for head in [
        format!("<Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">{address}</MDI></Metadata>"),
        format!("<Metadata domain=\"GEOLOCATION\"><MDI key=\"x_dataset\">NETCDF:\"{address}\":lon</MDI></Metadata>"),
        format!("<Unheard><Of>{address}</Of></Unheard>"),
        "<SRS>http://127.0.0.1:1/srs</SRS>".to_owned(),
    ] {
        refused(&vrt(&path, &head, "<Scale>1</Scale>"), &["lies on a network", "--allow-remote"]);
    }
    let placed = "<GeoTransform>500000, 30, 0, 4200000, 0, -20</GeoTransform>";
    let harmless = "<Metadata><MDI key=\"LICENCE\">https://creativecommons.org</MDI></Metadata>";
    read_all(&vrt(&path, &format!("{placed}{harmless}"), "<Scale>1</Scale>"));
}

#[test]
fn code_options_and_unknown_kinds_are_refused() {
    let dir = folder();
    let written = dir.path().join("written");
    let path = dir.path().join("hill.vrt");
    hill().write("GTiff", &dir.path().join("hill.tif"));
    let source = "<SimpleSource><SourceFilename relativeToVRT=\"1\">hill.tif</SourceFilename></SimpleSource>";
    let python = format!(
        "dataType=\"Float32\" band=\"1\" subClass=\"VRTDerivedRasterBand\"><PixelFunctionType>f</PixelFunctionType>\
         <PixelFunctionLanguage>Python</PixelFunctionLanguage><PixelFunctionCode><![CDATA[\nimport os\n\
         open('{0}', 'w').close()\ndef f(*a, **k):\n    open('{0}', 'w').close()\n]]></PixelFunctionCode>{source}",
        written.display()
    );
    refused_always(vrt(&path, "", &python).to_str().unwrap(), &["holds code (Python)", "never run", "gdal_translate"]);
    // Even past the inspection GDAL does not run it.
    let band = Dataset::open(&path).unwrap();
    let _ = band.rasterband(1).unwrap().read_band_as::<f32>();
    assert!(!written.exists());
    let own = python.replace("Python", "C").replace("<PixelFunctionType>f", "<PixelFunctionType>mod");
    let own = format!("{}{source}", own.split("<PixelFunctionCode>").next().unwrap());
    assert_eq!(
        read_all(&vrt(&path, "", &own)).held().unwrap().heights(),
        read_all(&dir.path().join("hill.tif")).held().unwrap().heights()
    );
    let options =
        source.replace("</SimpleSource>", "<OpenOptions><OOI key=\"ROOT_PATH\">/</OOI></OpenOptions></SimpleSource>");
    read_all(&vrt(&path, "", &options.replace("ROOT_PATH\">/", "OVERVIEW_LEVEL\">NONE")));
    refused_always(vrt(&path, "", &options).to_str().unwrap(), &["options for GDAL's drivers", "gdal_translate"]);
    fs::write(&path, "<VRTDataset subClass=\"VRTProcessedDataset\"></VRTDataset>").unwrap();
    refused_always(path.to_str().unwrap(), &["of a kind that is not read (VRTProcessedDataset)", "gdal_translate"]);
    fs::write(&path, "<VRTDataset rasterXSize=\"4\"><Open>").unwrap();
    refused_always(path.to_str().unwrap(), &["damaged VRT (", "download it again"]);
}

#[test]
fn vrts_in_vrts_are_looked_into() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let tif = hill().write("GTiff", &at("hill.tif"));
    of_source(&at("0.vrt"), RELATIVE, "hill.tif");
    for depth in 1..9 {
        of_source(&at(&format!("{depth}.vrt")), RELATIVE, &format!("{}.vrt", depth - 1));
    }
    assert_eq!(read_all(&at("7.vrt")).held().unwrap().heights(), read_all(&tif).held().unwrap().heights());
    refused_always(at("8.vrt").to_str().unwrap(), &["its part \"0.vrt\"", "more than 8 deep"]);
    of_source(&at("0.vrt"), "", "/vsicurl/http://127.0.0.1:1/x.tif");
    refused(&at("3.vrt"), &["its part \"0.vrt\" names", "lies on a network"]);
    of_source(&at("0.vrt"), RELATIVE, "2.vrt");
    refused_always(at("2.vrt").to_str().unwrap(), &["names itself"]);
    // Known by its content, not by its name; and once seen, it may be named again.
    of_source(&at("0.vrt"), RELATIVE, "../secret.tif");
    fs::copy(at("0.vrt"), at("zero.tif")).unwrap();
    refused(&of_source(&at("outer.vrt"), RELATIVE, "zero.tif"), &["its part \"zero.tif\" names \"../secret.tif\""]);
    refused(&at("zero.tif"), &["names \"../secret.tif\""]);
    of_source(&at("0.vrt"), RELATIVE, "hill.tif");
    let twice = "<SimpleSource><SourceFilename relativeToVRT=\"1\">0.vrt</SourceFilename></SimpleSource>".repeat(2);
    read_all(&vrt(&at("twice.vrt"), "", &twice));
}

#[test]
fn what_stands_beside_a_raster_is_looked_into() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    hill().write("GTiff", &at("hill.tif"));
    of_source(&at("hill.vrt"), RELATIVE, "hill.tif");
    for ending in ["msk", "ovr", "MSK", "OVR"] {
        let beside = of_source(&at(&format!("hill.tif.{ending}")), "", "/vsicurl/http://127.0.0.1:1/x.tif");
        let part = format!("its part \"hill.tif.{ending}\" names");
        for name in ["hill.tif", "hill.vrt"] {
            refused(&at(name), &[&part, "lies on a network"]);
        }
        fs::remove_file(beside).unwrap();
    }
    let metadata = "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">http://127.0.0.1:1/x.tif</MDI>\
                    </Metadata></PAMDataset>";
    fs::write(at("hill.tif.aux.xml"), metadata).unwrap();
    refused(&at("hill.tif"), &["its part \"hill.tif.aux.xml\" names", "lies on a network"]);
    let esri = "<PAMDataset><GeodataXform xmlns:xs=\"http://www.w3.org/2001/XMLSchema\"/></PAMDataset>";
    for harmless in [esri, "<PAMDataset><Broken>"] {
        fs::write(at("hill.tif.aux.xml"), harmless).unwrap();
        read_all(&at("hill.tif"));
    }
}

#[test]
fn a_vrt_in_an_archive_is_unpacked_first() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    hill().write("GTiff", &at("hill.tif"));
    of_source(&at("hill.vrt"), RELATIVE, "hill.tif");
    of_source(&at("hill.tif.msk"), RELATIVE, "hill.tif");
    let run = |program: &str, args: &[&str]| {
        assert!(Command::new(program).args(args).current_dir(dir.path()).status().unwrap().success(), "{program}");
    };
    run("gzip", &["-k", "hill.vrt"]);
    run("tar", &["-cf", "hill.tar", "hill.vrt"]);
    run("tar", &["-cf", "masked.tar", "hill.tif", "hill.tif.msk"]);
    let inside = format!("/vsitar/{}/hill.vrt", at("hill.tar").display());
    let masked = format!("/vsitar/{}/hill.tif", at("masked.tar").display());
    for name in [at("hill.vrt.gz").to_str().unwrap(), &inside, &masked] {
        refused_always(name, &["VRT in an archive", "unpack it"]);
    }
    refused(&of_source(&at("outer.vrt"), "", &inside), &["its part", "VRT in an archive"]);
}

#[test]
fn a_vrt_on_a_network_names_what_lies_beside_it() {
    let dir = folder();
    let tif = hill().write("GTiff", &dir.path().join("hill.tif"));
    let truth = read_all(&tif);
    let bytes =
        |attributes: &str, name: &str| fs::read(of_source(&dir.path().join("x.vrt"), attributes, name)).unwrap();
    let python = "<PixelFunctionLanguage>Python</PixelFunctionLanguage>";
    let code = fs::read(vrt(&dir.path().join("x.vrt"), "", python)).unwrap();
    let server = Server::new(&[
        ("near/hill.tif", fs::read(&tif).unwrap()),
        ("near/hill.vrt", bytes(RELATIVE, "hill.tif")),
        ("near/outer.vrt", bytes(RELATIVE, "hill.vrt")),
        ("local.vrt", bytes("", tif.to_str().unwrap())),
        ("plain.vrt", bytes("", "hill.tif")),
        ("grid.vrt", bytes(RELATIVE, "GTIFF_DIR:1:hill.tif")),
        ("python.vrt", code),
    ]);
    for name in ["near/hill.vrt", "near/outer.vrt"] {
        refused(Path::new(&server.url(name)), &["--allow-remote"]);
        assert_eq!(server.asked().iter().filter(|line| line.contains(name)).count(), 0);
        assert_eq!(trusted(&server.url(name)).held().unwrap().heights(), truth.held().unwrap().heights(), "{name}");
    }
    for name in ["local.vrt", "plain.vrt", "grid.vrt"] {
        refused_with(Path::new(&server.url(name)), &trusting(), &["does not lie beside it on the network", "download"]);
    }
    refused_with(Path::new(&server.url("python.vrt")), &trusting(), &["holds code (Python)"]);
}
