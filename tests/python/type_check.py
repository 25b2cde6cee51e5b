"""Checks the package and the code of the notebooks with pyright, strictly."""

import json
import os
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(os.environ["REPOSITORY"])


def code_of(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code") + "\n"


def main():
    here = Path.cwd()
    notebooks = sorted((REPOSITORY / "assets/notebooks").glob("*.ipynb"))
    assert notebooks
    for path in notebooks:
        (here / f"{path.stem}.py").write_text(code_of(path), encoding="utf-8")
    package = REPOSITORY / "assets/python"
    config = {
        "typeCheckingMode": "strict",
        "include": [os.path.relpath(package / "specula"), "."],
        "extraPaths": [str(package)],
    }
    (here / "pyrightconfig.json").write_text(json.dumps(config), encoding="utf-8")
    checked = subprocess.run(
        [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable], capture_output=True, text=True, check=False
    )
    found = json.loads(checked.stdout)
    faults = [f"{fault['file']}:{fault['range']['start']['line'] + 1}: {fault['message'][:300]}" for fault in found["generalDiagnostics"]]
    assert not faults, "\n".join(faults)
    # All modules of the package, and all notebooks.
    assert found["summary"]["filesAnalyzed"] >= len(list((package / "specula").glob("*.py"))) + len(notebooks), found["summary"]


main()
