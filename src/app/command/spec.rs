//! The form of a command: an entry of the registry, and that entry with its arguments.

use std::fmt::Debug;
use std::rc::Rc;

use serde::de::DeserializeOwned;

use super::about::{About, Group};
use super::fields::{self, Fields};
use super::shortcut::Shortcut;
use crate::app::engine::Engine;
use crate::app::state::{State, waiting};

/// When a command is done, and its result.
pub(in crate::app) type Until = waiting::Until<State>;

/// The same, or a message that says why it was refused.
pub(in crate::app) type Outcome = Result<Until, String>;

enum Run<A> {
    /// Done at once, and cannot fail.
    Act(fn(&mut State, &mut Engine, A)),
    Try(fn(&mut State, &mut Engine, A) -> Outcome),
}

type Parse<A> = fn(&About, Fields) -> Result<A, String>;

/// A command with arguments of the type `A`: all that keys, palette, lists, socket, stdin and panels know of it.
pub(in crate::app) struct Spec<A: 'static> {
    about: About,
    /// The arguments for the shortcut at an index; the palette uses those for the first.
    arguments: Option<fn(usize) -> A>,
    parse: Option<Parse<A>>,
    run: Run<A>,
}

impl<A: Clone + Debug> Spec<A> {
    /// A command that may fail, or that is done later.
    pub(super) const fn new(id: &'static str, run: fn(&mut State, &mut Engine, A) -> Outcome) -> Self {
        Self::of(id, Run::Try(run))
    }

    /// A command that is done at once and cannot fail.
    pub(super) const fn act(id: &'static str, run: fn(&mut State, &mut Engine, A)) -> Self {
        Self::of(id, Run::Act(run))
    }

    const fn of(id: &'static str, run: Run<A>) -> Self {
        let about = About {
            id,
            label: "",
            words: "",
            shortcuts: &[],
            keys: "",
            group: Group::Picture,
            keys_doc: "",
            repeats: false,
            takes: None,
            required: &[],
            doc: "",
            needs_window: false,
            is_enabled: |_| true,
        };
        Self { about, arguments: None, parse: None, run }
    }

    /// Lists the command in the palette.
    pub(super) const fn label(mut self, label: &'static str, words: &'static str) -> Self {
        (self.about.label, self.about.words) = (label, words);
        self
    }

    /// Binds keys.
    pub(super) const fn shortcuts(mut self, group: Group, shortcuts: &'static [Shortcut], doc: &'static str) -> Self {
        (self.about.group, self.about.shortcuts, self.about.keys_doc) = (group, shortcuts, doc);
        self
    }

    /// Names the shortcuts in lists of keys.
    pub(super) const fn keys(mut self, keys: &'static str) -> Self {
        self.about.keys = keys;
        self
    }

    /// A session without a window refuses the command.
    pub(super) const fn of_window(mut self) -> Self {
        self.about.needs_window = true;
        self
    }

    pub(super) const fn repeats(mut self) -> Self {
        self.about.repeats = true;
        self
    }

    pub(super) const fn enabled(mut self, is_enabled: fn(&State) -> bool) -> Self {
        self.about.is_enabled = is_enabled;
        self
    }

    /// The arguments for the shortcut at an index.
    pub(super) const fn arguments(mut self, arguments: fn(usize) -> A) -> Self {
        self.arguments = Some(arguments);
        self
    }

    /// Takes a line whose fields `parse` reads.
    pub(super) const fn parsed(mut self, takes: &'static str, doc: &'static str, parse: Parse<A>) -> Self {
        (self.about.takes, self.about.doc, self.parse) = (Some(takes), doc, Some(parse));
        self
    }

    /// Fields that a line must have.
    pub(super) const fn required(mut self, required: &'static [&'static str]) -> Self {
        self.about.required = required;
        self
    }

    /// Takes a line whose fields are those of `A`.
    pub(super) const fn takes(self, takes: &'static str, doc: &'static str) -> Self
    where
        A: DeserializeOwned,
    {
        self.parsed(takes, doc, fields::typed::<A>)
    }

    /// The command with these arguments.
    pub(in crate::app) fn with(&'static self, arguments: A) -> Command {
        let text = format!("{} {arguments:?}", self.about.id);
        let run = move |state: &mut State, engine: &mut Engine| match self.run {
            Run::Act(run) => {
                run(state, engine, arguments.clone());
                Ok(Until::DONE)
            }
            Run::Try(run) => run(state, engine, arguments.clone()),
        };
        Command { about: &self.about, text, run: Rc::new(run) }
    }
}

impl Spec<()> {
    /// A command without arguments.
    pub(super) const fn plain(id: &'static str, run: fn(&mut State, &mut Engine, ())) -> Self {
        Self::act(id, run).arguments(|_| ())
    }

    /// A command without arguments that may fail, or that is done later.
    pub(super) const fn fallible(id: &'static str, run: fn(&mut State, &mut Engine, ()) -> Outcome) -> Self {
        Self::new(id, run).arguments(|_| ())
    }

    /// Takes a line without fields.
    pub(super) const fn line(self, doc: &'static str) -> Self {
        self.parsed("", doc, fields::none)
    }
}

/// A command of any type.
pub(in crate::app) trait Registered: Sync {
    fn about(&self) -> &About;

    fn is_enabled(&self, state: &State) -> bool {
        (self.about().is_enabled)(state)
    }

    /// The command with the arguments of its shortcut at an index.
    fn at(&'static self, shortcut: usize) -> Option<Command>;
    /// The command with the fields of a line; `None` if no line can name it.
    fn parse(&'static self, fields: Fields) -> Option<Result<Command, String>>;
}

impl<A: Clone + Debug> Registered for Spec<A> {
    fn about(&self) -> &About {
        &self.about
    }

    fn at(&'static self, shortcut: usize) -> Option<Command> {
        self.arguments.map(|arguments| self.with(arguments(shortcut)))
    }

    fn parse(&'static self, fields: Fields) -> Option<Result<Command, String>> {
        self.parse.map(|parse| parse(&self.about, fields).map(|arguments| self.with(arguments)))
    }
}

/// Carries out a command.
type Action = dyn Fn(&mut State, &mut Engine) -> Outcome;

/// A command with its arguments.
#[derive(Clone)]
pub(in crate::app) struct Command {
    pub(in crate::app) about: &'static About,
    /// Its name and its arguments, for tests and messages of the developer.
    text: String,
    run: Rc<Action>,
}

impl Command {
    /// Begins the command.
    pub(super) fn run(&self, state: &mut State, engine: &mut Engine) -> Outcome {
        (self.run)(state, engine)
    }

    /// Whether this is a command of an entry.
    pub(in crate::app) fn is_a(&self, entry: &dyn Registered) -> bool {
        self.about.id == entry.about().id
    }
}

impl PartialEq for Command {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Debug for Command {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}
