//! Which modes a contact sheet shows, and which the window's command `probe` reads.

use crate::message::did_you_mean;
use crate::session::Session;
use crate::shader::Mode;

/// Names that stand for several modes.
const GROUPS: [&str; 3] = ["modes", "all", "paths"];

/// The modes of these names: `modes` for all that have data in the model and take one frame, `all` for all but the path-traced
/// ones, `paths` for those, or slugs; without a name, all but the path-traced ones. Slugs alone keep their order; else it is that of the
/// shader tree.
///
/// # Errors
/// A name that no mode has, with the nearest.
pub fn modes_of(session: &Session, names: &[String]) -> Result<Vec<Mode>, String> {
    let shaders = session.shaders.clone().unwrap_or_default();
    let features = session.features();
    let is_measured = !session.settings.measured.is_empty();
    let has_data = |mode: &Mode| mode.has_data(features) && (is_measured || !mode.slug.starts_with("measured"));
    let is_plain = |mode: &Mode| !mode.accumulate && !mode.traces && mode.pass.is_none() && has_data(mode);
    let has = |group: &str| names.iter().any(|name| name == group);
    let (wants_plain, wants_all, wants_paths) = (has("modes"), has("all") || names.is_empty(), has("paths"));
    let slugs = || shaders.modes.iter().map(|mode| mode.slug.as_str());
    for name in names.iter().filter(|name| !GROUPS.contains(&name.as_str())) {
        if !slugs().any(|slug| slug == name) {
            let hint = did_you_mean(name, slugs().chain(GROUPS));
            return Err(format!("there is no mode `{name}`.{hint} `specula modes` lists them all"));
        }
    }
    let is_wanted = |mode: &&Mode| {
        let is_in_group = if mode.follows_paths() { wants_paths } else { wants_all };
        is_in_group || (wants_plain && is_plain(mode)) || names.contains(&mode.slug)
    };
    let mut modes: Vec<Mode> = shaders.modes.iter().filter(is_wanted).cloned().collect();
    if !GROUPS.into_iter().any(has) {
        modes.sort_by_key(|mode| names.iter().position(|name| *name == mode.slug));
    }
    Ok(modes)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::settings::Settings;
    use crate::shader::ShaderSet;

    #[test]
    fn named_modes_keep_their_order() {
        let mut session = Session::new(Settings::default());
        let modes = ["final", "d", "f"].map(|slug| Mode { slug: slug.into(), ..Mode::default() }).to_vec();
        session.shaders = Some(Arc::new(ShaderSet { modes, ..ShaderSet::default() }));
        let of = |names: &[&str]| {
            let names: Vec<String> = names.iter().copied().map(str::to_owned).collect();
            let modes = modes_of(&session, &names).unwrap();
            modes.into_iter().map(|mode| mode.slug).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(of(&["f", "final"]), "f final");
        assert_eq!(of(&["f", "all"]), "final d f");
        assert_eq!(of(&[]), "final d f");
    }
}
