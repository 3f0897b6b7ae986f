//! The lines that a view shows, on the map: `cargo run --release --example contours -- dem/golden-gate.tif lines.gpkg`

use std::{env, error::Error, fs, sync::Arc};

use hachure::geo::{MapFormat, MapLine, ReadOptions, read, write_lines};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::line::mapped;
use hachure::plan::{Curves, Plan};
use hachure::view::{Fixed, choose};
use hachure::{ink::Style, render::Renderer, surface::Surface};

/// Pixels for each millimetre of the page, by which the style's widths and gaps are told.
const PX_PER_MM: f64 = 5.0;

fn main() -> Result<(), Box<dyn Error>> {
    let [dem, file] = [1, 2].map(|i| env::args().nth(i));
    let (dem, file) = dem.zip(file).ok_or("give a DEM and a .gpkg")?;
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default())?));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 1200, 600)?;
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
    let mut renderer = Renderer::new(gpu, surface.clone())?;
    let plan = Plan { curves: Curves::On, ..Plan::default() };
    let page = renderer.page(&plan, &camera, |_| ())?;
    let style = Style::default();
    let lines = page.lines(&style.economy(PX_PER_MM), style.tolerance * PX_PER_MM);
    let georeference = surface.dem().georeference();
    let mut found = Vec::new();
    for line in mapped(&lines, None, &surface)? {
        let place =
            |point: &glam::DVec3| Some(georeference.place_in(georeference.file(), point.truncate())?.extend(point.z));
        found.push(MapLine {
            kind: line.line.name().to_owned(),
            layer: None,
            id: line.id.map(|id| format!("{}-{}", id.written(), line.piece)),
            order: line.order,
            depth: Some(line.distance(camera.eye)),
            length: line.length(),
            points: line.points.iter().map(place).collect::<Option<_>>().ok_or("a line leaves the file's system")?,
        });
    }
    fs::write(file, write_lines(MapFormat::GeoPackage, georeference.file(), &found)?)?;
    println!("{} lines", found.len());
    Ok(())
}
