//! A DEM as ink on a page: `cargo run --release --example draw -- dem/golden-gate.tif picture.png`

use std::{env, error::Error, fs::File, io::BufWriter, sync::Arc};

use hachure::geo::{ReadOptions, read};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::ink::{self, Sheet, Style};
use hachure::plan::{Curves, Plan};
use hachure::view::{Fixed, choose};
use hachure::{render::Renderer, surface::Surface};

fn main() -> Result<(), Box<dyn Error>> {
    let [dem, picture] = [1, 2].map(|i| env::args().nth(i));
    let (dem, picture) = dem.zip(picture).ok_or("give a DEM and a .png")?;
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default())?));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 1200, 600)?;
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
    let mut renderer = Renderer::new(gpu, surface)?;
    let plan = Plan { curves: Curves::On, ..Plan::default() };
    let page = renderer.page(&plan, &camera, |_| ())?;
    let (style, sheet) = (Style::default(), Sheet::for_frame([1200, 600]));
    let px_per_mm = sheet.placement([1200, 600]).px_per_mm;
    let lines = page.lines(&style.economy(px_per_mm), style.tolerance * px_per_mm);
    let drawing = ink::draw(&lines, &sheet, &style, &[])?;
    Ok(ink::write_png(&drawing, px_per_mm, BufWriter::new(File::create(picture)?))?)
}
