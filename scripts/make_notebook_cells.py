"""Takes parts out of notebooks that tests/python/notebooks.py has run, for the picture of them: python3 make_notebook_cells.py FOLDER.

For each FOLDER/NAME.ipynb it writes FOLDER/NAME/NUMBER.pango, the code of a cell with colors, and NUMBER.png, the picture that the cell shows.
"""

import base64
import sys
from pathlib import Path

import nbformat
from pygments import highlight
from pygments.formatters import get_formatter_by_name
from pygments.lexers import PythonLexer

# The cells that are shown: texts that their code contains, and how many of their last lines.
SHOWN = {
    "brdf_terms": [('row("d")', 1), ('row("v")', 1), ("specula.tile([front, behind]", 1), ('NDF="Beckmann"', 3)],
    "furnace": [("vanished = s.render()", 3), ("ghosts = ", 1), ("maps: ", 5)],
    "tone_maps": [("def through", 1), ("flip(aces, neutral)", 1), ("plot([aces", 1), ("steps: ", 1)],
}


def main() -> None:
    folder = Path(sys.argv[1])
    formatter = get_formatter_by_name("pango", style="one-dark")
    for name, texts in SHOWN.items():
        out = folder / name
        out.mkdir()
        cells = [cell for cell in nbformat.read(folder / f"{name}.ipynb", as_version=4).cells if cell.cell_type == "code"]
        for number, (text, lines) in enumerate(texts):
            (cell,) = [cell for cell in cells if text in cell.source]
            # The end of a long cell shows the picture.
            code = "\n".join(cell.source.splitlines()[-lines:])
            (out / f"{number}.pango").write_text(highlight(code, PythonLexer(), formatter), encoding="utf-8")
            (picture,) = [output.data["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})]
            (out / f"{number}.png").write_bytes(base64.b64decode(picture))


main()
