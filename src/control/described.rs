//! The list of commands: what each takes, and its result.

/// A command in words.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct Described {
    /// Its name.
    pub command: &'static str,
    /// Its fields, as JSON that could be sent. `?` marks those that may be left out.
    pub takes: &'static str,
    /// Description of the command and its result.
    pub doc: &'static str,
}

const fn row(command: &'static str, takes: &'static str, doc: &'static str) -> Described {
    Described { command, takes, doc }
}

/// All commands.
pub const COMMANDS: [Described; 29] = [
    row(
        "set",
        r#""values": "path=value" | ["path=value", ...] | {"path": value}"#,
        "Changes settings, all or none. Done when their final picture is on screen",
    ),
    row("get", r#""path"?: "view.ev""#, "The settings, or the one at a path"),
    row("mode", r#""name": "d""#, "Shows a debug mode"),
    row(
        "camera",
        r#""eye"?: [x,y,z], "target"?: [x,y,z], "fovy"?: deg, "azimuth"?: deg, "elevation"?: deg, "frame"?: true, "view"?: "front""#,
        "Moves the camera; azimuth, elevation, frame and view frame the model. Result: eye, target, fovy",
    ),
    row(
        "capture",
        r#""file"?: "a.png" | "a.exr", "size"?: [w,h], "mode"?: "d", "frames"?: n, "ui"?: true"#,
        "Writes the picture as it is on screen, or drawn anew at a size or in a mode; EXR holds raw floats; with ui the whole window. Result: file, width, height",
    ),
    row(
        "probe",
        r#""at": [x,y], "modes"?: ["d", "f"] | ["all", "paths"]"#,
        "Raw values of a pixel of the picture, in these modes; without them, in all but those of random paths. Result: pixel, modes, \
         textures (a texel of each), not_finite (the first line with NaN or Inf, if a value is one)",
    ),
    row("reload", "", "Compiles all shaders again. Result: generation; an error lists the diagnostics"),
    row(
        "open",
        r#""file" | "model" | "environment" | "tree" | "look" | "measured": "path or name""#,
        "Opens a file or folder. Done when its final picture is on screen",
    ),
    row(
        "compare",
        r#""with"?: "nothing" | "picture" | "previous" | number, "file"?: "a.png", "tree"?: "folder", "wipe"?: 0..1"#,
        "Compares the picture with an earlier one, a picture from a file (PNG, JPEG, HDR, EXR) or that of another shader tree. Result: version, file, tree, wipe, note; an event `compared` has FLIP",
    ),
    row(
        "versions",
        r#""show"?: number | "newest", "write"?: number"#,
        "Versions of the shaders since the start; show puts one in place of the newest until a file is saved, write puts it into the files",
    ),
    row(
        "grid",
        r#""modes": ["final", "d", "f"]"#,
        "Shows up to nine modes side by side; the selected mode becomes one of them. An empty list shows it alone. Result: modes",
    ),
    row(
        "pick",
        r#""at"?: [x,y]"#,
        "Does what a click on a pixel of the picture does: pins it for the inspector and selects what it shows. Without `at` it takes \
         both back. Result: instance, node, primitive, material",
    ),
    row(
        "write-defaults",
        r#""names"?: ["Rim", ...]"#,
        "Writes the values of these parameters, or of all, into the GLSL as their defaults. Does not ask. Result: edits",
    ),
    row(
        "numbers",
        r#""at"?: "brdf/ndf.glsl:20", "values"?: [0.5, null, ...], "write"?: true"#,
        "Lists the numbers of a line of the shaders, or shows the picture with other values in their place (null leaves one), without a \
         change of the file. write puts them into it; without fields it goes back to the file. Result: line, numbers; generation; edits",
    ),
    row("undo", "", "Takes the last change of a setting back"),
    row("redo", "", "Takes the last undo back"),
    row("pass", r#""name": "bloom", "on"?: true | false"#, "Switches a pass on or off"),
    row(
        "playback",
        r#""paused"?: bool, "step"?: true, "restart"?: true, "time"?: s, "speed"?: factor"#,
        "The clock of animated shaders. Result: time, paused, speed",
    ),
    row("modes", "", "All debug modes: id, name, slug, group, encode, doc"),
    row("settings", "", "All settings, with what each takes, its range, unit and meaning"),
    row("commands", "", "This list"),
    row("help", "", "This list"),
    row("entries", "", "What the command palette can do at the moment; `now` marks the choices in force"),
    row(
        "run",
        r#""entry": "Layout: Look", "value"?: number"#,
        "Does what an entry of the command palette does; value is for numbers",
    ),
    row(
        "sheet",
        r#""file": "sheet.png", "modes"?: "modes" | "all" | ["all", "paths"] | ["d", ...], "size"?: [w,h], "columns"?: n"#,
        "Writes a contact sheet of modes with their names; size is that of one picture",
    ),
    row(
        "turntable",
        r#""file": "spin.mp4" | ".gif" | ".webp" | ".png", "frames"?: n, "fps"?: n, "size"?: [w,h], "turn"?: "camera" | "light" | "model""#,
        "Writes a full turn as a video, as an animation, or as numbered PNGs",
    ),
    row(
        "timeline",
        r#""file": "edits.mp4" | ".gif" | ".webp" | ".png", "fps"?: n, "size"?: [w,h]"#,
        "Writes the versions of the shaders as a video or an animation",
    ),
    row(
        "cancel",
        "",
        "Ends the captures, sheets, animations and probes that are under way; each answers with an error",
    ),
    row("quit", "", "Closes the window"),
];
