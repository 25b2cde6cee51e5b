//! Signature help: the parameters of the call that is being typed.

use lsp_types::{Documentation, ParameterInformation, ParameterLabel, Position, SignatureHelp, SignatureInformation};

use super::view::View;
use crate::shader::glsl::{TokenKind, built_in, code, is_name};
use crate::shader::symbols::{SymbolKind, comment_of};

/// The functions that the call around a place can mean.
pub fn signature_help(view: &View, place: Position) -> Option<SignatureHelp> {
    let file = view.file();
    if file.is_too_long() {
        return None;
    }
    let byte = file.source.byte(place);
    let tokens = code(file.text());
    let behind = tokens.partition_point(|token| token.bytes.end <= byte);
    let (mut depth, mut commas, mut at) = (0_usize, 0_u32, behind);
    let name = loop {
        at = at.checked_sub(1)?;
        match tokens[at].text {
            ")" | "]" => depth += 1,
            "(" if depth == 0 => break at.checked_sub(1)?,
            "(" | "[" => depth = depth.saturating_sub(1),
            "," if depth == 0 => commas += 1,
            ";" | "{" | "}" => return None,
            _ => {}
        }
    };
    let name = tokens.get(name).filter(|token| token.kind == TokenKind::Word && is_name(token.text))?;
    let meant = view.plain(&view.current, name.text, &name.bytes);
    let functions = meant.iter().filter(|found| found.symbol.kind == SymbolKind::Function);
    let mut signatures: Vec<SignatureInformation> = functions
        .map(|found| {
            let text = found.file.text();
            let of = |bytes: &std::ops::Range<usize>| text.get(bytes.clone()).unwrap_or_default().to_owned();
            let parameters = found.symbol.parameters.iter().map(of).collect();
            signature(of(&found.symbol.signature), parameters, comment_of(text, found.symbol))
        })
        .collect();
    if signatures.is_empty() {
        let known = built_in(name.text).filter(|known| known.is_function())?;
        signatures = known
            .forms
            .iter()
            .map(|form| signature((*form).to_owned(), parameters(form), Some(known.doc.to_owned())))
            .collect();
    }
    signatures.dedup_by(|a, b| a.label == b.label);
    let takes = |of: &SignatureInformation| of.parameters.as_ref().is_some_and(|all| all.len() > commas as usize);
    let active = signatures.iter().position(takes).unwrap_or(0);
    Some(SignatureHelp { active_signature: u32::try_from(active).ok(), active_parameter: Some(commas), signatures })
}

/// The parameters of a form of a built-in function.
fn parameters(form: &str) -> Vec<String> {
    let inside = form.split_once('(').map_or("", |(_, rest)| rest.trim_end_matches(')'));
    inside.split(", ").filter(|parameter| !parameter.is_empty()).map(str::to_owned).collect()
}

fn signature(label: String, parameters: Vec<String>, comment: Option<String>) -> SignatureInformation {
    let parameter = |text: String| ParameterInformation { label: ParameterLabel::Simple(text), documentation: None };
    SignatureInformation {
        label,
        documentation: comment.map(Documentation::String),
        parameters: Some(parameters.into_iter().map(parameter).collect()),
        active_parameter: None,
    }
}
