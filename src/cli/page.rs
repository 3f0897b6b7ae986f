//! Flags of the page: the sheet of paper, and how many pixels lie on it.

use glam::DVec2;

use super::values::{self, Size};
use crate::error::{Error, Result, Setting};
use crate::ink::{Furniture, Sheet, Style, Surround, png};
use crate::message;
use crate::plan::pieces::LARGEST_PAGE;

/// Blank on all sides of a page unless told otherwise, mm.
pub const MARGIN: f64 = 10.0;
/// Pixels of a picture for each inch of a page unless told otherwise.
pub const DPI: f64 = 300.0;
const MM_PER_INCH: f64 = 25.4;
/// Least side of what margins leave, mm.
const LEAST_AREA: f64 = 1.0;

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Page")]
pub struct PageArguments {
    #[arg(
        long, value_name = "NAME|WxH", value_parser = values::page,
        help = format!(
            "Sheet of paper: {}, or millimetres across and down; the frame fills it less its margins and furniture, at {} pixels a millimetre \
             unless --size says [default: {} mm across, as --size is shaped]",
            values::paper_names(), Sheet::FRAME_PX_PER_MM, Sheet::WIDTH
        )
    )]
    page: Option<DVec2>,
    /// The page's longer side lies across
    #[arg(long, requires = "page")]
    landscape: bool,
    #[arg(
        long, value_name = "MM", value_parser = values::margin, allow_hyphen_values = true,
        help = format!("Blank on all sides of the page, in millimetres [default: {MARGIN}]")
    )]
    margin: Option<f64>,
    #[arg(
        long, value_name = "N", value_parser = values::dpi,
        help = format!("Pixels of a .png for each inch of the page; vectors are the same bytes at any [default: {DPI} with --page, else as --size has it]")
    )]
    dpi: Option<f64>,
}

/// A sheet, the pixels of its frame, and those of pictures.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// The sheet of paper.
    pub sheet: Sheet,
    /// Pixels that lines are found in, across and down.
    pub frame: Size,
    /// Pixels of pictures for each millimetre.
    pub px_per_mm: f64,
}

impl PageArguments {
    /// The flags that repeat it, with a space before each; none without a page.
    pub fn flags(&self) -> String {
        self.sheet().map_or_else(String::new, |sheet| {
            format!(" --page {}x{} --margin {}", sheet.size.x, sheet.size.y, sheet.margin)
        })
    }

    /// The sheet that is asked for.
    fn sheet(&self) -> Option<Sheet> {
        let page = self.page?;
        let page = if self.landscape { DVec2::new(page.max_element(), page.min_element()) } else { page };
        Some(Sheet { size: page, margin: self.margin.unwrap_or(MARGIN), surround: Surround::NONE })
    }

    /// Blank on all sides, mm.
    pub fn margin(&self) -> Option<f64> {
        self.margin
    }

    /// Pixels of a picture for each millimetre of a page in millimetres.
    pub fn px_per_mm(&self) -> f64 {
        self.dpi.unwrap_or(DPI) / MM_PER_INCH
    }

    /// The sheet with a frame of this size, or `otherwise` where it has to do without a page, and with room for furniture in a style.
    ///
    /// # Errors
    /// [`Error::Setting`] where they do not go together, or are too large or too small; as [`Furniture::within`].
    pub fn layout(&self, size: Option<Size>, otherwise: Size, furniture: &Furniture, style: &Style) -> Result<Layout> {
        let Some(sheet) = self.sheet() else {
            if self.margin.is_some() {
                let remedy = message!["add ", Setting::Page.with_value(), " or leave it out"];
                return Err(Error::setting(Setting::Margin, "goes with a page of millimetres only", remedy));
            }
            let frame = size.unwrap_or(otherwise);
            let bare = Sheet::for_frame([frame.width, frame.height]);
            let sheet = match furniture.is_none() {
                true => bare,
                false => bare.surrounded(MARGIN, furniture.around(bare.inner(), style)?),
            };
            let own = f64::from(frame.width) / Sheet::WIDTH;
            return Ok(Layout { sheet, frame, px_per_mm: self.dpi.map_or(own, |dpi| dpi / MM_PER_INCH) });
        };
        let page = sheet.size;
        if (page - 2.0 * sheet.margin).min_element() < LEAST_AREA {
            let what = format!("margins of {} mm leave nothing of a page of {} x {} mm", sheet.margin, page.x, page.y);
            return Err(Error::setting(Setting::Margin, what, message!["use a smaller ", Setting::Margin]));
        }
        let sheet = Sheet { surround: furniture.within(page - 2.0 * sheet.margin, style)?, ..sheet };
        if sheet.inner().min_element() < LEAST_AREA {
            let what = format!("furniture leaves nothing of a page of {} x {} mm", page.x, page.y);
            return Err(Error::setting(Setting::Page, what, "use a larger one, or leave out some of it"));
        }
        let frame = match size {
            Some(Size { width, height }) => sheet.check_frame([width, height]).map(|()| [width, height])?,
            None => sheet.frame(Sheet::FRAME_PX_PER_MM),
        };
        Ok(Layout { sheet, frame: Size { width: frame[0], height: frame[1] }, px_per_mm: self.px_per_mm() })
    }
}

impl Layout {
    /// Whether pictures of the sheet can be made.
    ///
    /// # Errors
    /// [`Error::Setting`] where they would be too large, or have no pixel.
    pub fn check_picture(&self) -> Result<()> {
        let [width, height] = png::size(&self.sheet, self.px_per_mm);
        if (1..=LARGEST_PAGE).contains(&width) && (1..=LARGEST_PAGE).contains(&height) {
            return Ok(());
        }
        let what = format!("makes a picture of {width}x{height} pixels; want 1 to {LARGEST_PAGE} a side");
        Err(Error::setting(Setting::Dpi, what, message!["use another ", Setting::Dpi, ", or a .svg or .pdf"]))
    }
}
