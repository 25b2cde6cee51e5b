//! The layers of the library: which folder of `src` may import which, and that no file imports, directly or around a corner, a file that
//! imports it.
//!
//! An import counts for the file that declares the item, through whatever module it is exported again. Unit tests may import anything.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree, Visibility};

/// The folders and files of `src`, from the lowest layer to the highest. Each imports only from layers before its own in this list; those
/// of one layer do not know each other.
const LAYERS: &[&[&str]] = &[
    &[
        "astc",
        "cancel",
        "cpu_clock",
        "identity",
        "interface",
        "message",
        "process_end",
        "regular_file",
        "report",
        "statistics",
    ],
    &["disk_cache", "distribution", "settings", "state_folder"],
    &["shader", "gpu", "scene"],
    &["frame", "picture_difference", "control", "file_kind", "recovery"],
    &["pipeline", "session"],
    &["render"],
    &["fuzz", "headless", "measure", "picture"],
    &["capture", "learn", "lsp", "mcp", "write_back"],
    &["events", "threads"],
    &["app"],
];

/// A path of modules from the crate's root, and perhaps an item.
type Names = Vec<String>;

/// The module tree of the library and the names that its files use.
#[derive(Default)]
struct Modules {
    /// The file of each module, relative to `src`. A module within a file has that file.
    files: BTreeMap<Names, PathBuf>,
    /// Names that a module has by a `use`, and what they stand for.
    aliases: BTreeMap<(Names, String), Names>,
    /// Modules of which a module has all names (`use a::*`).
    globs: BTreeMap<Names, Vec<Names>>,
    /// Items that a module declares itself.
    items: BTreeSet<(Names, String)>,
    /// Absolute paths that the code of a module names.
    used: BTreeMap<Names, BTreeSet<Names>>,
}

impl Modules {
    fn of_library() -> Self {
        Self::of("lib.rs")
    }

    /// The modules below the library's or the program's own file.
    fn of(root: &str) -> Self {
        let mut modules = Self::default();
        modules.read(Vec::new(), Path::new(root), Path::new(""));
        modules
    }

    /// Reads a module's file. The files of its own modules are in `folder`.
    fn read(&mut self, module: Names, file: &Path, folder: &Path) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(file);
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let items = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display())).items;
        self.add(&module, file, folder, &items);
    }

    fn add(&mut self, module: &Names, file: &Path, folder: &Path, items: &[Item]) {
        self.files.insert(module.clone(), file.to_owned());
        let items: Vec<&Item> = items.iter().filter(|item| !is_test(attributes(item))).collect();
        for item in &items {
            if let Some(name) = name(item) {
                self.items.insert((module.clone(), name));
            }
            match item {
                Item::Mod(found) => {
                    let name = found.ident.to_string();
                    let inner = [module.as_slice(), std::slice::from_ref(&name)].concat();
                    match &found.content {
                        Some((_, items)) => self.add(&inner, file, &folder.join(&name), items),
                        None => {
                            let flat = folder.join(format!("{name}.rs"));
                            let is_flat = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(&flat).exists();
                            let nested = folder.join(&name).join("mod.rs");
                            self.read(inner, if is_flat { &flat } else { &nested }, &folder.join(&name));
                        }
                    }
                }
                Item::Use(found) => {
                    let is_import = matches!(found.vis, Visibility::Inherited);
                    self.import(module, &mut Vec::new(), &found.tree, is_import);
                }
                _ => {}
            }
        }
        let mut paths = Paths::default();
        items
            .iter()
            .filter(|item| !matches!(item, Item::Mod(_) | Item::Use(_)))
            .for_each(|item| paths.visit_item(item));
        self.used.entry(module.clone()).or_default().extend(paths.found);
    }

    fn import(&mut self, module: &Names, before: &mut Names, tree: &UseTree, is_import: bool) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.import(module, before, &path.tree, is_import);
                before.pop();
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.import(module, before, tree, is_import)),
            UseTree::Glob(_) => self.globs.entry(module.clone()).or_default().push(before.clone()),
            UseTree::Name(_) | UseTree::Rename(_) => {
                let (name, alias) = match tree {
                    UseTree::Rename(rename) => (rename.ident.to_string(), rename.rename.to_string()),
                    UseTree::Name(name) => (name.ident.to_string(), name.ident.to_string()),
                    _ => return,
                };
                let mut path = before.clone();
                let alias = if name == "self" { before.last().cloned().unwrap_or_default() } else { alias };
                path.extend((name != "self").then_some(name));
                if is_import {
                    self.used.entry(module.clone()).or_default().insert(path.clone());
                }
                self.aliases.insert((module.clone(), alias), path);
            }
        }
    }

    /// The module that declares what `path` names in `module`; `None` if it is not of this crate, or a module itself.
    fn declares(&self, module: &Names, path: &[String], depth: usize) -> Option<Names> {
        let (first, rest) = path.split_first()?;
        if depth > 12 {
            return None;
        }
        match first.as_str() {
            "crate" => return self.within(&Vec::new(), rest, depth),
            "self" => return self.within(module, rest, depth),
            "super" => return self.declares_above(module, rest, depth),
            _ => {}
        }
        self.within(module, path, depth)
    }

    fn declares_above(&self, module: &Names, rest: &[String], depth: usize) -> Option<Names> {
        let above = module[..module.len().checked_sub(1)?].to_vec();
        match rest.split_first() {
            Some((first, rest)) if first == "super" => self.declares_above(&above, rest, depth),
            _ => self.within(&above, rest, depth),
        }
    }

    fn within(&self, module: &Names, path: &[String], depth: usize) -> Option<Names> {
        let (first, rest) = path.split_first()?;
        let inner = [module.as_slice(), std::slice::from_ref(first)].concat();
        if self.files.contains_key(&inner) {
            return self.within(&inner, rest, depth);
        }
        if self.items.contains(&(module.clone(), first.clone())) {
            return Some(module.clone());
        }
        if let Some(target) = self.aliases.get(&(module.clone(), first.clone())) {
            let path = [target.as_slice(), rest].concat();
            // `use a::a` names the crate `a`.
            return (target.first() != Some(first)).then(|| self.declares(module, &path, depth + 1)).flatten();
        }
        let globs = self.globs.get(module).into_iter().flatten();
        globs.map(|glob| [glob.as_slice(), path].concat()).find_map(|path| self.declares(module, &path, depth + 1))
    }

    /// For each file, the files that it imports from.
    fn imports(&self) -> BTreeMap<PathBuf, BTreeSet<PathBuf>> {
        let mut imports: BTreeMap<PathBuf, BTreeSet<PathBuf>> = BTreeMap::new();
        for (module, paths) in &self.used {
            let file = &self.files[module];
            let targets = paths.iter().filter_map(|path| self.declares(module, path, 0));
            let targets = targets.map(|module| self.files[&module].clone()).filter(|target| target != file);
            imports.entry(file.clone()).or_default().extend(targets);
        }
        imports
    }
}

/// Collects the paths of code with more than one segment.
#[derive(Default)]
struct Paths {
    found: BTreeSet<Names>,
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Names = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if names.len() > 1 {
            self.found.insert(names);
        }
        visit::visit_path(self, path);
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Mod(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Const(item) => &item.attrs,
        _ => &[],
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test"))
    })
}

fn name(item: &Item) -> Option<String> {
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        _ => return None,
    };
    Some(ident.to_string())
}

/// The groups of files that import each other in a circle, the largest first.
fn circles(imports: &BTreeMap<PathBuf, BTreeSet<PathBuf>>) -> Vec<BTreeSet<PathBuf>> {
    // The library has some hundred files, so all that each file reaches is cheap to list.
    let reach = |from: &PathBuf| {
        let mut seen: BTreeSet<PathBuf> = BTreeSet::new();
        let mut open = vec![from];
        while let Some(file) = open.pop() {
            open.extend(imports.get(file).into_iter().flatten().filter(|next| seen.insert((*next).clone())));
        }
        seen
    };
    let reached: BTreeMap<&PathBuf, BTreeSet<PathBuf>> = imports.keys().map(|file| (file, reach(file))).collect();
    let mut circles = BTreeSet::new();
    for (file, far) in &reached {
        let back = far.iter().filter(|other| reached.get(other).is_some_and(|back| back.contains(*file)));
        circles.insert(back.cloned().collect::<BTreeSet<PathBuf>>());
    }
    circles.remove(&BTreeSet::new());
    let mut circles: Vec<_> = circles.into_iter().collect();
    circles.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
    circles
}

/// The first component of a path, without the ending: a layer's name.
fn top(path: &Path) -> String {
    let first = path.components().next().unwrap().as_os_str().to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

#[test]
fn no_file_imports_a_file_that_imports_it() {
    let of = |root| circles(&Modules::of(root).imports());
    let circles = [of("lib.rs"), of("main.rs")].concat();
    let show = |circle: &BTreeSet<PathBuf>| {
        let names: Vec<String> = circle.iter().map(|path| path.display().to_string()).collect();
        format!("{} files: {}", names.len(), names.join(" "))
    };
    let shown: Vec<String> = circles.iter().map(show).collect();
    assert!(shown.is_empty(), "{} circles of imports:\n{}", shown.len(), shown.join("\n"));
}

#[test]
fn folders_import_only_from_layers_below() {
    let layer_of = |name: &str| LAYERS.iter().position(|layer| layer.contains(&name));
    let mut wrong = Vec::new();
    for (file, targets) in Modules::of_library().imports() {
        let from = top(&file);
        let Some(own) = layer_of(&from).or((from == "lib").then_some(LAYERS.len())) else {
            panic!("{from} is in no layer: put it into the list of {}", file!());
        };
        let others = targets.iter().filter(|target| top(target) != from);
        let above = others.filter(|target| layer_of(&top(target)).is_none_or(|layer| layer >= own));
        wrong.extend(above.map(|target| format!("{} imports {}", file.display(), target.display())));
    }
    assert!(wrong.is_empty(), "imports against the order of the layers:\n{}", wrong.join("\n"));
}

/// The files of the window that its screen imports: plain values of requests.
const REQUESTS: [&str; 5] =
    ["engine/last_complete.rs", "gallery.rs", "state/adaptive/plan.rs", "state/grid.rs", "state/workspace.rs"];

#[test]
fn the_screen_draws_requests_and_knows_neither_state_nor_engine() {
    let is_screen = |file: &Path| file.starts_with("app/screen") || file == Path::new("app/screen.rs");
    let imports = Modules::of_library().imports();
    let of_screen = imports.iter().filter(|(file, _)| is_screen(file));
    let others = of_screen.flat_map(|(file, targets)| targets.iter().map(move |target| (file, target)));
    let others = others.filter(|(_, target)| target.starts_with("app") && !is_screen(target));
    let is_request = |target: &Path| REQUESTS.iter().any(|known| target == Path::new("app").join(known));
    let wrong: Vec<String> = others
        .filter(|(_, target)| !is_request(target))
        .map(|(file, target)| format!("{} imports {}", file.display(), target.display()))
        .collect();
    assert!(imports.keys().any(|file| is_screen(file)) && wrong.is_empty(), "{}", wrong.join("\n"));
}
