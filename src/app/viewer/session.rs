//! Goes on with the last session of the working directory, and remembers this one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Viewer;
use crate::app::command::Command;
use crate::app::state::last_session;
use crate::picture::Look;
use crate::recovery::SessionState;
use crate::scene::BUILT_IN;

impl Viewer {
    /// The settings, the model and the shader tree.
    pub(in crate::app) fn session_state(&self) -> SessionState {
        let model = if self.model.loading { &self.model.requested } else { &self.model.path };
        let tree = self.source.location().map(Path::to_owned);
        SessionState { settings: self.session.shared_settings(), model: model.clone(), tree }
    }

    /// Goes on with the last session, as it was left.
    pub(super) fn restore_session(&mut self) {
        let Some(last) = self.last_sessions.here.clone() else {
            return self.say("There is no session to restore");
        };
        self.go_to(last.work);
        self.offers_session = false;
    }

    /// Shows the look of a file: its settings, and the model and the shaders that it names. Returns the model that has to be loaded.
    pub(super) fn show_look(&mut self, look: Look) -> Option<PathBuf> {
        let now = self.session_state();
        let model = match &look.model {
            Some(model) => (model != Path::new(BUILT_IN[0])).then(|| model.clone()),
            None => now.model.clone(),
        };
        let loads = is_other(model.as_deref(), now.model.as_deref());
        let tree = look.shaders.or(now.tree);
        self.go_to(SessionState { settings: Arc::new(look.settings), model: model.clone(), tree });
        loads.then(|| model.unwrap_or_else(|| BUILT_IN[0].into()))
    }

    /// Shows other work. The camera is that of the work, and not one that frames the model.
    fn go_to(&mut self, SessionState { settings, model, tree }: SessionState) {
        let now = self.session_state();
        if let Some(tree) = tree.filter(|tree| is_other(Some(tree), now.tree.as_deref())) {
            self.execute(Command::OpenTree(full_path(&tree)));
        }
        self.session.settings = Arc::unwrap_or_clone(settings);
        if is_other(model.as_deref(), now.model.as_deref()) {
            self.model.keeps_camera = true;
            self.load_model(model);
        }
    }

    /// Whether to offer the last session: until the user does anything that is worth keeping.
    pub(in crate::app) fn offers_session(&mut self) -> bool {
        self.offers_session &= self.last_sessions.here.is_some() && !self.has_work();
        self.offers_session
    }

    /// Whether the session differs from that of a plain start.
    fn has_work(&self) -> bool {
        self.plain.as_ref().is_none_or(|plain| !self.session_state().is_alike(plain))
    }

    /// Remembers the session, if there is anything to go on with.
    pub(in crate::app) fn remember_session(&self) {
        if self.has_work() {
            last_session::remember(&self.session_state());
        }
    }
}

/// A path in full, through symbolic links; the name of something built in as it is.
fn full_path(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

fn is_other(a: Option<&Path>, b: Option<&Path>) -> bool {
    a.map(full_path) != b.map(full_path)
}
