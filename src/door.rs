//! What this crate's own binary and tests look into beside what users need: none of it is promised to anybody.

pub mod cache {
    pub use crate::cache::CacheKey;
    pub use crate::cache::CacheKind;
    pub use crate::cache::entry::KeptEntry;
    pub use crate::cache::entry::NewEntry;
}

pub mod cli {
    pub use crate::cli::Arguments;
    pub mod choices {
        pub use crate::cli::choices::default_share;
    }
    pub mod flight {
        pub use crate::cli::flight::*;
    }
    pub mod info {
        pub use crate::cli::info::*;
    }
    pub mod jobs {
        pub use crate::cli::jobs::JobShare;
    }
    pub mod lines {
        pub use crate::cli::lines::LinesArguments;
    }
    pub mod memory {
        pub use crate::cli::memory::*;
    }
    pub mod page {
        pub use crate::cli::page::*;
    }
    pub mod progress {
        pub use crate::cli::progress::Progress;
    }
    pub mod serve {
        pub use crate::cli::serve::run;
    }
    pub mod talk {
        pub use crate::cli::talk::{LinesTo, Talk, TalkArguments};
    }
    pub mod threads {
        pub use crate::cli::threads::*;
    }
    pub mod values {
        pub use crate::cli::values::*;
    }
    pub mod viewpoint {
        pub use crate::cli::viewpoint::{FOV, SIZE};
    }
    pub mod words {
        pub use crate::cli::words::*;
    }
    pub mod work {
        pub use crate::cli::work::JobWork;
    }
}

pub mod dem {
    pub use crate::dem::held::LARGEST_SIDE;
    pub use crate::dem::held::MAX_SAMPLES;
    pub use crate::dem::validity::BLOCK_SIDE;
    pub use crate::dem::validity::Validity;
    pub mod generalise {
        pub use crate::dem::generalise::{generalise, halo};
    }
    pub mod smoothest {
        pub use crate::dem::smoothest::{HALO, smoothest};
    }
}

pub mod files {
    pub use crate::files::Output;
    pub mod output {
        pub use crate::files::output::*;
    }
    pub mod signals {
        pub use crate::files::signals::*;
    }
}

/// Readers of what this crate parses itself, for tests that ask what becomes of a file, whatever it holds.
pub mod formats {
    use std::path::Path;

    use crate::cli::batch::entry;
    use crate::cli::viewpoint::{FOV, SIZE};
    use crate::cli::{flight_keys, views};
    use crate::error::Result;
    use crate::ink::Seal;

    /// A file of views.
    ///
    /// # Errors
    /// As all of these: [`Error::Input`](crate::error::Error::Input) for a file that is none.
    pub fn views(path: &Path) -> Result<()> {
        views::read(path, FOV, SIZE).map(drop)
    }

    /// A file of keys of a flight.
    pub fn flight(path: &Path) -> Result<()> {
        flight_keys::read(path).map(drop)
    }

    /// A file of drawings.
    pub fn batch(path: &Path) -> Result<()> {
        entry::read(path).and_then(|entries| entry::each_output_once(path, &entries))
    }

    /// The seal of a picture.
    pub fn seal(path: &Path) -> std::io::Result<Option<u128>> {
        Seal::job_of(path)
    }
}

pub mod geo {
    #[cfg(feature = "gdal")]
    pub use crate::geo::gdal::Reading;
    pub use crate::geo::track::with_layer;
}

pub mod gpu {
    pub use crate::gpu::capacity::Capacity;
    pub use crate::gpu::clock::Clock;
    pub use crate::gpu::uniforms::CameraUniform;
    pub mod clock {
        pub use crate::gpu::clock::{CLEAR, PASSES_OF_SET, Stamps};
    }
    pub mod curves {
        pub use crate::gpu::curves::*;
    }
    pub mod device {
        pub use crate::gpu::device::WAITED;
    }
    pub mod pace {
        pub use crate::gpu::pace::{Limits, Pace, Watch, Work};
    }
    pub mod pass {
        pub use crate::gpu::pass::{parse, reflect};
    }
    pub mod slot_cache {
        pub use crate::gpu::slot_cache::SlotCache;
    }
    pub mod shaders {
        pub use crate::gpu::shaders::{OWN_CONSTANTS, STRIP_FACETS, source};
    }
    pub mod sizes {
        pub use crate::gpu::sizes::{
            BLOCK, LARGEST_BINDING, LIST_HEADER, RIM_EDGE_BYTES, fits, of_page, of_scene, page_fits, rim_fits,
            valid_fits,
        };
    }
    pub mod uniforms {
        pub use crate::gpu::uniforms::{
            BatchUniform, ChunkUniform, Counts, SceneUniform, Segment, Tally, code, near_plane, seen,
        };
    }
}

pub mod ink {
    pub mod furniture {
        pub use crate::ink::furniture::{Credits, Texts};
    }
    pub mod letters {
        pub use crate::ink::letters::{Face, Lettering};
    }
    pub use crate::ink::unstroked::unstroked;
    pub mod drawing {
        pub use crate::ink::drawing::{Layer, Pen, StrokeForm};
    }
    pub mod outline {
        pub use crate::ink::outline::outline;
    }
    pub mod png {
        pub use crate::ink::png::size;
    }
    pub mod sheet {
        pub use crate::ink::sheet::PAPERS;
    }
    pub mod unstroked {
        pub use crate::ink::unstroked::{Unstroked, Why};
    }
}

pub mod job {
    pub use crate::job::Film;
    pub use crate::job::Frames;
    pub use crate::job::Inks;
    pub use crate::job::Job;
    pub use crate::job::JobFile;
    pub use crate::job::Manifest;
    pub use crate::job::Merged;
    pub use crate::job::Pattern;
    pub use crate::job::Shard;
    pub mod manifest {
        pub use crate::job::manifest::SequenceKey;
    }
    pub mod name {
        pub use crate::job::name::Naming;
    }
    pub mod serve {
        pub use crate::job::serve::*;
    }
}

pub mod line {
    pub mod smooth {
        pub use crate::line::smooth::smooth;
    }
    pub mod trace {
        pub use crate::line::trace::trace;
    }
    pub use crate::line::crowd::crowded;
    pub use crate::line::economy::economised;
    pub use crate::line::link::link;
    pub use crate::line::one_pixel::one_pixel_wide;
    pub use crate::line::overhead::Overhead;
    pub use crate::line::way::LandWay;
    pub mod detail {
        pub use crate::line::detail::From;
    }
    pub mod ends {
        pub use crate::line::ends::*;
    }
    pub mod hachures {
        pub use crate::line::hachures::{Viewer, hatched};
    }
    pub mod identity {
        pub use crate::line::identity::{Held, key, names};
    }
    pub mod visible {
        pub use crate::line::visible::{chains, seen_and_hidden};
    }
}

pub mod measure {
    pub use crate::measure::BareCopy;
    pub use crate::measure::Comparison;
    pub use crate::measure::DepthDraw;
    pub use crate::measure::Floor;
    pub use crate::measure::Growth;
    pub use crate::measure::Promise;
    pub use crate::measure::Sequence;
    pub use crate::measure::costs;
    pub mod chains {
        pub use crate::measure::chains::drawn_recall;
    }
    pub mod compare {
        pub use crate::measure::compare::{CompareObserver, Comparison, Finding, LEAST_TRUTH_LEVEL, ShownPicture};
    }
    pub mod cost {
        pub use crate::measure::cost::{PassCost, Quantities, Traffic};
    }
    pub mod curves {
        pub use crate::measure::curves::MeasuredCurves;
    }
    pub mod depth_draw {
        pub use crate::measure::depth_draw::*;
    }
    pub mod figures {
        pub use crate::measure::figures::{
            AtDistance, ChainFigures, Convergence, DepthBand, DrawnLevel, FloorFigures, LevelOffset, PassFigures,
            PlaceOffsets, Run, SequenceRun, TruthReport,
        };
    }
    pub mod kept {
        pub use crate::measure::kept::{SeenChains, ids_kept};
    }
    pub mod memory {
        pub use crate::measure::memory::{peak, reset_peak};
    }
    pub mod popped {
        pub use crate::measure::popped::{Looked, Popped};
    }
    pub mod trial {
        pub use crate::measure::trial::{Draws, Trial};
    }
}

pub mod plan {
    pub use crate::plan::batches::batches;
    pub use crate::plan::frame::Frame;
    pub use crate::plan::passes::PassName;
    pub use crate::plan::pieces::PagePiece;
    pub use crate::plan::pieces::Pieces;
    pub use crate::plan::registry::Yields;
    pub mod batches {
        pub use crate::plan::batches::{BATCH_CHUNKS, PART_CHUNKS};
    }
    pub mod detail {
        pub use crate::plan::detail::*;
    }
    pub mod frame {
        pub use crate::plan::frame::KeptLattice;
    }
    pub mod passes {
        pub use crate::plan::passes::passes;
    }
    pub mod registry {
        pub use crate::plan::registry::{Marker, PlotLook};
    }
    pub mod pieces {
        pub use crate::plan::pieces::{HALO, LARGEST_PAGE, LARGEST_PIECE, LONGEST_PIECE, Rectangle};
    }
}

pub mod relief {
    pub use crate::relief::coarse::lowest_and_highest;
    pub use crate::relief::coarse::on_samples;
    pub use crate::relief::kept::FlowLines;
    pub use crate::relief::whole::auto_cells;
    pub mod channels {
        pub use crate::relief::channels::{Channels, NO_NODE};
    }
    pub mod flow {
        pub use crate::relief::flow::Flow;
    }
    pub mod frame {
        pub use crate::relief::frame::FramedGrid;
    }
    pub mod slope {
        pub use crate::relief::slope::{Need, SlopeBlock, SlopeLine, SlopePoint, SlopeRules, Slopes};
    }
    pub mod threshold {
        pub use crate::relief::threshold::{AreaTrial, found};
    }
}

pub mod report {
    pub use crate::report::Picture;
    pub use crate::report::error_time_svg;
    pub use crate::report::growth_svg;
    pub use crate::report::report_html;
    pub use crate::report::write_csv;
    pub mod lines {
        pub use crate::report::lines::lines;
    }
    pub mod pictures {
        pub use crate::report::pictures::of_shown;
    }
    pub mod results {
        pub use crate::report::results::{ComparedScene, Machine, Results, SCHEMA, TruthSummary};
    }
}

pub mod stress {
    pub use crate::stress::{Case, Check, Group, Promise, all, named, short};
    pub mod accuracy {
        pub use crate::stress::accuracy::*;
    }
    pub mod conditioning {
        pub use crate::stress::conditioning::*;
    }
    pub mod drawing {
        pub use crate::stress::drawing::*;
    }
    pub mod exceptions {
        pub use crate::stress::exceptions::*;
    }
    pub mod finite {
        pub use crate::stress::finite::*;
    }
    pub mod flight {
        pub use crate::stress::flight::*;
    }
    pub mod folded {
        pub use crate::stress::folded::folded;
    }
    pub mod illustrated {
        pub use crate::stress::illustrated::*;
    }
    pub mod invariance {
        pub use crate::stress::invariance::*;
    }
    pub mod promise {
        pub use crate::stress::promise::*;
    }
    pub mod watertight {
        pub use crate::stress::watertight::*;
    }
}

pub mod surface {
    pub use crate::surface::folds::{Fold, PatchAt};
    pub use crate::surface::lattice::Chunk;
    pub use crate::surface::lattice::Lattice;
    pub use crate::surface::lattice::LatticePoint;
    pub use crate::surface::limits::Moved;
    pub use crate::surface::pyramid::Pyramid;
    pub use crate::surface::tile::Tile;
    pub mod lattice {
        pub use crate::surface::lattice::*;
    }
    pub mod normals {
        pub use crate::surface::normals::gradients;
    }
    pub mod patch {
        pub use crate::surface::patch::Patch;
    }
    pub mod quadtree {
        pub use crate::surface::quadtree::*;
    }
    pub mod rim {
        pub use crate::surface::rim::{RimEdge, rim, rim_length};
    }
    pub mod tile {
        pub use crate::surface::tile::*;
    }
}
