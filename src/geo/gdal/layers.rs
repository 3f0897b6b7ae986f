//! Files as layers that lie on one another: those whose samples fall on one grid make a layer, and the finest is on top.
//!
//! Finer than another is a layer whose cells are smaller on the ground; of like ones that with the last file is on top.
//! In the order given, files one after another make a layer, and the last is on top. Cost: the files are opened, no sample
//! is read. Not handled: a file of which parts are finer than others.

use std::path::{Path, PathBuf};

use glam::{DAffine2, DVec2};

use super::crop;
use super::crs::CrsPath;
use super::grid::GeoGrid;
use super::handles::Opening;
use super::layer::{FileLayer, Placed, and_more, reach};
use super::lie::Lie;
use super::metric::metric;
use super::part::Part;
use super::target::Target;
use crate::dem::{Crs, History, Window};
use crate::error::{Error, Result, Setting, shown};
use crate::geo::{Order, ReadOptions};

/// Cells that differ by no more than this share are as fine as each other.
pub(super) const AS_FINE: f64 = 0.02;

/// Files on one grid or several.
pub(super) struct Layers {
    /// From the bottom to the top, at least one.
    all: Vec<FileLayer>,
    /// The one with the first file.
    first: usize,
    /// The one whose grid was asked for.
    chosen: Option<usize>,
}

/// Files of one layer while it grows, with their numbers among all.
struct Group {
    base: GeoGrid,
    files: Vec<(Placed, Lie)>,
    numbers: Vec<usize>,
}

impl Layers {
    /// Opens `paths`, at least one, and checks all that can be checked without reading samples.
    pub(super) fn open(paths: &[PathBuf], options: &ReadOptions, history: &mut History) -> Result<Self> {
        let chosen = options.cell_of.as_deref().map(|path| number_of(path, paths)).transpose()?;
        let mut opening = Opening::default();
        let mut groups: Vec<Group> = Vec::new();
        for (i, path) in paths.iter().enumerate() {
            let mut own = History::default();
            let like = groups.first().map(|first| &first.base.crs);
            let placed = Placed::open(path, options, paths.len() == 1, like, &mut opening, &mut own)?;
            if let Some(first) =
                groups.first().filter(|first| CrsPath::between(&placed.grid.crs, &first.base.crs).is_none())
            {
                let first = (first.files[0].0.path(), &first.files[0].0.grid);
                return Err(no_way([(path, &placed.grid), first]));
            }
            history.take(own, (i > 0).then_some(path));
            sort_in(placed, i, options.order, &mut groups);
        }
        if let (Some(first), Some(_)) = (groups.first().map(|first| first.base.clone()), options.crop) {
            let crop = crop::on(&first, options.crop)?;
            groups.iter_mut().try_for_each(|group| group.beside_itself(&first.crs, crop, options, &mut opening))?;
        }
        if groups.iter().any(|group| group.base.to_crs != group.files[0].0.grid.to_crs && group.base.is_north_up()) {
            history.convert("rows and columns are read backwards, north up");
        }
        let layers = Self::stacked(groups, chosen, options.order)?;
        if let ([layer], true) = (layers.all.as_slice(), paths.len() > 1) {
            let GeoGrid { columns, rows, .. } = layer.grid;
            history.convert(format!("{} files laid together: {columns} x {rows} samples", paths.len()));
        }
        Ok(layers)
    }

    /// Puts the groups on one another; `chosen` is the number of the file whose grid was asked for.
    fn stacked(groups: Vec<Group>, chosen: Option<usize>, order: Order) -> Result<Self> {
        let cells: Vec<_> = groups.iter().map(|group| ground_cell(&group.base)).collect();
        let lasts: Vec<_> = groups.iter().map(|group| group.numbers.last().copied().unwrap_or(0)).collect();
        let places = match order {
            Order::FinestOnTop => finest_last(&cells, &lasts),
            Order::Given => (0..groups.len()).collect(),
        };
        let holds = |number: usize| places.iter().position(|place| groups[*place].numbers.contains(&number));
        let (first, chosen) = (holds(0), chosen.and_then(holds));
        let several = groups.len() > 1 || lasts.iter().any(|last| *last > 0);
        let mut groups: Vec<_> = groups.into_iter().map(Some).collect();
        let layer = |place: &usize| {
            let Group { files, numbers, .. } = groups[*place].take()?;
            FileLayer::of(files, numbers, cells[*place], several)
        };
        let all: Vec<_> = places.iter().filter_map(layer).collect();
        match first {
            Some(first) => Ok(Self { all, first, chosen }),
            None => Err(Error::input(Path::new("DEM"), "no file is named", "name at least one raster")),
        }
    }

    /// From the bottom to the top.
    pub(super) fn all(&self) -> &[FileLayer] {
        &self.all
    }

    /// The one with the first file.
    pub(super) fn first(&self) -> &FileLayer {
        &self.all[self.first]
    }

    /// The one whose grid was asked for.
    pub(super) fn chosen(&self) -> Option<&FileLayer> {
        Some(&self.all[self.chosen?])
    }

    /// What it was opened from, in a few words.
    pub(super) fn label(&self) -> String {
        and_more(&shown(self.first().path()), self.all.iter().map(|layer| layer.numbers().len()).sum())
    }

    /// The crop in the units of `grid`: the smallest rectangle around it where these are not those of the first file.
    pub(super) fn crop_on(&self, grid: &GeoGrid, crop: Option<[f64; 4]>) -> Result<Option<[f64; 4]>> {
        let own = &self.first().grid;
        let Some(crop) = crop::on(own, crop)? else { return Ok(None) };
        if own.crs == grid.crs {
            return Ok(Some(crop));
        }
        crop::carried(crop, &own.crs, &grid.crs).map(Some).ok_or_else(|| {
            let remedy = "give a part of the globe that the map of the DEM shows";
            Error::setting(Setting::Crop, "its edges have no place on the map of the DEM", remedy)
        })
    }

    /// The samples of each layer that `grid` needs, `None` where they do not meet, with whether they fall on its own.
    pub(super) fn needed(&self, grid: &GeoGrid) -> Vec<Option<(Window, bool)>> {
        self.all.iter().map(|layer| needed(&layer.grid, grid)).collect()
    }

    /// What is to be read of each layer for `target`, from the bottom to the top; of those that do not meet it
    /// nothing. `keep_steps`: heights stay as the files have them.
    pub(super) fn into_parts(mut self, target: &Target, keep_steps: bool) -> Vec<Part> {
        if self.all.len() == 1 {
            return self.all.pop().map(|layer| Part::new(layer, target.window, keep_steps)).into_iter().collect();
        }
        let part = |layer: FileLayer| Some((needed(&layer.grid, &target.grid)?.0, layer));
        self.all.into_iter().filter_map(part).map(|(window, layer)| Part::new(layer, window, keep_steps)).collect()
    }
}

impl Group {
    /// Its files a second time, a turn farther, where they run round the globe and the crop, in the units of `crs`, crosses
    /// their outer edges.
    fn beside_itself(
        &mut self,
        crs: &Crs,
        crop: Option<[f64; 4]>,
        options: &ReadOptions,
        opening: &mut Opening,
    ) -> Result<()> {
        let own = |crop| if *crs == self.base.crs { Some(crop) } else { crop::carried(crop, crs, &self.base.crs) };
        let Some(columns) = crop::round_the_globe(&self.whole(), crop.and_then(own)) else { return Ok(()) };
        let count = self.files.len();
        for i in 0..count {
            let (placed, lie) = &self.files[i];
            let (beside, path, alone) = (lie.moved([-columns, 0]), placed.path().to_owned(), count == 1);
            let twin = Placed::open(&path, options, alone, Some(&self.base.crs), opening, &mut History::default())?;
            self.files.push((twin, beside));
        }
        Ok(())
    }

    /// The grid of all its files.
    fn whole(&self) -> GeoGrid {
        let bounds = self.files.iter().map(|(placed, lie)| lie.bounds(&placed.grid));
        let wider = |(low, end): ([i64; 2], [i64; 2]), (first, last): ([i64; 2], [i64; 2])| {
            ([0, 1].map(|i| low[i].min(first[i])), [0, 1].map(|i| end[i].max(last[i])))
        };
        let (low, end) = bounds.reduce(wider).unwrap_or_default();
        let to_crs = self.base.to_crs * DAffine2::from_translation(DVec2::new(low[0] as f64, low[1] as f64));
        let [columns, rows] = [0, 1].map(|i| (end[i] - low[i]) as usize);
        GeoGrid { to_crs, columns, rows, crs: self.base.crs.clone() }
    }
}

/// Puts file `number` into the group on whose samples its own fall, in the order given into the last one alone, else into
/// a new one.
fn sort_in(placed: Placed, number: usize, order: Order, groups: &mut Vec<Group>) {
    let from = if order == Order::Given { groups.len().saturating_sub(1) } else { 0 };
    let found = groups[from..].iter_mut().find_map(|group| match Lie::of(&placed.grid, &group.base) {
        Some(lie @ Lie::Aligned { .. }) => Some((group, lie)),
        _ => None,
    });
    if let Some((group, lie)) = found {
        group.files.push((placed, lie));
        group.numbers.push(number);
        return;
    }
    let base = placed.grid.north_up();
    let lie = Lie::of(&placed.grid, &base).unwrap_or(Lie::Aligned { first: [0; 2], flip: [false; 2] });
    groups.push(Group { base, files: vec![(placed, lie)], numbers: vec![number] });
}

/// The number of the file at `path` among those named.
fn number_of(path: &Path, paths: &[PathBuf]) -> Result<usize> {
    let whole = |path: &Path| path.canonicalize().ok();
    let same = |named: &PathBuf| named == path || (whole(named).is_some() && whole(named) == whole(path));
    paths.iter().position(same).ok_or_else(|| {
        let named: Vec<_> = paths.iter().take(NAMED).map(|path| shown(path)).collect();
        let more = if paths.len() > NAMED { " …" } else { "" };
        let what = format!("{} is none of the files of the DEM", shown(path));
        Error::setting(Setting::CellOf, what, format!("give one of them: {}{more}", named.join(", ")))
    })
}

/// Files that are named to choose from.
const NAMED: usize = 8;

/// Numbers of the `cells` from the largest to the smallest; of like ones that with the smaller number in `lasts` first.
fn finest_last(cells: &[f64], lasts: &[usize]) -> Vec<usize> {
    let mut places: Vec<_> = (0..cells.len()).collect();
    places.sort_by(|a, b| cells[*b].total_cmp(&cells[*a]));
    let as_fine = |a: &usize, b: &usize| cells[*a] <= cells[*b] * (1.0 + AS_FINE);
    places.chunk_by_mut(as_fine).for_each(|like| like.sort_by_key(|place| lasts[*place]));
    places
}

/// Side of a square as large as a cell in the middle of a grid, metres on the ground; on the map where the place on the
/// globe is unknown.
fn ground_cell(grid: &GeoGrid) -> f64 {
    let middle = grid.to_crs.inverse().transform_point2(grid.centre(grid.whole()));
    let steps = [DVec2::ZERO, DVec2::X, DVec2::Y].map(|step| grid.to_crs.transform_point2(middle + step));
    let side = |[at, along, down]: [DVec2; 3]| (along - at).perp_dot(down - at).abs().sqrt();
    let on_ground = || {
        let way = CrsPath::between(&grid.crs, &metric(&grid.crs, steps[0])?)?;
        let mut steps = steps;
        way.carry(&mut steps);
        Some(side(steps)).filter(|side| side.is_finite() && *side > 0.0)
    };
    on_ground().unwrap_or_else(|| side(steps) * grid.crs.metres_per_unit().unwrap_or(1.0))
}

/// The samples of `own` that `grid` needs, and whether they fall on its samples.
fn needed(own: &GeoGrid, grid: &GeoGrid) -> Option<(Window, bool)> {
    let Some(Lie::Aligned { first, flip: [false, false] }) = Lie::of(own, grid) else {
        return Some((reach(grid, own)?, false));
    };
    let [sizes, there] = [[own.columns, own.rows], [grid.columns, grid.rows]].map(|size| size.map(|n| n as i64));
    let low = [0, 1].map(|i| (-first[i]).clamp(0, sizes[i]));
    let end = [0, 1].map(|i| (there[i] - first[i]).clamp(0, sizes[i]));
    let size = [0, 1].map(|i| (end[i] - low[i]).max(0) as usize);
    let window = Window { first: low.map(|v| v as usize), size };
    (window.samples() > 0).then_some((window, true))
}

/// The error for two files, each with its grid, between whose systems no way is known: it is about the one that names
/// none, else about the first.
fn no_way([one, other]: [(&Path, &GeoGrid); 2]) -> Error {
    let nameless = |(_, grid): (&Path, &GeoGrid)| grid.crs.wkt().is_empty();
    let [(path, grid), (beside, base)] = if nameless(other) && !nameless(one) { [other, one] } else { [one, other] };
    let name = |crs: &Crs| match crs.label() {
        label if label.is_empty() => "no named coordinate system".to_owned(),
        label if ["unknown", "unnamed"].contains(&label.to_lowercase().as_str()) => "an unnamed system".to_owned(),
        label => label,
    };
    let what = format!(
        "lies in {}, and no way from there to {}, that of {}, is known",
        name(&grid.crs),
        name(&base.crs),
        shown(beside)
    );
    let code = base.crs.epsg().map_or("CODE".to_owned(), |code| code.to_string());
    let remedy = match grid.crs.wkt().is_empty() {
        true => {
            format!("draw it alone, or where it is in that too, say so: `gdal_translate -a_srs EPSG:{code} IN OUT.tif`")
        }
        false => "draw each alone".to_owned(),
    };
    Error::input(path, what, remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_finest_is_last_and_like_ones_stand_as_given() {
        assert_eq!(finest_last(&[10.0, 90.0, 30.0], &[0, 1, 2]), [1, 2, 0]);
        assert_eq!(finest_last(&[30.0, 30.1, 29.9, 90.0], &[3, 1, 2, 0]), [3, 1, 2, 0]);
        assert_eq!(finest_last(&[29.9, 30.1], &[1, 0]), [1, 0]);
    }
}
