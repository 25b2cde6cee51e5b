//! Names in the code that lead to their definitions while Ctrl is held.

use egui::{CursorIcon, Modifiers, Rect, Sense, Stroke, Ui};

use super::look::Look;
use super::model::CodeLine;
use crate::app::command::source::{SHOW_LINE, SourcePlace};
use crate::app::commands::Commands;
use crate::app::state::State;
use crate::app::widgets::spoken;
use crate::app::widgets::theme::ACCENT;
use crate::shader::glsl::{TokenKind, tokens};
use crate::shader::symbols::{Symbol, SymbolKind, Symbols};
use crate::shader::{ShaderSet, TreePath};

/// Makes the names of a line links. `left`: where its code begins.
pub(super) fn links(
    ui: &mut Ui,
    (state, path): (&State, &TreePath),
    line: &CodeLine,
    (left, rect, look): (f32, Rect, &Look),
    commands: &mut Commands,
) {
    let is_held = ui.input(|input| input.modifiers.matches_logically(Modifiers::COMMAND));
    let is_here = ui.input(|input| input.pointer.hover_pos()).is_some_and(|at| rect.y_range().contains(at.y));
    if !is_held || !is_here {
        return;
    }
    let Some(shaders) = &state.session.shaders else { return };
    for name in tokens(&line.text).filter(|token| token.kind == TokenKind::Word) {
        let x = |byte: usize| left + look.letter * line.text[..byte].chars().count() as f32;
        let area = Rect::from_x_y_ranges(x(name.bytes.start)..=x(name.bytes.end), rect.y_range());
        let response = ui.interact(area, ui.id().with(("name", line.row.line, name.bytes.start)), Sense::click());
        spoken::button(&response, &format!("Go to {}", name.text));
        if response.hovered() {
            ui.painter().hline(area.x_range(), area.bottom() - 2.0, Stroke::new(1.0, ACCENT));
        }
        if response.clicked()
            && let Some((file, line)) = definition(shaders, (path, line.row.line), name.text)
        {
            commands.push(SHOW_LINE.with(SourcePlace { file, line }));
        }
        response.on_hover_cursor(CursorIcon::PointingHand);
    }
}

/// The file and the line, from 1, in which a name is declared that stands in a line.
fn definition(shaders: &ShaderSet, place: (&TreePath, u32), name: &str) -> Option<(TreePath, u32)> {
    let (file, symbol) = symbol_of(shaders, place, name)?;
    let line = shaders.texts.get(&file)?.get(..symbol.bytes.start)?.matches('\n').count() as u32 + 1;
    Some((file, line))
}

/// The declaration of a name that stands in a line, and its file: a local one of its function, one of its file, or one of another file.
/// `None` for what GLSL has built in.
pub(super) fn symbol_of(shaders: &ShaderSet, (path, line): (&TreePath, u32), name: &str) -> Option<(TreePath, Symbol)> {
    let text = shaders.texts.get(path)?;
    let here: usize = text.split_inclusive('\n').take(line as usize - 1).map(str::len).sum();
    let end = here + text[here..].find('\n').unwrap_or(text.len() - here);
    let own = Symbols::of(text);
    // The last declaration before the end of the line, whose scope has the line.
    let is_local = |symbol: &&Symbol| {
        symbol.name == name && symbol.scope.as_ref().is_some_and(|scope| scope.contains(&here) || scope.contains(&end))
    };
    if let Some(local) = own.all.iter().filter(is_local).rfind(|symbol| symbol.bytes.start < end) {
        return Some((path.clone(), local.clone()));
    }
    let of_file = |symbols: &Symbols| {
        let mut found: Vec<&Symbol> =
            symbols.all.iter().filter(|symbol| symbol.is_global() && symbol.name == name).collect();
        // A declaration without its body comes last.
        found.sort_by_key(|symbol| symbol.kind == SymbolKind::Function && !symbol.has_body);
        found.first().map(|symbol| (*symbol).clone())
    };
    of_file(&own).map(|symbol| (path.clone(), symbol)).or_else(|| {
        let others = shaders.texts.iter().filter(|(other, text)| *other != path && text.contains(name));
        others.into_iter().find_map(|(other, text)| Some((other.clone(), of_file(&Symbols::of(text))?)))
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use super::*;

    #[test]
    fn names_lead_to_where_they_are_declared() {
        let a = "float g(float x);\nfloat f(float x) {\n    float y = g(x) * PI;\n    return y;\n}\n";
        let b = "const float PI = 3.14;\nfloat g(float x) {\n    float y = x;\n    return y;\n}\n";
        let files = [("a.glsl", a), ("b.glsl", b)].map(|(path, text)| (TreePath::from(path), Arc::<str>::from(text)));
        let shaders = ShaderSet { texts: BTreeMap::from(files), ..ShaderSet::default() };
        let of = |file: &str, line: u32, name: &str| {
            definition(&shaders, (&file.into(), line), name).map(|(file, line)| (file.to_string(), line))
        };
        assert_eq!(of("a.glsl", 4, "y"), Some(("a.glsl".to_owned(), 3)));
        assert_eq!(of("a.glsl", 3, "x"), Some(("a.glsl".to_owned(), 2)), "the parameter of its own function");
        assert_eq!(of("a.glsl", 3, "PI"), Some(("b.glsl".to_owned(), 1)));
        assert_eq!(of("b.glsl", 4, "y"), Some(("b.glsl".to_owned(), 3)));
        assert_eq!(of("a.glsl", 3, "f"), Some(("a.glsl".to_owned(), 2)));
        assert_eq!(of("a.glsl", 3, "float"), None);
    }
}
