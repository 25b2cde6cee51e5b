"""Writes a wheel with the program and its share folder: python3 wheel.py ROOT NAME VERSION SUMMARY PLATFORM README OUT_FOLDER.

ROOT holds bin/ and share/. pip puts them into bin and share of a virtual environment, or of ~/.local. The same files give the same wheel.
"""

import base64
import hashlib
import sys
import zipfile
from pathlib import Path


def entry(name: str, mode: int) -> zipfile.ZipInfo:
    """A member with a fixed date and these permissions."""
    info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    info.compress_type = zipfile.ZIP_DEFLATED
    info.external_attr = (0o100000 | mode) << 16
    return info


def main() -> None:
    root, name, version, summary, platform, readme, out = sys.argv[1:]
    tag = f"py3-none-{platform}"
    info = f"{name}-{version}.dist-info"
    data = f"{name}-{version}.data"
    metadata = (
        f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\nSummary: {summary}\nLicense: MIT OR Apache-2.0\n"
        "Requires-Python: >=3.7\nDescription-Content-Type: text/markdown\n\n" + Path(readme).read_text(encoding="utf-8")
    )
    members = [(f"{info}/METADATA", 0o644, metadata.encode())]
    members.append((f"{info}/WHEEL", 0o644, f"Wheel-Version: 1.0\nGenerator: specula\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()))
    for path in sorted(Path(root).rglob("*")):
        inner = path.relative_to(root)
        if not path.is_file():
            continue
        if inner.parts[0] == "bin":
            members.append((f"{data}/scripts/{inner.relative_to('bin')}", 0o755, path.read_bytes()))
        else:
            members.append((f"{data}/data/{inner}", 0o644, path.read_bytes()))
    record = ""
    Path(out).mkdir(parents=True, exist_ok=True)
    file = Path(out) / f"{name}-{version}-{tag}.whl"
    with zipfile.ZipFile(file, "w", compresslevel=9) as wheel:
        for member, mode, content in members:
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record += f"{member},sha256={digest},{len(content)}\n"
            wheel.writestr(entry(member, mode), content)
        wheel.writestr(entry(f"{info}/RECORD", 0o644), record + f"{info}/RECORD,,\n")
    print(file)


main()
