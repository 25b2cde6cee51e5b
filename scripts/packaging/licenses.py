"""Prints the licenses of all that the program links: python3 licenses.py METADATA.json [FOLDER...].

METADATA.json is the output of `cargo metadata`; the folders hold further libraries, such as that of a C++ compiler. Texts that are equal
are printed once. Fails if a package names no license and has none.
"""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path

LICENSE_FILE = re.compile(r"(licen[cs]e|copying|notice|unlicense|copyright|ofl|ufl)([-_.].*)?$|.*[-_.]licen[cs]e(\.\w+)?$", re.IGNORECASE)
# Sources, and folders of packages that are not linked.
NO_LICENSE = re.compile(r"\.(rs|py|h|c|cc|cpp|cmake|yml|json)$", re.IGNORECASE)
NOT_LINKED = {"test", "tests", "examples", "benches", ".git", "node_modules"}


def linked_packages(metadata: dict) -> list[dict]:
    """The root package's normal dependencies, direct and indirect, without procedural macros."""
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    root = metadata["resolve"]["root"]
    found, pending = set(), [root]
    while pending:
        for dependency in nodes[pending.pop()]["deps"]:
            package = packages[dependency["pkg"]]
            is_normal = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            is_macro = any("proc-macro" in target["kind"] for target in package["targets"])
            if is_normal and not is_macro and package["id"] not in found:
                found.add(package["id"])
                pending.append(package["id"])
    return sorted((packages[id] for id in found), key=lambda package: (package["name"], package["version"]))


def license_files(folder: Path) -> list[Path]:
    """Files with the text of a license in a folder and those below it: C libraries come with their own."""
    found = []
    for path in folder.rglob("*"):
        inner = path.relative_to(folder)
        if NOT_LINKED.isdisjoint(inner.parts[:-1]) and LICENSE_FILE.match(path.name) and not NO_LICENSE.search(path.name):
            if path.is_file():
                found.append(path)
    return sorted(found)


def main() -> None:
    packages = linked_packages(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")))
    owners: dict[str, list[str]] = defaultdict(list)
    print("Specula links these libraries. Their licenses follow.\n")
    for package in packages:
        license, files = package["license"], license_files(Path(package["manifest_path"]).parent)
        if not license and not files:
            sys.exit(f"licenses.py: {package['name']} {package['version']} has no license")
        name = f"{package['name']} {package['version']}"
        print(f"{name}: {license or 'see its text'}")
        for path in files:
            owners[path.read_text(encoding="utf-8", errors="replace").strip()].append(name)
    for folder in map(Path, sys.argv[2:]):
        for path in license_files(folder):
            owners[path.read_text(encoding="utf-8", errors="replace").strip()].append(folder.name)
    for text, names in owners.items():
        print("\n" + "=" * 100 + "\n" + ", ".join(dict.fromkeys(names)) + "\n" + "-" * 100 + "\n\n" + text)


main()
