//! The memory that images and buffers of passes take.

use specula::headless::HeadlessError;

use super::{pass, sphere};
use crate::support::{Session, assert_differ, assert_same, assert_validated, ready};

/// The line of the error with which the session draws no picture.
fn refusal(session: &mut Session) -> String {
    match session.headless.render() {
        Err(HeadlessError::Shaders(errors)) => errors[0].one_line(),
        Err(error) => error.to_string(),
        Ok(_) => String::new(),
    }
}

#[test]
fn passes_take_no_more_memory_than_allowed() {
    let mut session = sphere(&["view.pass_memory=6"]);
    let before = session.render();
    let image = |options: &str| pass(&format!("big {options}"), "", "color = vec4(0.5);");
    ready(&session.save("passes/big.frag", &image("size=1024x1024 format=r32f")));
    let shows = pass("show to=picture", "uniform sampler2D big;", "color = texture(big, uv);");
    ready(&session.save("passes/show.frag", &shows));
    let shown = session.render();
    assert_differ(&before, &shown, "4 MiB of 6");
    // A frame more, levels, a wider format, a buffer.
    let with_buffer = pass(
        "big size=1024x1024 format=r32f",
        "buffer Many { float many[1048576]; };",
        "color = vec4(0.5); many[0] = 1.0;",
    );
    for (text, taken) in [
        (image("size=1024x1024 format=r32f keep"), 8),
        (image("size=1024x1024 format=r32f mips"), 10),
        (image("size=1024x1024"), 8),
        (with_buffer, 8),
    ] {
        ready(&session.save("passes/big.frag", &text));
        let expected = format!(
            "error: with the pass `big` the images and buffers of passes take {taken} MiB, and --memory allows 6"
        );
        assert!(refusal(&mut session).contains(&expected), "{}", refusal(&mut session));
    }
    session.set("view.pass_memory=16");
    session.render();
    session.set("view.pass_memory=6");
    ready(&session.save("passes/big.frag", &image("size=1024x1024 format=r32f")));
    assert_same(&shown, &session.render(), "it fits again");
    assert_validated();
}

/// Images of which one is no longer read when the other is drawn are one image of the device.
#[test]
fn images_that_are_not_needed_at_the_same_time_share_their_memory() {
    // A chain of eight passes of 4 MiB each, of which each reads the one before: two images are enough.
    let chain = |last: &str| {
        let mut files = vec![(
            "passes/c0.frag".to_owned(),
            pass("c0 size=1024x1024 format=r32f", "uniform sampler2D picture;", "color = texture(picture, uv).gggg;"),
        )];
        for i in 1..8 {
            let (name, read) = (format!("c{i} size=1024x1024 format=r32f"), format!("c{}", i - 1));
            let body = format!("color = texture({read}, uv) * 0.9 + 0.01;");
            files.push((format!("passes/c{i}.frag"), pass(&name, &format!("uniform sampler2D {read};"), &body)));
        }
        files.push(("passes/last.frag".to_owned(), last.to_owned()));
        files
    };
    let last = pass("last to=picture", "uniform sampler2D c7;", "color = vec4(texture(c7, uv).rrr, 1.0);");
    let mut session = sphere(&["view.pass_memory=8"]);
    let all = |session: &mut Session, files: &[(String, String)]| {
        files.iter().for_each(|(path, text)| session.tree.write(path, text));
        ready(&session.changed(&files.iter().map(|(path, _)| path.as_str()).collect::<Vec<_>>()));
    };
    all(&mut session, &chain(&last));
    let shared = session.render();
    // With an image of its own for each pass (`keep`) the picture is the same.
    session.set("view.pass_memory=2048");
    let own = chain(&last).into_iter().map(|(path, text)| (path, text.replace("format=r32f", "format=r32f keep")));
    all(&mut session, &own.collect::<Vec<_>>());
    assert_same(&session.render(), &shared, "each image of its own");
    // The first is still read at the end, so a third image is needed. So it is while the first is shown.
    let reads_first = pass(
        "last to=picture",
        "uniform sampler2D c7; uniform sampler2D c0;",
        "color = vec4(texture(c7, uv).r, texture(c0, uv).r, 0.0, 1.0);",
    );
    session.set("view.pass_memory=8");
    all(&mut session, &chain(&reads_first));
    let error = refusal(&mut session);
    assert!(error.contains("the images and buffers of passes take 12 MiB, and --memory allows 8"), "{error}");
    session.set("view.pass_memory=12");
    session.render();
    all(&mut session, &chain(&last));
    session.set("mode=pass:c0");
    let first = session.render();
    session.set("mode=final");
    assert_same(&session.render(), &shared, "back to the picture");
    session.set("mode=pass:c0");
    assert_same(&session.render(), &first, "the first image again");
    // What follows a pass that is off no longer changes with every picture, so later frames may keep it: no image is shared.
    session.set("mode=final");
    session.set("view.pass_memory=16");
    session.set("passes.c3=false");
    session.render();
    session.set("passes.c3=true");
    assert_same(&session.render(), &shared, "off and on");
    assert_validated();
}
