//! The same view by every method, with what each inks and takes: `cargo run --release --example methods -- DEM FOLDER`

use std::{env, error::Error, fs::File, io::BufWriter, path::PathBuf, sync::Arc, time::Instant};

use hachure::geo::{ReadOptions, read};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Method, Plan};
use hachure::view::{Fixed, choose};
use hachure::{ink, render::Renderer, surface::Surface};

/// Frames behind each median.
const FRAMES: usize = 9;

fn main() -> Result<(), Box<dyn Error>> {
    let [dem, folder] = [1, 2].map(|i| env::args().nth(i).map(PathBuf::from));
    let (dem, folder) = dem.zip(folder).ok_or("give a DEM and a folder for the masks")?;
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default())?));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 1200, 600)?;
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
    let mut renderer = Renderer::new(gpu, surface)?;
    println!("{:18} {:>9} {:>9}", "method", "inked px", "frame ms");
    for method in Method::ALL {
        let name = method.entry().name;
        let plan = Plan { method, ..Plan::default() };
        let marks = renderer.page(&plan, &camera, |_| ())?.marks;
        let mut times = Vec::with_capacity(FRAMES);
        for step in 0..FRAMES {
            // A metre to the east each time, so that nothing kept from the last frame helps.
            let mut moved = camera;
            moved.eye.x += step as f64;
            let start = Instant::now();
            renderer.frame(&plan, &moved)?;
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
        times.sort_by(f64::total_cmp);
        println!("{name:18} {:9} {:9.1}", marks.inked(), times[FRAMES / 2]);
        let mask = File::create(folder.join(name).with_extension("png"))?;
        ink::write_mask([1200, 600], marks.places(), None, BufWriter::new(mask))?;
    }
    Ok(())
}
