"""Runs the notebooks. With a folder as argument, it writes the pictures that their cells show there."""

import base64
import os
import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient

FOLDER = Path(os.environ["REPOSITORY"]) / "assets/notebooks"


def run(path):
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        assert not cell.get("outputs"), f"{path.name} has outputs: strip them"
    start = time.monotonic()
    NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    pictures = [
        output.data["image/png"]
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if "image/png" in output.get("data", {})
    ]
    print(f"{path.name}: {len(pictures)} pictures in {time.monotonic() - start:.1f} s", flush=True)
    assert len(pictures) >= 3, path
    return notebook, pictures


def main():
    paths = sorted(FOLDER.glob("*.ipynb"))
    assert len(paths) == 3, paths
    for path in paths:
        notebook, pictures = run(path)
        for out in sys.argv[1:]:
            nbformat.write(notebook, Path(out) / path.name)
            for number, picture in enumerate(pictures):
                (Path(out) / f"{path.stem}-{number}.png").write_bytes(base64.b64decode(picture))


main()
