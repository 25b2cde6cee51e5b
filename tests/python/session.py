"""One session: pictures, threads, Ctrl+C, errors with a caret, values, a crash of the program."""

import os
import signal
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import specula

SIZE = (96, 54)
PATIENCE_S = 60


def until(what, is_true):
    """Waits for an event of another thread or process."""
    end = time.monotonic() + PATIENCE_S
    while not is_true():
        assert time.monotonic() < end, f"waited in vain until {what}"
        time.sleep(0.005)


def pictures(s):
    shown, raw = s.render(), s.render(raw=True)
    assert shown.shape == raw.shape == (54, 96, 4)
    assert shown.dtype == np.uint8 and raw.dtype == np.float32
    assert shown.png().startswith(b"\x89PNG") and shown._repr_png_() == shown.png()
    assert isinstance(shown[..., 0], specula.Picture) and isinstance(float(raw.mean()), float)
    assert s.render("d", size=(20, 10)).shape == (10, 20, 4)
    # Exactly the floats that the program writes.
    command = [os.environ["SPECULA"], "render", "sphere-grid", "--env", "none", "--size", "96x54", "--out", "a.exr"]
    subprocess.run(command, check=True)
    assert s.diff(raw, "a.exr").differing == 0
    raw.save("b.exr")
    shown.save("b.png")
    assert s.diff("b.exr", "a.exr").differing == 0 and s.diff("b.png", shown).differing == 0
    changed = raw.copy()
    changed[20, 40, 1] = np.nextafter(changed[20, 40, 1], np.float32(9))
    assert s.diff(changed, "a.exr").differing == 1, "a single bit of a float is not seen"


def settings(s):
    before = s.render()
    s["view.ev"] = 2
    assert s["view.ev"] == 2 and (s.render()[..., :3].mean() < before[..., :3].mean())
    s.set({"view.ev": 0.7}, material={"enabled": True, "roughness": np.float32(0.25)})
    assert s.get("material.roughness") == 0.25
    s.set(NDF="Beckmann", mode="d")
    assert s.render(raw=True).encode == "data"
    s.set(NDF="GGX", mode="final")
    s.set("material.enabled", False)
    assert np.array_equal(s.render(), before)
    try:
        s.set("view.evv", 1)
    except specula.CommandError as error:
        assert "view.ev" in str(error), error
    else:
        raise AssertionError("an unknown setting was taken")


def threads(s):
    modes = ["d", "f", "v", "shading-normal"]
    alone = {mode: s.render(mode) for mode in modes}
    wrong = []

    def draw(mode):
        for _ in range(2):
            if not np.array_equal(s.render(mode), alone[mode]):
                wrong.append(mode)

    working = [threading.Thread(target=draw, args=(mode,)) for mode in modes * 2]
    for thread in working:
        thread.start()
    for thread in working:
        thread.join()
    assert not wrong, wrong


def interrupts(s):
    before = s.render()
    for _ in range(3):
        channel, before_it = s._channel, set(s._channel._pending)

        def interrupt():
            until("the command is open", lambda: set(channel._pending) - before_it)
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        try:
            s.turntable(frames=2000)
        except KeyboardInterrupt:
            pass
        else:
            raise AssertionError("the call was not interrupted")
        thread.join()
    assert np.array_equal(s.render(), before)
    # The animations were canceled: none is under way, and no file is left.
    until("the animations are canceled", lambda: not s._channel._pending)
    folder = s._scratch._folder
    assert [path.name for path in folder.iterdir()] == ["lock"], list(folder.iterdir())


def edits(s):
    text = s.read("brdf/ndf.glsl")
    assert "brdf/ndf.glsl" in s.files() and "float a2 = alpha * alpha;" in text
    before = s.render()
    try:
        s.edit("brdf/ndf.glsl", text.replace("float a2 = alpha * alpha;", "float a2 = aplha * alpha;"))
    except specula.ShaderError as error:
        (first, *_) = error.diagnostics
        lines = str(error).splitlines()
        assert first.file.endswith("brdf/ndf.glsl") and first.line, first
        assert "undeclared identifier" in lines[0] and f":{first.line}:" in lines[0], lines
        assert "float a2 = aplha * alpha;" in lines[1], lines
        # The caret stands below the word.
        assert lines[1].index("aplha") == lines[2].index("^") and lines[2].count("^") == 5, lines
    else:
        raise AssertionError("a wrong shader compiled")
    assert np.array_equal(s.render(), before), "the last good picture is gone"
    s.edit("brdf/ndf.glsl", text.replace("float a2 = alpha * alpha;", "float a2 = alpha;"))
    assert not np.array_equal(s.render(), before)
    assert s.check() == []
    try:
        s.edit("long.glsl", "//" + 5_000_000 * "x")
    except ValueError as error:
        assert "bytes" in str(error)
    else:
        raise AssertionError("a line that the program skips was sent")
    s.edit("brdf/ndf.glsl", None)
    assert s.read("brdf/ndf.glsl") == text and np.array_equal(s.render(), before)


def mistakes(s):
    """Wrong arguments are told, by what they lack."""
    for part, wrong in (
        ("such as (640, 360)", lambda: s.render(size="640x360")),
        ("such as (640, 360)", lambda: s.render(size=(10.5, 10))),
        ("such as (640, 360)", lambda: s.render(size=(10,))),
        ("lacks a value", lambda: s.set("view.ev")),
        ("takes one or more of", s.open),
        ("['--lights', 'none']", lambda: specula.Session(options="--lights none")),
        ("has no value at this pixel", lambda: s.trace(48, 27, "brdf/ndf.glsl")["nothing"]),
    ):
        try:
            wrong()
        except (TypeError, KeyError) as error:
            assert part in str(error), error
        else:
            raise AssertionError(f"no error about: {part}")
    s.open(env="none")
    assert s["environment.name"] == "none"


def values(s):
    x, y = 48, 27
    raw = s.render("d", raw=True)
    covered = np.argwhere(raw[..., 3] == 1.0)
    y, x = (int(at) for at in covered[len(covered) // 2])
    probe = s.probe(x, y, ["d", "n-dot-h"])
    assert probe.pixel == (x, y) and set(probe.modes) == {"d", "n-dot-h"} and probe["d"].shape == (4,)
    assert np.array_equal(s.probe(x, y, "d")["d"], probe["d"])
    trace = s.trace(x, y, "brdf/ndf.glsl")
    assert trace.stage == "pbr.frag" and "a2 =" in str(trace), trace
    assert 0 < trace["a2"] < 1
    furnace = s.furnace()
    assert furnace.albedo.shape == (len(furnace.roughness), len(furnace.cos_theta), 3)
    assert 0.9 < furnace.min and furnace.max <= 1.005 and furnace.claims_conservation, furnace
    assert furnace._repr_png_().startswith(b"\x89PNG")
    assert any(mode.slug == "d" and mode.encode == "data" for mode in s.modes())
    a, b = s.render(), s.render("d")
    found = s.diff(a, b)
    assert found.measure == "flip" and found.error > 0 and found.map.shape == (54, 96, 4) and found._repr_png_().startswith(b"\x89PNG")
    assert s.diff(a, a).differing == 0
    assert s.sheet(["final", "d"], size=(32, 18)).data.startswith(b"\x89PNG")
    spin = s.turntable(".gif", frames=2, size=(32, 18))
    assert spin.data.startswith(b"GIF8") and "<img" in spin._repr_html_()
    assert s.checks() == []


def crash(s):
    """The process that draws is killed while a command is open."""
    before = s.render()
    supervisor = s._channel.pid
    (worker,) = Path(f"/proc/{supervisor}/task/{supervisor}/children").read_text().split()
    channel = s._channel

    def kill():
        until("the command is open", lambda: channel._pending)
        os.kill(int(worker), signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    try:
        s.turntable(frames=2000)
    except specula.CrashError as error:
        assert "turntable" in str(error) and error.stderr, error
    else:
        raise AssertionError("the crash was not told")
    thread.join()
    assert np.array_equal(s.render(), before), "the session does not go on"
    # The program itself.
    os.kill(supervisor, signal.SIGKILL)
    try:
        while True:
            s.render()
    except specula.ProcessError as error:
        assert error.code == -signal.SIGKILL and "SIGKILL" in str(error), error


def main():
    session = specula.Session("sphere-grid", env="none", size=SIZE)
    for step in (pictures, settings, threads, interrupts, edits, mistakes, values, crash):
        start = time.monotonic()
        step(session)
        print(f"{step.__name__}: {time.monotonic() - start:.2f} s", flush=True)
    session.close()


main()
