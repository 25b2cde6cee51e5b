"""Writes a wheel with the program, its share folder and its Python package:
python3 wheel.py ROOT NAME VERSION SUMMARY PLATFORM README PACKAGE OUT_FOLDER.

README becomes the page of the wheel on PyPI, where nothing is beside it: it must not link to files. ROOT holds bin/ and share/. pip puts them into bin and share of a virtual environment, or of ~/.local, and the package where it is imported
from. The same files give the same wheel.
"""

import base64
import hashlib
import re
import sys
import zipfile
from pathlib import Path


def entry(name: str, mode: int) -> zipfile.ZipInfo:
    """A member with a fixed date and these permissions."""
    info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    info.compress_type = zipfile.ZIP_DEFLATED
    info.external_attr = (0o100000 | mode) << 16
    return info


def members(root: Path, package: Path, data: str) -> "list[tuple[str, int, bytes]]":
    """The files of the wheel but its own records: name, permissions, content."""
    found = []
    for path in sorted(root.rglob("*")):
        inner = path.relative_to(root)
        if not path.is_file():
            continue
        if inner.parts[0] == "bin":
            found.append((f"{data}/scripts/{inner.relative_to('bin')}", 0o755, path.read_bytes()))
        else:
            found.append((f"{data}/data/{inner}", 0o644, path.read_bytes()))
    for path in sorted(package.rglob("*")):
        inner = path.relative_to(package.parent)
        if path.is_file() and "__pycache__" not in inner.parts:
            found.append((str(inner), 0o644, path.read_bytes()))
    return found


def main() -> None:
    root, name, version, summary, platform, readme, package, out = sys.argv[1:]
    description = Path(readme).read_text(encoding="utf-8")
    relative = re.findall(r"\]\((?!https?:|#)[^)]*\)", description)
    if relative:
        sys.exit(f"wheel.py: {readme} links to files: {' '.join(relative)}")
    tag = f"py3-none-{platform}"
    info = f"{name}-{version}.dist-info"
    metadata = (
        f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\nSummary: {summary}\nLicense: MIT OR Apache-2.0\n"
        "Requires-Python: >=3.8\nRequires-Dist: numpy\nDescription-Content-Type: text/markdown\n\n" + description
    )
    wheel_text = f"Wheel-Version: 1.0\nGenerator: specula\nRoot-Is-Purelib: false\nTag: {tag}\n"
    content = members(Path(root), Path(package), f"{name}-{version}.data")
    content += [(f"{info}/METADATA", 0o644, metadata.encode()), (f"{info}/WHEEL", 0o644, wheel_text.encode())]
    record = ""
    Path(out).mkdir(parents=True, exist_ok=True)
    file = Path(out) / f"{name}-{version}-{tag}.whl"
    with zipfile.ZipFile(file, "w", compresslevel=9) as wheel:
        for member, mode, data in content:
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record += f"{member},sha256={digest},{len(data)}\n"
            wheel.writestr(entry(member, mode), data)
        wheel.writestr(entry(f"{info}/RECORD", 0o644), record + f"{info}/RECORD,,\n")
    print(file)


main()
