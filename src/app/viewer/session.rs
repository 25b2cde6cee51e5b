//! Goes on with the last session of the working directory, and remembers this one.

use std::path::Path;

use super::Viewer;
use crate::app::command::Command;
use crate::app::last_session;
use crate::recovery::Work;

impl Viewer {
    /// The settings, the model and the shader tree.
    pub(super) fn work(&self) -> Work {
        let model = if self.model.loading { &self.model.requested } else { &self.model.path };
        let tree = self.source.location().map(Path::to_owned);
        Work { settings: self.session.settings.clone(), model: model.clone(), tree }
    }

    /// Goes on with the last session, as it was left.
    pub(super) fn restore_session(&mut self) {
        let Some(last) = self.panels.last_sessions.here.clone() else {
            return self.say("There is no session to restore");
        };
        let now = self.work();
        let Work { settings, model, tree } = last.work;
        if let Some(tree) =
            tree.filter(|tree| now.tree.as_ref().and_then(|now| std::path::absolute(now).ok()).as_ref() != Some(tree))
        {
            self.execute(Command::OpenTree(tree));
        }
        self.session.settings = settings;
        if now.model != model {
            // The camera is that of the session, and not one that frames the model.
            self.model.keeps_camera = true;
            self.load_model(model);
        }
        self.offers_session = false;
    }

    /// Whether to offer the last session: until the user does anything that is worth keeping.
    pub(in crate::app) fn offers_session(&mut self) -> bool {
        self.offers_session &= self.panels.last_sessions.here.is_some() && !self.has_work();
        self.offers_session
    }

    /// Whether the session differs from that of a plain start.
    fn has_work(&self) -> bool {
        self.plain.as_ref().is_none_or(|plain| !self.work().is_alike(plain))
    }

    /// Remembers the session, if there is anything to go on with.
    pub(in crate::app) fn remember_session(&self) {
        if self.has_work() {
            last_session::remember(&self.work());
        }
    }
}
