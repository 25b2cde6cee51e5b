"""A session on a tree of its own: edits write its files, keep what an editor has saved, and checks find what is wrong in the picture."""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import specula

SIZE = (96, 54)
NDF = "brdf/ndf.glsl"
SQUARED = "float a2 = alpha * alpha;"
HOOK = "void user_surface(inout Surface s, Fragment f, vec3 v) {"


def program(*arguments):
    return subprocess.run([os.environ["SPECULA"], *arguments], check=True, capture_output=True, text=True).stdout


def edits(s, tree):
    before = s.render()
    file = tree / NDF
    text = s.read(NDF)
    assert s.tree == tree and text == file.read_text(encoding="utf-8")
    s.edit(NDF, text.replace(SQUARED, "float a2 = alpha;"))
    assert file.read_text(encoding="utf-8") == text.replace(SQUARED, "float a2 = alpha;")
    assert not np.array_equal(s.render(), before)
    s.edit(NDF, text)
    assert np.array_equal(s.render(), before)
    # What an editor saves meanwhile is kept.
    file.write_text(text + "// of an editor\n", encoding="utf-8")
    s.edit(NDF, text.replace(SQUARED, "float a2 = alpha;"), base=text)
    both = text.replace(SQUARED, "float a2 = alpha;") + "// of an editor\n"
    assert file.read_text(encoding="utf-8") == both == s.read(NDF)
    # Unless both have changed a line.
    try:
        s.edit(NDF, text.replace(SQUARED, "float a2 = 0.5;"), base=text)
    except specula.SpeculaError as error:
        assert "changed by another program" in str(error), error
    else:
        raise AssertionError("the text of the editor is lost")
    assert file.read_text(encoding="utf-8") == both
    s.edit(NDF, text, base=both)
    made = tree / "user/made.glsl"
    s.edit("user/made.glsl", "float made;\n")
    assert made.read_text(encoding="utf-8") == "float made;\n" and "user/made.glsl" in s.files()
    for wrong in ("../outside.glsl", "Makefile"):
        try:
            s.edit(wrong, "// mine\n")
        except specula.CommandError:
            pass
        else:
            raise AssertionError(wrong)
    assert not (tree.parent / "outside.glsl").exists() and not (tree / "Makefile").exists()
    assert np.array_equal(s.render(), before)


def checks(s):
    text, chosen = s.read("user.glsl"), s["view.checks"]
    wrong = '\n    assert(s.roughness > 2.0, "is rough");\n    float root = sqrt(-1.0 - s.roughness);'
    s.edit("user.glsl", text.replace(HOOK, HOOK + wrong))
    line = text[: text.index(HOOK)].count("\n") + 2
    (found,) = s.checks()
    assert found["file"].endswith("user.glsl") and found["line"] == line and "is rough" in found["message"], found
    x, y = found["first"]
    assert found["count"] > 0 and 0 <= x < SIZE[0] and 0 <= y < SIZE[1], found
    undefined = s.checks(undefined=True)
    assert {(check["line"], "sqrt" in check["message"]) for check in undefined} >= {(line, False), (line + 1, True)}, undefined
    assert s["view.checks"] == chosen
    s.edit("user.glsl", text)
    assert s.checks(undefined=True) == []


def floats(s):
    """The raw floats of every kind of picture are those that the program writes."""
    s.set({"NDF": "Beckmann", "view.ev": 2.0})
    for mode in ("final", "d", "position", "roughness"):
        raw = s.render(mode, raw=True)
        look = ["--set", "NDF=Beckmann", "--set", "view.ev=2", "--mode", mode, "--shaders", str(s.tree)]
        program("render", "sphere-grid", "--env", "none", "--size", "96x54", *look, "--out", f"{mode}.exr")
        assert s.diff(raw, f"{mode}.exr").differing == 0, mode
        raw.save(f"{mode}.npy")
        loaded = np.load(f"{mode}.npy")
        assert loaded.dtype == np.float32 and loaded.shape == (54, 96, 4) and loaded.tobytes() == raw.tobytes(), mode
    shown = s.render()
    shown.save("shown.npy")
    assert np.array_equal(np.load("shown.npy"), shown)
    # A difference without a number.
    broken = s.render(raw=True)
    broken[20, 40, 1] = np.nan
    found = s.diff(s.render(raw=True), broken)
    assert found.error == found.largest == np.inf and found.largest_at == (40, 20) and found.differing == 1, found


def animations(s):
    webp = s.turntable(frames=2, size=(32, 18))
    assert webp.data[:4] == b"RIFF" and webp.data[8:12] == b"WEBP" and webp.ending == ".webp" and "<img" in webp._repr_html_()
    mp4 = s.turntable(".mp4", frames=2, size=(32, 18))
    assert mp4.data[4:8] == b"ftyp" and "<video" in mp4._repr_html_()
    mp4.save("turn.mp4")
    assert Path("turn.mp4").read_bytes() == mp4.data


def main():
    tree = Path.cwd() / "own"
    program("new", str(tree))
    device = json.loads(program("info", "--json"))["devices"][0]["name"]
    with specula.Session("sphere-grid", shaders="own", env="none", size=SIZE, device=device) as s:
        edits(s, tree)
        checks(s)
        floats(s)
        animations(s)
    try:
        specula.Session("sphere-grid", device="abacus")
    except specula.ProcessError as error:
        assert "abacus" in str(error), error
    else:
        raise AssertionError("there is a device abacus")
    # A folder `shaders` here is taken without being named.
    with specula.Session("sphere-grid", env="none", size=SIZE) as s:
        assert s.tree is None
    tree.rename("shaders")
    with specula.Session("sphere-grid", env="none", size=SIZE) as s:
        assert s.tree is not None and s.tree.resolve() == Path("shaders").resolve()


main()
