//! Options of `specula render`.

use std::path::PathBuf;

use specula::capture::{Page, Sweep, Turn};

use crate::commands::Failure;
use crate::commands::common::frames::Frames;
use crate::commands::common::parse::size;
use crate::commands::common::{Common, Models};

/// Options of `render`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    pub(super) models: Models,
    /// File to write, .png, .exr (raw values) or .npy (the same as a NumPy array); with --frames also .mp4, .webp or .gif, which hold all frames. With `--mode all` or a list, as `--mode final,d`: FILE.<mode>.png for each mode; `all` leaves out those of random paths
    #[arg(long, short, value_name = "FILE", default_value = "specula.png")]
    pub(super) out: PathBuf,
    /// With `--mode all`: include the modes of random paths, which take seconds each on a software device. Those that trace the model get one path per pixel
    #[arg(long)]
    pub(super) paths: bool,
    /// Write a contact sheet of modes with their names: modes (all that have data in the model and take one frame), all (all but those of random paths), paths (those), or names such as d,f,v
    #[arg(long, value_name = "MODES", conflicts_with = "turntable")]
    pub(super) sheet: Option<String>,
    /// Write a sheet of the values of a setting or parameter: PATH=a,b (lists in lists with ;), PATH=0..1 or PATH=0..1/9 (9 values), or PATH for all. Repeated: rows and columns; with --sheet, each mode in a row
    #[arg(long, value_name = "PATH=VALUES", conflicts_with = "turntable", value_parser = Sweep::parse)]
    pub(super) sweep: Vec<Sweep>,
    /// Page of a sheet [default: dark]
    #[arg(long, value_enum, ignore_case = true, value_name = "NAME")]
    pub(super) page: Option<Page>,
    /// Write a page of HTML with the pictures of a sheet, too: to enlarge, and to compare two of them
    #[arg(long, value_name = "FILE.html", conflicts_with = "turntable")]
    pub(super) report: Option<PathBuf>,
    /// Size of each picture on a sheet in pixels, in place of --size [default: 320x180]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = size)]
    pub(super) tile: Option<(u32, u32)>,
    /// Write a full turn of N frames: a video (.mp4), an animation (.webp, .gif) or numbered .png files. 25 frames per second without --fps
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(super) turntable: Option<u32>,
    /// Whether a turntable turns the camera, the light or the model [default: camera]
    #[arg(long, value_enum, ignore_case = true, value_name = "NAME", requires = "turntable")]
    pub(super) turn: Option<Turn>,
    /// Draw each model by itself, a folder as the models in it. The files are named by --out with {name}, which is '{name}.png' without it
    #[arg(long, conflicts_with = "watch")]
    pub(super) each: bool,
    /// Keep running, and render again whenever a shader or the model is saved
    #[arg(long)]
    pub(super) watch: bool,
    #[command(flatten)]
    pub(super) frames: Frames,
    #[command(flatten)]
    pub(super) common: Common,
}

impl Args {
    /// Whether a sheet is requested.
    pub(super) fn is_sheet(&self) -> bool {
        self.sheet.is_some() || !self.sweep.is_empty()
    }

    /// Fails for an option that would change nothing.
    pub(super) fn check(&self) -> Result<(), Failure> {
        let of_sheets = [
            ("--report shows the pictures of --sheet or --sweep; `specula diff` has one, too", self.report.is_some()),
            (
                "--tile is the size of a picture of --sheet or --sweep; --size is that of a single one",
                self.tile.is_some(),
            ),
            ("--page is for the page of --sheet or --sweep", self.page.is_some()),
        ];
        let misplaced = of_sheets.iter().find(|(_, is_given)| *is_given && !self.is_sheet());
        let sized = ("--size is not for --sheet and --sweep; --tile is the size of each picture there", true);
        let sized = (self.is_sheet() && self.common.size.is_some()).then_some(&sized);
        misplaced.or(sized).map_or(Ok(()), |(message, _)| Err(Failure::Usage((*message).to_owned())))
    }
}
