//! Hachure maps: the share of ink by slope, how strokes lie on the land.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use hachure::dem::Dem;
use hachure::door::line::Overhead;
use hachure::door::surface::LatticePoint;
use hachure::ink;
use hachure::ink::Surround;
use hachure::ink::{Drawing, HachureStyle, Sheet, Style, write_png};
use hachure::line::{Chain, Land, Lines, Recession};
use hachure::plan::{Hachures, Tone};
use hachure::relief::{ChannelArea, FlatWater, Relief, Slopes};
use hachure::surface::Surface;

/// Pixels of pictures and of frames for each millimetre.
pub const PX_PER_MM: f64 = 8.0;

/// A map of a DEM's hachures.
pub struct Map {
    pub surface: Arc<Surface>,
    land: Land,
    pub overhead: Overhead,
    pub look: Hachures,
    pub style: Style,
    pub strokes: Vec<Chain>,
}

impl Map {
    /// At 1:`scale`, of hachures alone.
    pub fn new(dem: Dem, scale: f64, hachures: HachureStyle) -> Self {
        let surface = Arc::new(Surface::new(dem));
        let relief = Relief::of(surface.dem(), 1.0).expect("flow");
        let creases = [relief.drainage(ChannelArea::Auto), relief.ridges().expect("ridges")].concat();
        let water = FlatWater::of(surface.dem(), 1.0).expect("water");
        let rules = hachures.rules().expect("hachures");
        let slopes = Slopes::new(surface.clone(), 1.0, rules, &creases, Some(&water)).expect("slope lines");
        let land = Land::new(surface.dem(), 1.0, Vec::new()).expect("land").with_slopes(Arc::new(slopes));
        let area = surface.dem().extent();
        let px_per_metre = PX_PER_MM * 1000.0 / scale;
        let size = [area[2] - area[0], area[3] - area[1]].map(|metres| (metres * px_per_metre).round() as u32);
        let style = Style { hachures, ..Style::default() };
        let overhead = Overhead { area, size, px_per_metre };
        let look = style.hachures(PX_PER_MM).expect("hachures").on_map();
        let strokes = overhead.land(&land, 0.0, Some(&look)).expect("strokes");
        Self { surface, land, overhead, look, style, strokes }
    }

    pub fn slopes(&self) -> &Slopes {
        self.land.slopes().expect("slope lines")
    }

    pub fn drawing(&self) -> Drawing {
        let [width, height] = self.overhead.size;
        let sheet = Sheet {
            size: DVec2::new(f64::from(width), f64::from(height)) / PX_PER_MM,
            margin: 0.0,
            surround: Surround::NONE,
        };
        let recession = Recession::of([(1.0, 1.0)].into_iter());
        let lines = Lines {
            width,
            height,
            eye: DVec3::Z * 1e9,
            chains: self.strokes.clone(),
            hidden: Vec::new(),
            recession,
            own: Vec::new(),
        };
        ink::draw(&lines, &sheet, &self.style, &[]).expect("a drawing")
    }

    /// How much of each pixel is ink, 0 to 1, row by row.
    pub fn ink(&self) -> Vec<f64> {
        let drawing = self.drawing();
        let mut png = Vec::new();
        write_png(&drawing, PX_PER_MM, &mut png).expect("a picture");
        let picture = image::load_from_memory(&png).expect("a picture").to_rgb8();
        assert_eq!([picture.width(), picture.height()], self.overhead.size);
        let grey = |rgb: [u8; 3]| Vec3::from(rgb.map(f32::from)).dot(Vec3::splat(1.0 / 3.0));
        let [paper, pen] = [self.style.paper.0, self.style.pens.hachure.colour.0].map(grey);
        picture.pixels().map(|pixel| f64::from((paper - grey(pixel.0)) / (paper - pen))).collect()
    }

    /// Gradient of the surface at a place of the frame by differences of its positions: metres for a metre east and north.
    pub fn gradient(&self, place: DVec2) -> Option<DVec2> {
        let cells = place / self.overhead.px_per_metre / self.surface.dem().cell();
        let at = |off: DVec2| {
            let at = ((cells + off) * 64.0).round();
            at.cmpge(DVec2::ZERO).all().then_some(LatticePoint { x: at.x as u32, y: at.y as u32 })
        };
        let step = 1.0 / 64.0;
        let [a, b, c] =
            [DVec2::ZERO, DVec2::new(step, 0.0), DVec2::new(0.0, step)].map(|off| self.surface.position(at(off)?));
        let (u, v) = (b? - a?, c? - a?);
        let normal = v.cross(u);
        Some(-normal.truncate() / normal.z)
    }
}

/// Hachures by slope alone.
pub fn lehmann() -> HachureStyle {
    HachureStyle { tone: Tone::Lehmann, ..HachureStyle::default() }
}

/// Of each class of 5 degrees from 5 on: the share of the map, ink wanted, ink there.
pub fn classes(map: &Map) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; 18];
    let [width, height] = map.overhead.size.map(|pixels| pixels as usize);
    let ink = map.ink();
    // Two by two pixels together: the slope is hardly another one within them.
    for (x, y) in (0..height / 2).flat_map(|y| (0..width / 2).map(move |x| (2 * x, 2 * y))) {
        let place = DVec2::new(x as f64, y as f64) + 1.0;
        let ink = [0, 1, width, width + 1].map(|i| ink[y * width + x + i]).iter().sum::<f64>() / 4.0;
        let Some(gradient) = map.gradient(place) else { continue };
        let slope = gradient.length().atan().to_degrees();
        let class = &mut sums[(slope / 5.0) as usize];
        let wanted = if slope < map.style.hachures.min_slope { 0.0 } else { (slope / map.look.black_at).min(1.0) };
        *class = [class[0] + 1.0, class[1] + wanted, class[2] + ink];
    }
    let all = (ink.len() / 4) as f64;
    sums.into_iter().map(|[count, wanted, ink]| [count / all, wanted / count, ink / count]).collect()
}
