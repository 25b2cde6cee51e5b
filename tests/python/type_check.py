"""Checks the package and the code of the notebooks with pyright, strictly, and the package for the oldest Python that the wheel allows."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(os.environ["REPOSITORY"])
PACKAGE = REPOSITORY / "assets/python"


def code_of(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code") + "\n"


def checked(folder, **config):
    """What pyright says with this configuration, which must be nothing, and how many files it has read."""
    folder.mkdir(exist_ok=True)
    config = {"include": [os.path.relpath(PACKAGE / "specula", folder), "."], "extraPaths": [str(PACKAGE)], **config}
    (folder / "pyrightconfig.json").write_text(json.dumps(config), encoding="utf-8")
    command = [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable]
    found = json.loads(subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False).stdout)
    faults = [f"{fault['file']}:{fault['range']['start']['line'] + 1}: {fault['message'][:300]}" for fault in found["generalDiagnostics"]]
    return faults, found["summary"]["filesAnalyzed"]


def passes(folder, expected, **config):
    faults, files = checked(folder, **config)
    assert not faults, "\n".join(faults)
    assert files >= expected, files


def main():
    here = Path.cwd()
    notebooks = sorted((REPOSITORY / "assets/notebooks").glob("*.ipynb"))
    modules = list((PACKAGE / "specula").glob("*.py"))
    assert notebooks and modules
    strict = here / "strict"
    strict.mkdir()
    for path in notebooks:
        (strict / f"{path.stem}.py").write_text(code_of(path), encoding="utf-8")
    passes(strict, len(modules) + len(notebooks), typeCheckingMode="strict")
    # The oldest Python of the wheel. Not strictly: numpy's types are written for a newer one, and unknown here.
    oldest = re.search(r"Requires-Python: >=([0-9.]+)", (REPOSITORY / "scripts/packaging/wheel.py").read_text(encoding="utf-8"))[1]
    manual = (REPOSITORY / "assets/manual/python.md").read_text(encoding="utf-8")
    assert f"({oldest} or newer)" in " ".join(manual.split()), oldest
    old = {"typeCheckingMode": "standard", "pythonVersion": oldest}
    passes(here / "old", len(modules), **old)
    (here / "newer").mkdir()
    (here / "newer/newer.py").write_text("def f(x: int | None) -> list[int]: ...\n", encoding="utf-8")
    faults, _ = checked(here / "newer", **old)
    assert len(faults) == 2 and all("newer.py" in fault for fault in faults), faults


main()
