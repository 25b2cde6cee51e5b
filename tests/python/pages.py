"""The blocks of Python in README.md and in the manual run, and do what these pages say."""

import contextlib
import io
import os
import re
from pathlib import Path

import specula

REPOSITORY = Path(os.environ["REPOSITORY"])


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", (REPOSITORY / page).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def readme():
    (code,) = blocks("README.md", "python")
    names = {}
    # Each line as a cell of a notebook.
    results = []
    for line in code.splitlines():
        try:
            results.append(eval(compile(line, "README.md", "eval"), names))
        except SyntaxError:
            exec(compile(line, "README.md", "exec"), names)
    with names["s"] as s:
        assert s["material.roughness"] == 0.3 and "a2 = alpha;" in s.read("brdf/ndf.glsl")
        pictures = [result for result in results if isinstance(result, specula.Picture)]
        assert [picture._repr_png_()[:4] for picture in pictures] == [b"\x89PNG"], results
        (furnace,) = (result for result in results if isinstance(result, specula.Furnace))
        assert furnace.max > 1.005, "the mistake invents no energy"


def manual():
    code = blocks("assets/manual/python.md", "python")
    assert len(code) == 3, code
    names = {}
    exec(code[0], names)
    with names["s"] as s:
        assert s.render().shape == (360, 640, 4)
        exec(code[1], names)
        assert s["view.ev"] == 1 and s["material.enabled"] is True and s["material.metallic"] == 1.0 and s["NDF"] == "Beckmann"
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(code[2], names)
        (expected,) = blocks("assets/manual/python.md", "text")
        assert printed.getvalue().strip() == expected.strip(), printed.getvalue()


readme()
manual()
