//! The SPIR-V that the driver gets does what the GLSL says: pictures of small shaders match the same programs in Rust.

use crate::support::{Session, assert_validated, glb, load, ready, settings};

const HOOK: &str = "vec3 user_radiance(Surface s, vec3 v, vec3 radiance) {";

/// Draws `program(int k, float x)`, for k of 0..7 and x of 0..5 by pixel, and compares every pixel with `expected`. Values must be
/// half floats.
#[track_caller]
fn assert_computes(session: &mut Session, program: &str, expected: impl Fn(i32, f32) -> f32) {
    let call = "int k = int(gl_FragCoord.x) % 7; float x = floor(mod(gl_FragCoord.y, 5.0));";
    let text = format!("{program}\n{HOOK}\n    {call}\n    return vec3(float(k), x, program(k, x));");
    ready(&session.edit("user.glsl", HOOK, &text));
    let capture = session.render();
    let mut seen = std::collections::HashSet::new();
    for value in capture.raw.iter().filter(|value| value[3] == 1.0) {
        let (k, x) = (value[0] as i32, value[1]);
        assert_eq!(value[2], expected(k, x), "k {k}, x {x}: {program}");
        seen.insert((k, x as i32));
    }
    assert_eq!(seen.len(), 35, "every k and x is drawn");
    ready(&session.edit("user.glsl", &text, HOOK));
    assert_validated();
}

fn session() -> Session {
    let plain = ["view.msaa=1", "view.background=none", "environment.name=none", "lights.source=none"];
    Session::new(load(&glb::model(&glb::sphere(24, 48), &glb::gray())), settings(&plain))
}

#[test]
fn functions_return_early_and_late() {
    let mut session = session();
    assert_computes(
        &mut session,
        "float program(int k, float x) {
            if (k > 3) { if (x > 2.0) return 10.0; x += 1.0; } else if (k == 2) { return x; }
            return x * 2.0 + float(k);
        }",
        |k, x| match k {
            4.. if x > 2.0 => 10.0,
            4.. => (x + 1.0) * 2.0 + k as f32,
            2 => x,
            _ => x * 2.0 + k as f32,
        },
    );
    // Returns from a loop, and calls of a function that returns early from within a function that does
    assert_computes(
        &mut session,
        "float limited(float a) { if (a > 6.0) return 6.0; return a; }
         float sum(int k, float x) {
            float sum = 0.0;
            for (int i = 0; i < k; ++i) { if (i == 3) continue; if (sum > 9.0) return sum; sum += limited(x * float(i)); }
            return -sum;
         }
         float program(int k, float x) { if (k == 6) return limited(sum(k, x)); return limited(x) + sum(k, x); }",
        |k, x| {
            let limited = |a: f32| a.min(6.0);
            let mut sum = 0.0;
            let all = (0..k).filter(|i| *i != 3).all(|i| {
                let goes_on = sum <= 9.0;
                sum += if goes_on { limited(x * i as f32) } else { 0.0 };
                goes_on
            });
            let sum = if all { -sum } else { sum };
            if k == 6 { limited(sum) } else { limited(x) + sum }
        },
    );
}

#[test]
fn loops_carry_values() {
    let mut session = session();
    // Two values that change places: phis that read each other
    assert_computes(
        &mut session,
        "float program(int k, float x) {
            float a = 1.0, b = x;
            for (int i = 0; i < k; ++i) { float old = a; a = b; b = old; }
            return a * 8.0 + b;
        }",
        |k, x| if k % 2 == 0 { 8.0 + x } else { x * 8.0 + 1.0 },
    );
    // A switch that falls through, within a loop that it cannot break
    assert_computes(
        &mut session,
        "float program(int k, float x) {
            float sum = x;
            for (int i = 0; i < k; ++i) {
                switch (i % 3) { case 0: sum += 1.0; case 1: sum += 2.0; break; default: if (sum > 9.0) continue; sum *= 2.0; }
                sum += 0.25;
            }
            return sum;
        }",
        |k, x| {
            (0..k).fold(x, |sum, i| match i % 3 {
                0 => sum + 3.25,
                1 => sum + 2.25,
                _ if sum > 9.0 => sum,
                _ => sum * 2.0 + 0.25,
            })
        },
    );
    // A function in the condition, which changes a global variable
    assert_computes(
        &mut session,
        "int ticks = 5;
         bool tick(int k) { ++ticks; return ticks < k; }
         float program(int k, float x) {
            int start = ticks;
            ticks = 0;
            do { x += 1.0; } while (tick(k));
            bool is_more = k > 2 && tick(9);
            return float(ticks + start) + (is_more ? x : 0.0);
         }",
        |k, x| {
            let rounds = k.max(1);
            if k > 2 { (rounds + 6) as f32 + x + rounds as f32 } else { (rounds + 5) as f32 }
        },
    );
}

#[test]
fn composites_are_read_and_written_in_parts() {
    let mut session = session();
    assert_computes(
        &mut session,
        "struct Inner { float a[3]; vec2 b; };
         struct Outer { Inner inner[2]; float c; };
         void turn(inout Inner p, int i) {
            float first = p.a[0]; p.a[0] = p.a[1]; p.a[1] = p.a[2]; p.a[2] = first;
            p.b.y = p.a[i % 3];
         }
         float program(int k, float x) {
            Outer o = Outer(Inner[2](Inner(float[](1.0, 2.0, 3.0), vec2(x)), Inner(float[](4.0, 5.0, 6.0), vec2(7.0))), x);
            for (int i = 0; i < k; ++i) turn(o.inner[0], i);
            o.inner[1] = o.inner[0];
            Outer copy = o;
            o.inner[1].b = vec2(0.0);
            return copy.inner[1].a[0] * 16.0 + copy.inner[1].b.y * 4.0 + o.inner[1].b.x + o.c;
         }",
        |k, x| {
            let (mut a, mut y) = ([1.0, 2.0, 3.0], x);
            for i in 0..k as usize {
                a.rotate_left(1);
                y = a[i % 3];
            }
            a[0] * 16.0 + y * 4.0 + x
        },
    );
    assert_computes(
        &mut session,
        "void both(out float a, float b) { a = 3.0; a += b; }
         float program(int k, float x) {
            mat2 m = mat2(1.0);
            m[1][0] = x;
            vec3 v = vec3(k, x, 1.0);
            v.zx = v.xy;
            v[k % 3] += 4.0;
            both(x, x);
            return (m * v.xy).x + v.z * 16.0 + x;
         }",
        |k, x| {
            let mut v = [x, x, k as f32];
            v[k as usize % 3] += 4.0;
            v[0] + x * v[1] + v[2] * 16.0 + x + 3.0
        },
    );
}

/// Code that folding cuts off: back edges of loops, dead ends behind returns.
#[test]
fn what_is_decided_early_leaves_the_rest() {
    let mut session = session();
    assert_computes(
        &mut session,
        "float sum(float x, int k, bool once) {
            float s = 0.0;
            for (int i = 0; i < k; ++i) { s += x + float(i); if (once) break; }
            return s;
         }
         float program(int k, float x) { return sum(x, k, true) * 0.25 + sum(x, k, false); }",
        |k, x| (0..k.min(1)).map(|_| x).sum::<f32>() * 0.25 + (0..k).map(|i| x + i as f32).sum::<f32>(),
    );
    assert_computes(
        &mut session,
        "float sum(float x, int k, int mode) {
            float s = 0.0;
            for (int i = 0; i < 8; i += (x > 2.0 && k > 1) ? 1 : 2) {
                s += x;
                if (mode == 3) { s += 1.0; break; } else if (mode == 4) continue;
                s += 2.0;
            }
            return s;
         }
         float program(int k, float x) { return sum(x, k, 3) + sum(x, k, 4) + sum(x, k, 5); }",
        |k, x| {
            let rounds = if x > 2.0 && k > 1 { 8.0 } else { 4.0 };
            (x + 1.0) + rounds * x + rounds * (x + 2.0)
        },
    );
    // Both ways return, so that what follows is unreachable, behind a loop that counts its rounds
    assert_computes(
        &mut session,
        "float f(inout vec2 c, int k, float x) {
            for (int i = 0; i < k; ++i) c.x += x;
            if (k > 3) { c.y = 1.0; return 2.0; } else { c.y = 3.0; return 4.0; }
         }
         float program(int k, float x) { vec2 c = vec2(x); float r = f(c, k, x); return r * 8.0 + c.x + c.y; }",
        |k, x| if k > 3 { 17.0 } else { 35.0 } + (k + 1) as f32 * x,
    );
    // Indices and lengths that only constants know, and values without an initial value
    assert_computes(
        &mut session,
        "#extension GL_EXT_null_initializer : enable
         layout(constant_id = USER_CONSTANTS + 16) const int HALF = 4;   //@ui \"Half\" 0..8
         struct Pair { float a; vec2 b[2]; };
         Pair pair = {};
         float program(int k, float x) {
            float a[HALF / 2];
            a[0] = x;
            a[1] = float(k);
            if (k > 2) { a[1] += 1.0; pair.a += x; }
            Pair other = {};
            other.b[1].y += x;
            return a[0] + a[HALF / 4] * 8.0 + pair.a * 0.25 + pair.b[0].x + other.b[1].y * 0.5 + other.a;
         }",
        |k, x| {
            let more = if k > 2 { (1.0, x) } else { (0.0, 0.0) };
            x + (k as f32 + more.0) * 8.0 + more.1 * 0.25 + x * 0.5
        },
    );
}
