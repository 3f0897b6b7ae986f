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
//! | [`gpu`] | device, buffers, one adapter a pass; the mathematics stands in `shaders/` |
//! | [`mod@line`] | curves with kind and world place: ink traced to chains, smoothed; lines of the world projected |
//! | [`ink`] | chains to strokes to pictures |
//! | [`truth`] | where the lines really are, in f64, and how far ink is from them; knows nothing of the GPU |
//! | [`render`] | the whole algorithm on one screen |
//! | [`measure`] | trials against truth, costs of passes, floors beside their times; truths that are kept |
//! | [`job`] | many drawings as one piece of work: skipped where they are done, shared out, taken up again |
//! | [`report`] | comparisons as JSON, CSV, a plot and a page to read |
//! | [`cli`] | flags as typed become options checked |

#![deny(missing_docs)]

pub mod cache;
pub mod cli;
pub mod dem;
pub mod error;
pub mod files;
pub mod geo;
pub mod gpu;
pub mod ink;
pub mod job;
pub mod line;
pub mod measure;
pub mod plan;
pub mod relief;
pub mod render;
pub mod report;
pub mod surface;
pub mod truth;
pub mod view;
