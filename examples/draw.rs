//! A DEM as ink on a page: `cargo run --release --example draw -- dem/golden-gate.tif picture.png`

use std::{env, error::Error, fs::File, io::BufWriter, sync::Arc};

use hachure::geo::{ReadOptions, read};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::view::{Fixed, Perspective, choose};
use hachure::{ink, line::Lines, plan::Plan, render::Renderer, surface::Surface};

fn main() -> Result<(), Box<dyn Error>> {
    let [dem, picture] = [1, 2].map(|i| env::args().nth(i));
    let (dem, picture) = dem.zip(picture).ok_or("give a DEM and a .png")?;
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default())?));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 1200, 600)?;
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
    let mut renderer = Renderer::new(gpu, surface)?;
    let page = renderer.page(&Plan::default(), &camera, |_| ())?;
    let style = ink::Style::for_page(1200);
    let lines = Lines::of(&page.marks, &Perspective::new(&camera, renderer.near()), style.tolerance);
    let drawing = ink::draw(&lines, &style);
    Ok(ink::write_png(&drawing, BufWriter::new(File::create(picture)?))?)
}
