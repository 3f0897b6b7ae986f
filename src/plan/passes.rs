//! The passes of a frame by their names: which run, in which order, how often and how far.

use super::{Border, Detail, LandLines, Plan, Yields};

/// A pass: the name of its shader, of its label and of its timer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PassName {
    /// Vertices on the surface.
    Tessellate,
    /// Vertices on sides shared with coarser chunks.
    Seam,
    /// One bit a facet.
    Facing,
    /// Vertices on the page.
    Project,
    /// Facets into the raster.
    Rasterize,
    /// Large and clipped facets into the raster.
    RasterizeLarge,
    /// Pixels between which a walk could meet an away facet, as far as chunks tell.
    Candidates,
    /// Those of them that the facets leave open.
    Pairs,
    /// Silhouettes by walking the lattice.
    Walk,
    /// The pairs that the walk leaves.
    WalkRest,
    /// Silhouettes by two depths.
    TowardAway,
    /// Silhouettes by facets that are no neighbours.
    Adjacency,
    /// The visible rim.
    Border,
    /// The chunks through which contours may run.
    Turning,
    /// Those of them whose vertices count.
    Wanted,
    /// How vertices face the eye, as far as their own chunk tells.
    Turn,
    /// What other chunks add on their sides.
    Meet,
    /// The facets through which contours run.
    Crossed,
    /// Contours, facet by facet.
    Segments,
    /// The rim where it faces the eye.
    RimSegments,
    /// Lines on the land, on its facets.
    Lay,
    /// Which of these are seen.
    Sight,
    /// What is read back.
    Compose,
}

/// How often a pass runs for a piece of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Often {
    /// In each round of each batch.
    EachRound,
    /// In the first round of each batch, and in later ones where other batches have overwritten its vertices.
    ForVertices,
    /// Once for each batch.
    EachBatch,
    /// Once.
    Once,
    /// Once, where its curves are asked for.
    ForCurves,
    /// Then, for each batch.
    ForCurvesOfBatch,
    /// Once, where the piece is read back.
    OnReading,
}

/// How far a pass reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// The chunks whose vertices are not on the device yet.
    FreshChunks,
    /// The chunks of the batch.
    Chunks,
    /// The chunks of all batches.
    AllChunks,
    /// Those of them that may appear.
    SeenChunks,
    /// The items of the list of this name.
    List(&'static str),
    /// The pixels of the piece.
    Pixels,
    /// The edges of the rim.
    RimEdges,
    /// What was found of curves, as much as there is room for.
    Found,
}

/// A pass of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlannedPass {
    /// Which.
    pub name: PassName,
    /// How often it runs.
    pub often: Often,
    /// Over what.
    pub over: Over,
}

impl PassName {
    /// The name in `shaders/`, of label and timer.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tessellate => "tessellate",
            Self::Seam => "seam",
            Self::Facing => "facing",
            Self::Project => "project",
            Self::Rasterize => "rasterize",
            Self::RasterizeLarge => "rasterize_large",
            Self::Candidates => "candidates",
            Self::Pairs => "pairs",
            Self::Walk => "walk",
            Self::WalkRest => "walk_rest",
            Self::TowardAway => "toward_away",
            Self::Adjacency => "adjacency",
            Self::Border => "border",
            Self::Turning => "turning",
            Self::Wanted => "wanted",
            Self::Turn => "turn",
            Self::Meet => "meet",
            Self::Crossed => "crossed",
            Self::Segments => "segments",
            Self::RimSegments => "rim_segments",
            Self::Lay => "lay",
            Self::Sight => "sight",
            Self::Compose => "compose",
        }
    }

    /// How often it runs, and how far.
    fn planned(self) -> PlannedPass {
        let (often, over) = match self {
            Self::Tessellate | Self::Seam => (Often::ForVertices, Over::FreshChunks),
            Self::Facing => (Often::EachBatch, Over::Chunks),
            Self::Project => (Often::ForVertices, Over::SeenChunks),
            Self::Rasterize => (Often::EachRound, Over::SeenChunks),
            Self::RasterizeLarge => (Often::EachRound, Over::List("queue")),
            Self::Pairs => (Often::Once, Over::List("candidates")),
            Self::Walk => (Often::Once, Over::List("pairs")),
            Self::WalkRest => (Often::Once, Over::List("rest")),
            Self::Candidates | Self::TowardAway | Self::Adjacency => (Often::Once, Over::Pixels),
            Self::Border => (Often::Once, Over::RimEdges),
            Self::Turning | Self::Wanted => (Often::ForCurves, Over::AllChunks),
            Self::Turn => (Often::ForCurvesOfBatch, Over::Chunks),
            Self::Meet | Self::Crossed => (Often::ForCurvesOfBatch, Over::SeenChunks),
            Self::Segments => (Often::ForCurvesOfBatch, Over::Found),
            Self::RimSegments => (Often::ForCurvesOfBatch, Over::RimEdges),
            Self::Lay | Self::Sight => (Often::ForCurves, Over::Found),
            Self::Compose => (Often::OnReading, Over::Pixels),
        };
        PlannedPass { name: self, often, over }
    }
}

/// The passes that frames of a plan may run, in their order.
pub fn passes(plan: &Plan) -> Vec<PlannedPass> {
    use PassName::{
        Compose, Crossed, Facing, Lay, Meet, Project, Rasterize, RasterizeLarge, RimSegments, Seam, Segments,
    };
    use PassName::{Sight, Tessellate, Turn, Turning, Wanted};
    let seam: &[_] = if let Detail::Adaptive { .. } = plan.detail { &[Seam] } else { &[] };
    let entry = plan.method.entry();
    // The rim of a method that yields curves is a curve too.
    let inked = plan.border == Border::On && entry.yields == Yields::Ink;
    let border: &[_] = if inked { &[PassName::Border] } else { &[] };
    let curves: &[_] = match plan.border {
        _ if !plan.has_curves() => &[],
        Border::On => &[Turning, Wanted, Turn, Meet, Crossed, Segments, RimSegments],
        Border::Off => &[Turning, Wanted, Turn, Meet, Crossed, Segments],
    };
    let seen: &[_] = match plan.land {
        _ if !plan.has_curves() => &[],
        LandLines::On => &[Lay, Sight],
        LandLines::Off => &[Sight],
    };
    let raster = &[Facing, Project, Rasterize, RasterizeLarge][..];
    let names = [&[Tessellate], seam, raster, entry.passes, border, curves, seen, &[Compose]];
    names.concat().into_iter().map(PassName::planned).collect()
}
