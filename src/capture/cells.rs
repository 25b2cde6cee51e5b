//! The pictures of a sheet: a row or a column for each mode or value of a setting, and what is written below each.

use super::sweep::Sweep;
use crate::session::Session;
use crate::settings::Settings;
use crate::shader::Mode;

/// A picture of a sheet.
#[derive(Clone, Debug, Default)]
pub struct Cell {
    /// Its settings.
    pub settings: Settings,
    /// Its name, as `Roughness 0.25`.
    pub name: String,
    /// A shorter name for narrow pictures, without the names of settings, as `0.25`.
    pub short: String,
    /// Text after the name, in a quieter color.
    pub note: String,
}

impl Cell {
    fn add(&mut self, [name, short]: [&str; 2]) {
        let join = |text: &mut String, more: &str| match (text.is_empty(), more.is_empty()) {
            (_, true) => {}
            (true, false) => more.clone_into(text),
            (false, false) => *text += &format!(" · {more}"),
        };
        join(&mut self.name, name);
        join(&mut self.short, short);
    }
}

/// A picture of each mode.
pub fn cells_of_modes(settings: &Settings, modes: &[Mode]) -> Vec<Cell> {
    let cell = |mode: &Mode| {
        let mut settings = Settings { mode: mode.slug.clone(), ..settings.clone() };
        if mode.traces {
            // A path-traced frame takes seconds on a software device.
            settings.view.frames = 1;
        }
        let note = if mode.name.eq_ignore_ascii_case(&mode.slug) { String::new() } else { mode.slug.clone() };
        Cell { settings, name: mode.name.clone(), short: mode.slug.clone(), note }
    };
    modes.iter().map(cell).collect()
}

/// Every one of `cells` with each combination of values; the values of the last sweep stand in one row. Also returns how many those are.
///
/// # Errors
/// A setting that does not exist, or a value that it cannot have.
pub fn swept(mut cells: Vec<Cell>, sweeps: &[Sweep], session: &Session) -> Result<(Vec<Cell>, usize), String> {
    let mut columns = cells.len();
    for sweep in sweeps {
        let values = sweep.values(session)?;
        columns = values.len();
        let mut all = Vec::with_capacity(cells.len() * columns);
        for cell in &cells {
            for value in &values {
                let mut cell = cell.clone();
                sweep.apply(&mut cell.settings, value)?;
                let [name, short] = sweep.label(value, session);
                cell.add([&name, &short]);
                all.push(cell);
            }
        }
        cells = all;
    }
    Ok((cells, columns))
}
