//! Parses `//@pass`.

use super::cursor::Cursor;
use super::name::{check_name, name};
use super::pass::{Cull, Dispatch, Instances, PassDesc, PassFormat, PassSize, PassTarget};
use crate::message::did_you_mean;
use crate::shader::diagnostic::Diagnostic;

/// Number of images that every device can draw to in one pass.
const MOST_IMAGES: usize = 4;

/// Most quads that a pass draws.
const MOST_QUADS: u32 = 1 << 20;

/// Largest side of a pass's image in pixels, if it is given in pixels. The device may offer less.
const LARGEST_SIDE: u32 = 16384;

/// The options, for suggestions.
const OPTIONS: [&str; 16] = [
    "to",
    "after",
    "size",
    "format",
    "also",
    "draw",
    "instances",
    "cull",
    "blend",
    "dispatch",
    "when",
    "mips",
    "keep",
    "off",
    "doc",
    "instead",
];

/// Parses the rest of a `//@pass`.
pub fn pass(cursor: &mut Cursor<'_>) -> Result<PassDesc, Box<Diagnostic>> {
    let name = name(cursor, "pass")?;
    let label = cursor.string()?.filter(|label| !label.trim().is_empty()).unwrap_or_else(|| name.clone());
    let mut desc = PassDesc { name, label, on: true, place: cursor.place().clone(), ..PassDesc::default() };
    while !cursor.at_end() {
        let (bytes, key) = cursor.key();
        match key {
            "mips" => desc.mips = true,
            "keep" => desc.keep = true,
            "off" => desc.on = false,
            "blend" => desc.blend = true,
            "instead" => desc.instead = Some(cursor.value(key)?.1),
            "watches" => desc.watches = Some(cursor.value(key)?.1),
            "rows" => desc.rows_up = cursor.one_of(key, &[("up", true), ("down", false)])?,
            "cull" => {
                let all = [("none", Cull::None), ("front", Cull::Front), ("back", Cull::Back)];
                desc.cull = Some(cursor.one_of(key, &all)?);
            }
            "size" => desc.size = size(cursor)?,
            "format" => desc.format = format(cursor)?,
            "also" => desc.also = also(cursor)?,
            "after" => desc.after = Some(cursor.value(key)?.1),
            "dispatch" => desc.dispatch = dispatch(cursor)?,
            "when" => desc.when = Some(cursor.value(key)?.1),
            "instances" => desc.model = Some(instances(cursor)?),
            "draw" => match cursor.value(key)? {
                (_, what) if what == "model" => desc.model = desc.model.or(Some(Instances::Count(1))),
                (_, what) if what == "quads" => {
                    (desc.model, desc.quads) = (desc.model.or(Some(Instances::Count(1))), true);
                }
                (_, what) if what == "background" => desc.background = true,
                (bytes, other) => {
                    let message = format!("expected draw=model, draw=quads or draw=background, found `{other}`");
                    return Err(cursor.error(bytes, message));
                }
            },
            "doc" => desc.doc = cursor.value(key)?.1,
            "to" => {
                let all = [
                    ("picture", PassTarget::Picture),
                    ("peel", PassTarget::Peel),
                    ("resolve", PassTarget::Resolve),
                    ("mean", PassTarget::Mean),
                    ("display", PassTarget::Display),
                ];
                desc.to = cursor.one_of(key, &all)?;
            }
            other => {
                let known = "to=picture|peel|resolve|mean|display, after=, size=, format=, also=, draw=model|quads|background, instances=, cull=, \
                             blend, instead=, dispatch=, when=, mips, keep, off or doc=";
                if other == "camera" {
                    let message = "the camera of a pass is its vertex stage: a .vert file of the same name decides where vertices go";
                    return Err(cursor.error(bytes, message.to_owned()));
                }
                if other.starts_with('=') {
                    return Err(cursor.error(bytes, format!("the option before `{other}` takes no value")));
                }
                let hint = did_you_mean(other, OPTIONS);
                return Err(cursor.error(bytes, format!("expected {known}, found `{other}`.{hint}")));
            }
        }
    }
    Ok(desc)
}

fn size(cursor: &mut Cursor<'_>) -> Result<PassSize, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("size")?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=LARGEST_SIDE).contains(side));
    let size = match value.split_once(['/', 'x']) {
        None if value == "1" => Some(PassSize::Divided(1)),
        None => side(&value).map(|side| PassSize::Pixels(side, side)),
        Some(("1", by)) if value.contains('/') => {
            by.parse().ok().filter(|by| (1..=64).contains(by)).map(PassSize::Divided)
        }
        Some((width, height)) if value.contains('x') => {
            side(width).zip(side(height)).map(|(width, height)| PassSize::Pixels(width, height))
        }
        _ => None,
    };
    size.ok_or_else(|| {
        let message = format!(
            "expected size=1, size=1/2 to size=1/64, size=512x256 or size=512 (1 to {LARGEST_SIDE} pixels a side), \
             found `{value}`"
        );
        cursor.error(bytes, message)
    })
}

fn format(cursor: &mut Cursor<'_>) -> Result<PassFormat, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("format")?;
    format_named(&value).map_err(|message| cursor.error(bytes, message))
}

fn format_named(name: &str) -> Result<PassFormat, String> {
    let found = PassFormat::ALL.iter().find(|(known, _)| *known == name);
    found.map(|(_, format)| *format).ok_or_else(|| {
        let names: Vec<&str> = PassFormat::ALL.iter().map(|(name, _)| *name).collect();
        if name.starts_with('d') && name[1..].parse::<u32>().is_ok() {
            return "a pass with draw= has a depth of its own; to keep depth, write gl_FragCoord.z to format=r32f"
                .to_owned();
        }
        format!("expected one of the formats {}, found `{name}`", names.join(", "))
    })
}

/// Parses further images, as `also=normals:rgba16f,albedo`.
fn also(cursor: &mut Cursor<'_>) -> Result<Vec<(String, PassFormat)>, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("also")?;
    let images: Result<Vec<_>, String> = value
        .split(',')
        .map(|image| {
            let (name, format) = image.split_once(':').unwrap_or((image, PassFormat::default().glsl()));
            check_name(name, "image")?;
            Ok((name.to_owned(), format_named(format)?))
        })
        .collect();
    let images = images.map_err(|message| cursor.error(bytes.clone(), message))?;
    // Every device draws to four images at a time.
    if images.len() >= MOST_IMAGES {
        let message = format!("a pass draws at most {MOST_IMAGES} images, this one {}", images.len() + 1);
        return Err(cursor.error(bytes, message));
    }
    Ok(images)
}

fn dispatch(cursor: &mut Cursor<'_>) -> Result<Dispatch, Box<Diagnostic>> {
    /// The most workgroups along an axis that every device supports.
    const MOST: u32 = 65535;
    let (bytes, value) = cursor.value("dispatch")?;
    if value == "size" {
        return Ok(Dispatch::Size);
    }
    let counts: Option<Vec<u32>> = value.split('x').map(|count| count.parse().ok()).collect();
    let groups = counts.filter(|counts| counts.len() <= 3 && counts.iter().all(|count| (1..=MOST).contains(count)));
    match groups.as_deref() {
        Some([x]) => Ok(Dispatch::Groups([*x, 1, 1])),
        Some([x, y]) => Ok(Dispatch::Groups([*x, *y, 1])),
        Some([x, y, z]) => Ok(Dispatch::Groups([*x, *y, *z])),
        _ => {
            let message = format!(
                "expected dispatch=size or a number of workgroups, as dispatch=64 or dispatch=8x8x1 (1 to {MOST}), \
                 found `{value}`"
            );
            Err(cursor.error(bytes, message))
        }
    }
}

fn instances(cursor: &mut Cursor<'_>) -> Result<Instances, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("instances")?;
    if value == "lights" {
        return Ok(Instances::Lights);
    }
    let count = value.parse().ok().filter(|count| (1..=MOST_QUADS).contains(count));
    count.map(Instances::Count).ok_or_else(|| {
        let message = format!("expected instances=lights, or instances=1 to instances={MOST_QUADS}, found `{value}`");
        cursor.error(bytes, message)
    })
}
