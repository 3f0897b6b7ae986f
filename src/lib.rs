//! Pen-and-ink landscapes from digital elevation models: silhouettes in ink over a hidden-surface mask, on the GPU.
//!
//! A DEM to a picture:
//!
//! ```no_run
//! use hachure::geo::{ReadOptions, read};
//! use hachure::gpu::{AdapterChoice, Gpu, Int64};
//! use hachure::plan::{Curves, Plan};
//! use hachure::view::{Fixed, choose};
//! use hachure::ink::{self, Sheet, Style};
//! use hachure::{render::Renderer, surface::Surface};
//! use std::sync::Arc;
//!
//! let surface = Arc::new(Surface::new(read("dem/golden-gate.tif", &ReadOptions::default())?));
//! let camera = choose(surface.dem(), Fixed::default(), 60.0, 1200, 600)?;
//! let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
//! let mut renderer = Renderer::new(gpu, surface)?;
//! let plan = Plan { curves: Curves::On, ..Plan::default() };
//! let page = renderer.page(&plan, &camera, |_| ())?;
//! let (style, sheet) = (Style::default(), Sheet::for_frame([1200, 600]));
//! let px_per_mm = sheet.placement([1200, 600]).px_per_mm;
//! let lines = page.lines(&style.economy(px_per_mm), style.tolerance * px_per_mm);
//! let drawing = ink::draw(&lines, &sheet, &style, &[])?;
//! ink::write_png(&drawing, px_per_mm, std::fs::File::create("picture.png")?)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Stages
//!
//! | stage | from | to | where |
//! |---|---|---|---|
//! | read | raster files | [`Dem`](dem::Dem): a north-up grid of metres, voids marked | [`geo::read()`], CPU |
//! | surface | the grid | [`Surface`](surface::Surface): one normal a sample, cubic PN triangles between them | CPU, once a DEM |
//! | relief | heights without exaggeration, vector files | [`SurfaceLine`](relief::SurfaceLine)s: [`Relief`](relief::Relief), kept by [`Cache::creases`](cache::Cache::creases), and [`own_lines`](relief::own_lines) | CPU, where they are asked for |
//! | view | what is [`Fixed`](view::Fixed) of it, or nothing | [`Camera`](view::Camera): eye, directions, page | CPU |
//! | flight | a way over the land | the camera of each: [`Flight`](view::Flight) | CPU |
//! | plan | what is asked ([`Plan`](plan::Plan): method, level, border), a camera | [`Frame`](plan::Frame): lattice, batches, passes, what is left out | CPU |
//! | upload | surface and frame | [`Renderer`](render::Renderer): buffers and compiled passes | what is not there yet |
//! | frame | plan and camera | the mask, on the device: tessellate, facing, rasterize, silhouette, border | [`Renderer::frame`](render::Renderer::frame), GPU |
//! | curves | the frame | [`Curve`](line::Curve)s on the surface: contours and rims, linked, and lines of the land; each stretch seen or not | [`Renderer::curves`](render::Renderer::curves), GPU, CPU |
//! | read back | the mask | [`Drawn`](render::Drawn): ink, kind, sub-pixel place and depth a pixel | [`Renderer::read`](render::Renderer::read) |
//! | page | plan and camera | [`Page`](render::Page): ink and visible chains, frame and read-back for each piece of a page of any size | [`Renderer::page`](render::Renderer::page) |
//! | line | the page | [`Lines`](line::Lines): chains on the page and in the world, with weights; or traced from the ink | [`Page::lines`](render::Page::lines), CPU |
//! | ink | the lines | [`Drawing`](ink::Drawing): layers of strokes | [`ink::draw`], CPU |
//! | jobs | drawings to make | files that bear the names of what they are made of: [`job::run`] | CPU, beside the device |
//! | write | the drawing | PNG, SVG, PDF | [`ink::write_png`], [`ink::write_svg`], [`ink::write_pdf`] |
//! | truth | surface and camera | [`Truth`](truth::Truth): where the lines really are | [`Terrain::truth`](truth::Terrain::truth), CPU |
//! | judge | ink and truth | [`Scores`](truth::metrics::Scores): how far apart they are | [`Judge`](truth::metrics::Judge) |
//! | compare | methods and levels | [`Results`](report::Results): errors and times | [`Comparison`](measure::Comparison) |
//!
//! # How a frame is drawn
//!
//! ```text
//! DEM ── normals ── lattice ──▶ tessellate ─ facing ─ project ─ rasterize ┬ silhouette ─ border ─ compose ──▶ mask
//!      on the CPU, once          on the GPU, for every frame              └ contours ─ sight ──▶ curves ─ chains ─ strokes ─ PNG, SVG, PDF   on the CPU
//! ```
//!
//! 1. Each cell between four samples is split along NW-SE into two *patches*; each is a cubic PN triangle and is drawn as flat
//!    *facets*; far away one facet spans many cells. A facet *is* its place on the integer [`lattice`](surface::lattice): two are neighbours
//!    if they have two lattice vertices in common. No positions are ever compared.
//! 2. Each chunk of facets may have a [level of its own](plan::detail), from 64 down to 1/64. Neighbours differ by one level at most; along the side they
//!    share, the finer chunk takes the coarser one's vertices (pass `seam`), so that no crack opens. Samples come to the device in
//!    tiles of 17 x 17, as frames ask for them.
//! 3. `tessellate`: vertices on the surface, of those chunks that the last frames did not have; they stay on the device as long as a
//!    frame has no more than 16 384 chunks (8.4 million facets). `facing`: one bit a facet, toward the eye or away. `project`: where
//!    vertices lie on the page, snapped to 1/256 pixel. `rasterize`: both sides of every facet into one 64-bit word a pixel, depth
//!    above ID, by atomic maximum; facets with large boxes or across the near plane are queued and shared out by tiles
//!    (`rasterize_large`). Adjacent facets leave no pinholes.
//! 4. Silhouettes, by one of the [methods](plan::registry); the walk is four passes: `candidates` and `pairs` dismiss pixels between which nothing faces
//!    away, `walk` goes from one to the next, `walk_rest` does what is rare. `border`: the visible rim of the DEM and of its voids.
//!    `compose`: ink, kind, depth and sub-pixel place for reading back.
//! 5. Contours: g = n . (eye - p) at vertices, n the area-weighted sum of the normals of all facets around or, inside chunks where
//!    these do not all face one way, the surface's own (`turning`, `wanted`, `turn`, `meet`); where g changes its sign along
//!    lattice edges runs the contour (Hertzmann, Zorin 2000), one line a facet at most (`crossed`, `segments`; `rim_segments` for
//!    the rim). Lines are linked by lattice edges: curves that cannot branch.
//! 6. `sight`: a line is seen from a pixel centre beside it if the pixel shows what is farther, or if the straight way on the lattice
//!    from the pixel's point to the line meets no facet that faces away and no void. Where that leaves doubt, the sheets of land before
//!    it are counted (Appel 1967). What is seen are *chains*.
//! 7. Chains are stroked by the pens of a [`Style`](ink::Style). Strokes of `toward-away` and `adjacency`, and of ink that no contour accounts for, are
//!    traced from the mask.
//!
//! Chunks beside the page or behind nearer land, and walks that cannot meet anything, are left out; a test draws with and without and
//! compares bits. Large pages are drawn in [`pieces`](plan::pieces), of which only the inked pixels are kept; strokes are filled in bands of 128
//! rows, which go to the file one after the other: memory grows with the ink, not with the page.
//!
//! One pass has one name: `shaders/rasterize.wgsl` holds the pass `rasterize`, a line of `src/gpu/shaders.rs` what it is composed of. What runs for a frame is
//! planned in [`plan::passes`], in the order of [`render`].
//!
//! # Coordinates
//!
//! Sample (c, r) lies at the centre of its pixel. Depth is near / distance along the view axis. The Earth is flat. On one device and
//! driver the same input gives the same bytes; between devices divisions may round differently.
//!
//! World coordinates are metres, x east, y north, z up and exaggerated; angles are degrees, azimuth clockwise from the
//! world's y axis; pages are pixels from the top left corner. [`Georeference`](dem::Georeference) leads from there to the
//! coordinates of the file, to longitude and latitude, and to grid north and true north. Whatever can go wrong is an [`Error`](error::Error): what,
//! where and, where there is one, a remedy, in which settings stand by their names. A renderer draws as many frames as are asked of it, by any plan, on a page of any size; for each the
//! camera is uploaded, and what is not there yet.
//!
//! # Modules
//!
//! The folders stand in the order in which the data flows, and import only what stands above them:
//!
//! | module | does |
//! |---|---|
//! | [`files`] | outputs that are whole or not there, signals or not; which names mean one file |
//! | [`cache`] | a folder of what took long to make: found again, capped, made by one process at a time |
//! | [`dem`] | the grid: held in memory, or read as it is asked for |
//! | [`geo`] | rasters and systems of coordinates; alone knows GDAL, without which (`--no-default-features`) it reads nothing |
//! | [`surface`] | vertex normals, PN patches, the lattice and its IDs, bounds of chunks; what is kept of a DEM for them |
//! | [`relief`] | lines on the land that do not depend on the eye: drainage, ridges, shores, peaks, own lines |
//! | [`view`] | the camera, how it sees, a view where none is given, cameras along a way |
//! | [`plan`] | what a frame needs, as data: lattice, batches, passes, pieces, what is left out; the registry of methods |
//! | [`gpu`] | device, buffers, a table of passes; the mathematics stands in `shaders/` |
//! | [`mod@line`] | curves with kind and world place: ink traced to chains, smoothed; lines of the world projected |
//! | [`ink`] | chains to strokes to pictures |
//! | [`truth`] | where the lines really are, in f64, and how far ink is from them; knows nothing of the GPU |
//! | [`render`] | the whole algorithm on one screen |
//! | [`measure`] | trials against truth, costs of passes, floors beside their times; truths that are kept |
//! | [`job`] | many drawings as one piece of work: skipped where they are done, shared out, taken up again |
//! | [`stress`] | stiff and extreme cases, what they promise, and whether it is kept |
//! | [`report`] | comparisons as JSON, CSV, a plot and a page to read |
//! | [`cli`] | flags as typed become options checked |
//!
//! # Stiff and extreme cases
//!
//! [`stress`] makes land on which numbers may fail, and holds every method to promises with figures: slopes of 10 to 10 000, a needle of
//! 10 km, exaggeration up to 1 000, planes that hold the eye, the eye on, below and beside the land, fields of view of .001 to 179.9
//! degrees, cells of 1 mm and 10 km, northings of 0 and 10^7, land of 2 x 2 samples, pages of one pixel, voids of every shape. What holds
//! without exception: no NaN, no infinity, no pinhole, no frame that fails; the same bits where land and eye are shifted by whole
//! cells, scaled by a power of two, raised by whole metres. What bends, by how much, and what was tried stands in
//! [`stress::exceptions`]: lines a fraction of a pixel apart, as where patches fold or rows stand twice; what an eye on a sample sees a
//! millionth on; some pixels of lines where land is turned by half. On 2026-11-29 56 cases in 86 views kept 1 596 promises, 20 of
//! them by limits of their own.
//!
//! # Words
//!
//! Names are those of the field, where it has one. What it calls otherwise, or what this crate has of its own:
//!
//! | word | means |
//! |---|---|
//! | sample, cell | a height of the grid; the square between four of them |
//! | patch | a cubic PN triangle (Vlachos et al. 2001), half a cell |
//! | fold | a patch whose ground, its projection on the map, turns back on itself; a facet that stands on its head |
//! | limits | what share of their gradients samples keep, so that no patch folds |
//! | facet | a flat triangle that is drawn, on the integer lattice |
//! | chunk | 16 x 16 quads of facets with one level of detail: what others call a cluster or tile of the mesh |
//! | batch, slot | chunks that are drawn at once; the place of one in the device's buffers |
//! | toward, away | front and back facing |
//! | rim, border | the edge of the DEM and of its voids; the pass that draws it |
//! | mask, ink | the pixels that bear lines; one of them with its kind, depth and place |
//! | walk | going over the lattice between the points that two pixels show |
//! | seam | where chunks of different levels meet, made crack-free |
//! | sight | visibility of a line, as against that of a pixel |
//! | laid | draped on the facets that are drawn |
//! | curve, chain, stroke | a line on the surface; a visible run of one on the page; what a pen draws of it |
//! | economy, recession | leaving out lines that crowd or hardly part near from far; fading with distance |
//! | pops | what changes on the page between frames beyond what the camera moves |
//! | bare | of land: without hachures, since strokes would stand too close |
//! | frustum, culling | what a page sees, as seen on the map; leaving out what lies beyond it or cannot change the picture |
//! | slot cache | what frames leave on the device for later ones |
//! | yardstick | work that no choice of ours changes, by which times are told |
//! | the door | what the binary and the tests look into and nobody else: `hachure::door` |

#![deny(missing_docs)]
#![warn(unreachable_pub)]
// Those who read the code follow such links, or `cargo doc --document-private-items`.
#![allow(rustdoc::private_intra_doc_links)]
// Much serves the reading of rasters alone.
#![cfg_attr(not(feature = "gdal"), allow(dead_code, unused_imports))]

pub mod cache;
mod cli;
pub mod dem;
#[doc(hidden)]
pub mod door;
pub mod error;
mod files;
pub mod geo;
pub mod gpu;
pub mod ink;
mod job;
pub mod line;
mod measure;
pub mod plan;
pub mod relief;
pub mod render;
mod report;
mod stress;
pub mod surface;
pub mod truth;
pub mod view;
