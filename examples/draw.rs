//! A DEM as ink on a page: `cargo run --release --example draw -- dem/golden-gate.tif picture.png`

use std::{env, error::Error, fs::File, io::BufWriter, sync::Arc};

use hachure::dem::{ReadOptions, read};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::view::{Fixed, choose};
use hachure::{ink, plan::Plan, render::Renderer, surface::Surface};

fn main() -> Result<(), Box<dyn Error>> {
    let [dem, picture] = [1, 2].map(|i| env::args().nth(i));
    let (dem, picture) = dem.zip(picture).ok_or("give a DEM and a .png")?;
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default())?));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 1200, 600)?;
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
    let page = Renderer::new(gpu, surface)?.page(&Plan::default(), &camera, |_| ())?;
    let drawing = ink::draw(&page.marks, &ink::Style::for_page(1200));
    Ok(ink::write_png(&drawing, BufWriter::new(File::create(picture)?))?)
}
