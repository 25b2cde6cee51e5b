//! `settings!` declares a group of settings. Each entry is one setting, and all there is to say about it.

/// Declares a struct whose fields are settings or groups of settings, its defaults, and access to them by path.
///
/// An entry is `name: Type = default, option(arguments) ...;` below its doc comment. The comment is what `specula help set`, the panel and
/// the palette say of the setting. The default may be left out where the type has the right one. The options are the methods of
/// [`Entry`](super::entry::Entry), as `limits(0.0, 1.0) row("Blur") slider(0.0, 1.0, 2)`. `as "name"` gives a setting a name that is no identifier.
macro_rules! settings {
    ($(#[$meta:meta])* pub struct $group:ident {
        $($(#[doc = $doc:literal])+ $(#[serde($($serde:tt)+)])?
        $field:ident $(as $renamed:literal)?: $kind:ty $(= $default:expr)? $(, $($option:ident($($argument:tt)*))+)?;)+
    }) => {
        $(#[$meta])*
        pub struct $group {
            $($(#[doc = $doc])+ $(#[serde($($serde)+)])? $(#[serde(rename = $renamed)])? pub $field: $kind,)+
        }

        impl Default for $group {
            fn default() -> Self {
                Self { $($field: settings!(@default $($default)?)),+ }
            }
        }

        impl $crate::settings::part::Part for $group {
            fn list(
                &self,
                path: &str,
                _: &'static $crate::settings::entry::Entry,
                list: &mut Vec<$crate::settings::setting::Setting>,
            ) {
                let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
                $({
                    #[allow(unused_imports, reason = "an entry may have neither a condition nor a unit")]
                    use $crate::settings::entry::{When::*, unit::*};
                    static ENTRY: $crate::settings::entry::Entry =
                        $crate::settings::entry::Entry::new(concat!($($doc),+))$($(.$option($($argument)*))+)?;
                    $crate::settings::part::Part::list(
                        &self.$field, &below(settings!(@name $field $($renamed)?)), &ENTRY, list,
                    );
                })+
            }

            fn at(&self, path: &str) -> Option<$crate::settings::value::Value> {
                let (name, rest) = path.split_once('.').unwrap_or((path, ""));
                $(if name == settings!(@name $field $($renamed)?) {
                    return $crate::settings::part::Part::at(&self.$field, rest);
                })+
                None
            }

            fn set_at(&mut self, path: &str, value: &$crate::settings::value::Value) {
                let (name, rest) = path.split_once('.').unwrap_or((path, ""));
                $(if name == settings!(@name $field $($renamed)?) {
                    $crate::settings::part::Part::set_at(&mut self.$field, rest, value);
                })+
            }
        }
    };
    (@default) => { Default::default() };
    (@default $default:expr) => { $default };
    (@name $field:ident) => { stringify!($field) };
    (@name $field:ident $renamed:literal) => { $renamed };
}

pub(super) use settings;
