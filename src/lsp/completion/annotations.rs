//! Annotations, their options and values, and directives.

use lsp_types::{CompletionItem, CompletionItemKind};

use super::names::documentation;
use crate::lsp::view::View;
use crate::shader::annotation::options::{ANNOTATIONS, Described, DescribedOption, described};
use crate::shader::symbols::{Symbol, SymbolKind};

/// The words that can stand at the end of an annotation that is typed so far.
pub fn items(view: &View, typed: &str) -> Vec<CompletionItem> {
    let rest = typed.trim_start_matches("//@");
    let Some((keyword, options)) = rest.split_once(char::is_whitespace) else {
        return ANNOTATIONS.iter().map(keyword_item).collect();
    };
    // Inside quotes is text.
    let Some(known) = described(keyword).filter(|_| options.matches('"').count() % 2 == 0) else { return Vec::new() };
    let word = options.rsplit(char::is_whitespace).next().unwrap_or_default();
    match word.split_once('=') {
        Some((name, _)) => values(view, known, name),
        None => {
            let is_new = |option: &&DescribedOption| !options.split_whitespace().any(|word| is_of(word, option));
            known.options.iter().filter(is_new).enumerate().map(option_item).collect()
        }
    }
}

/// Whether a word of an annotation is an option, with its value if it has one.
fn is_of(word: &str, option: &DescribedOption) -> bool {
    match option.name.strip_suffix('=') {
        Some(name) => word.split('=').next() == Some(name) && word.contains('='),
        None => word == option.name,
    }
}

fn keyword_item(known: &Described) -> CompletionItem {
    CompletionItem {
        label: known.keyword.to_owned(),
        kind: Some(CompletionItemKind::KEYWORD),
        detail: Some(format!("//@{} {}", known.keyword, known.example)),
        documentation: documentation(Some(known.doc.to_owned())),
        insert_text: Some(format!("{} {}", known.keyword, known.example)),
        ..CompletionItem::default()
    }
}

fn option_item((at, option): (usize, &DescribedOption)) -> CompletionItem {
    CompletionItem {
        label: option.name.to_owned(),
        kind: Some(CompletionItemKind::PROPERTY),
        detail: (!option.values.is_empty()).then(|| option.values.join(", ")),
        documentation: documentation(Some(option.doc.to_owned())),
        sort_text: Some(format!("{at:02}")),
        ..CompletionItem::default()
    }
}

/// The values of an option: those that it takes, or the names of the tree.
fn values(view: &View, known: &Described, name: &str) -> Vec<CompletionItem> {
    let value = |label: &str, kind: CompletionItemKind| CompletionItem {
        label: label.to_owned(),
        kind: Some(kind),
        ..CompletionItem::default()
    };
    let of_tree = |is_it: &dyn Fn(&Symbol) -> bool| {
        let symbols = view.files.values().flat_map(|file| file.symbols.all.iter().map(move |symbol| (file, symbol)));
        let mut names: Vec<&str> =
            symbols.filter(|(_, symbol)| is_it(symbol)).map(|(_, symbol)| symbol.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names.into_iter().map(|name| value(name, CompletionItemKind::REFERENCE)).collect()
    };
    match name {
        "when" => {
            let declared = view.files.values().flat_map(|file| {
                let is_shown = |symbol: &&Symbol| {
                    let signature = file.text().get(symbol.signature.clone()).unwrap_or_default();
                    symbol.kind == SymbolKind::Constant && signature.contains("constant_id")
                };
                file.symbols.globals().filter(is_shown).map(|symbol| symbol.name.clone()).collect::<Vec<_>>()
            });
            let mut names: Vec<String> = declared.collect();
            names.sort();
            names.dedup();
            names.iter().map(|name| value(name, CompletionItemKind::REFERENCE)).collect()
        }
        "after" | "instead" => of_tree(&|symbol| symbol.kind == SymbolKind::Pass),
        name => {
            let option = known.options.iter().find(|option| option.name.strip_suffix('=') == Some(name));
            let values = option.map(|option| option.values).unwrap_or_default();
            values.iter().map(|text| value(text, CompletionItemKind::VALUE)).collect()
        }
    }
}

/// Directives, behind their `#`.
pub fn directives() -> Vec<CompletionItem> {
    let all = [
        "include",
        "define",
        "undef",
        "ifdef",
        "ifndef",
        "if",
        "elif",
        "else",
        "endif",
        "version",
        "extension",
        "pragma",
    ];
    let item = |word: &str| CompletionItem {
        label: word.to_owned(),
        kind: Some(CompletionItemKind::KEYWORD),
        ..CompletionItem::default()
    };
    all.into_iter().map(item).collect()
}
