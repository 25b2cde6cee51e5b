//! A line of the shaders, with the variables and the numbers that it offers.

use std::sync::Arc;

use crate::settings::{ExpressionSettings, Settings};
use crate::shader::expression::{MODE, Variable, members, place_of, variables};
use crate::shader::rewrite::{Edit, Literal, literals, spelled_like};
use crate::shader::{ShaderSet, TreePath};

/// A line of the shaders.
pub(super) struct SourceLine {
    pub(super) path: TreePath,
    /// From 1.
    pub(super) line: u32,
    /// The file.
    pub(super) text: Arc<str>,
    /// The variables that the line can use, if an expression of the file can be watched.
    pub(super) variables: Option<Vec<Variable>>,
    /// The line before any of its numbers was dragged.
    pub(super) before: String,
    /// The numbers, and the values that replace them.
    pub(super) numbers: Vec<(Literal, f64)>,
}

impl SourceLine {
    /// A line of a file of these shaders; `None` if the file ends before it.
    pub(super) fn new(shaders: &ShaderSet, path: &TreePath, line: u32, text: &Arc<str>) -> Option<Self> {
        let before = text.lines().nth((line as usize).checked_sub(1)?)?.to_owned();
        let numbers = literals(text, line).into_iter().map(|literal| (literal.clone(), literal.value)).collect();
        let structs = || members(shaders.texts.values().map(|text| &**text));
        let variables = shaders.can_watch(path).then(|| variables(text, line, &structs()));
        Some(Self { path: path.clone(), line, text: text.clone(), variables, before, numbers })
    }

    /// The file and the line that a text such as `brdf/ndf.glsl:20` names. The file may be the end of a path.
    pub(super) fn place<'a>(shaders: &'a ShaderSet, text: &str) -> Option<(&'a TreePath, &'a Arc<str>, u32)> {
        let (file, line) = place_of(text)?;
        let (path, text) = Self::file(shaders, file)?;
        Some((path, text, line))
    }

    /// The file that a path, or the end of one, names.
    pub(super) fn file<'a>(shaders: &'a ShaderSet, file: &str) -> Option<(&'a TreePath, &'a Arc<str>)> {
        let ends = |path: &&TreePath| path.as_str().strip_suffix(file).is_some_and(|rest| rest.ends_with('/'));
        let exact = shaders.texts.get_key_value(&TreePath::from(file));
        exact.or_else(|| shaders.texts.iter().find(|(path, _)| ends(path)))
    }

    /// The edits that put the values in place of the numbers.
    pub(super) fn edits(&self) -> Vec<Edit> {
        let changed = self.numbers.iter().filter(|(literal, value)| *value != literal.value);
        changed
            .map(|(literal, value)| Edit {
                path: self.path.clone(),
                name: literal.text.clone(),
                line: self.line,
                bytes: literal.bytes.clone(),
                before: self.before.clone(),
                new: spelled_like(&literal.text, *value),
            })
            .collect()
    }
}

/// Shows the value of an expression: of the last evaluation, if it is another than before.
pub(super) fn watch(settings: &mut Settings, at: String) {
    if settings.expression.at != at {
        settings.expression = ExpressionSettings { at, ..ExpressionSettings::default() };
    }
    MODE.clone_into(&mut settings.mode);
}

/// Shows no expression any more.
pub(super) fn stop(settings: &mut Settings) {
    settings.expression = ExpressionSettings::default();
    if settings.mode == MODE {
        settings.mode = Settings::default().mode;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_expression_begins_with_its_last_evaluation() {
        let mut settings = Settings::default();
        watch(&mut settings, "a.glsl:1:x".to_owned());
        settings.expression.evaluation = 3;
        watch(&mut settings, "a.glsl:1:x".to_owned());
        assert_eq!(settings.expression.evaluation, 3, "the same expression");
        watch(&mut settings, "a.glsl:1:y".to_owned());
        assert_eq!((settings.expression.evaluation, settings.mode.as_str()), (0, MODE));
    }

    #[test]
    fn dragged_numbers_become_edits() {
        let text: Arc<str> = "float f(float x) {\n    return 0.5 * x + 2.0;\n}\n".into();
        let mut shown = SourceLine::new(&ShaderSet::default(), &"a.glsl".into(), 2, &text).unwrap();
        assert_eq!(shown.variables, None, "no stage includes the file");
        assert!(shown.edits().is_empty());
        shown.numbers[1].1 = 3.25;
        let edits = shown.edits();
        assert_eq!((edits[0].old(), edits[0].new.as_str(), edits.len()), ("2.0", "3.25", 1));
    }
}
