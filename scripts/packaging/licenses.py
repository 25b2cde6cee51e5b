"""Prints the licenses of all that the program links: python3 licenses.py METADATA.json [FOLDER...].

METADATA.json is the output of `cargo metadata`; the folders hold further libraries, such as that of a C++ compiler. Texts that are equal
are printed once. A package whose archive lacks the text of its license gets the standard one, with the package's authors as holders. Fails
if a package or a folder ends without a text.
"""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path

HERE = Path(__file__).resolve().parent
LICENSE_FILE = re.compile(r"(licen[cs]e|copying|notice|unlicense|copyright|ofl|ufl)([-_.].*)?$|.*[-_.]licen[cs]e(\.\w+)?$", re.IGNORECASE)
# Sources, and folders of packages that are not linked.
NO_LICENSE = re.compile(r"\.(rs|py|h|c|cc|cfg|cpp|cmake|sh|yml|json)$|license-checker", re.IGNORECASE)
NOT_LINKED = {"test", "tests", "examples", "benches", ".git", "node_modules"}
# By the identifiers of SPDX: a phrase of each license's text, in lower case, with single spaces.
PHRASES = {
    "0BSD": "permission to use, copy, modify, and/or distribute this software for any purpose with or without fee",
    "Apache-2.0": "apache license",
    "BSD-2-Clause": "redistribution and use in source and binary forms",
    "BSD-3-Clause": "to endorse or promote products derived from",
    "BSL-1.0": "boost software license",
    "CC0-1.0": "cc0 1.0 universal",
    "ISC": "permission to use, copy, modify, and/or distribute this software for any purpose with or without fee",
    "MIT": "to any person obtaining a copy of this software",
    "OFL-1.1": "sil open font license",
    "Ubuntu-font-1.0": "ubuntu font licence",
    "Unicode-3.0": "unicode license v3",
    "Unlicense": "this is free and unencumbered software",
    "Zlib": "this software is provided 'as-is'",
}
# The standard texts, best first. The first names no holders; the others say HOLDERS where these belong.
STANDARD = {
    "Apache-2.0": HERE.parents[1] / "LICENSE-APACHE",
    "MIT": HERE / "licenses/MIT.txt",
    "BSD-2-Clause": HERE / "licenses/BSD-2-Clause.txt",
    "BSD-3-Clause": HERE / "licenses/BSD-3-Clause.txt",
    "Zlib": HERE / "licenses/Zlib.txt",
}
# Holders of what a package took from elsewhere, under a license of its own.
HOLDERS = {
    ("bevy_mikktspace", "Zlib"): "2011 Morten S. Mikkelsen",
    ("nv-flip-sys", "BSD-3-Clause"): "2020-2022 NVIDIA CORPORATION & AFFILIATES",
}


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


def texts_in(folder: Path) -> list[str]:
    return [path.read_text(encoding="utf-8", errors="replace").strip() for path in license_files(folder)]


def required(expression: str) -> list[list[str]]:
    """The licenses of an SPDX expression: a text of each list is needed, and any of a list will do."""
    groups = [group.strip() for group in expression.replace("/", " OR ").split(" AND ")]
    for group in groups:
        if len(groups) > 1 and " OR " in group and not (group.startswith("(") and group.endswith(")")):
            sys.exit(f"licenses.py: cannot read the license `{expression}`")
    # An exception allows more than the license does.
    return [[name.split(" WITH ")[0].strip() for name in group.strip("()").split(" OR ")] for group in groups]


def standard_text(package: dict, names: list[str]) -> str:
    """The standard text of the first of these licenses that has one, for this package."""
    name = next((name for name in STANDARD if name in names), None)
    if name is None:
        sys.exit(f"licenses.py: {package['name']} {package['version']} has no text of its license, {' or '.join(names)}")
    authors = ", ".join(re.sub(r"\s*<.*?>", "", author) for author in package["authors"])
    holders = HOLDERS.get((package["name"], name)) or authors or f"The authors of {package['name']}"
    return STANDARD[name].read_text(encoding="utf-8").replace("HOLDERS", holders, 1).strip()


def texts_of(package: dict) -> list[str]:
    """The texts that come with a package, and standard ones for the licenses of which it has none."""
    texts = texts_in(Path(package["manifest_path"]).parent)
    if not package["license"] and not texts:
        sys.exit(f"licenses.py: {package['name']} {package['version']} has no license")
    plain = " ".join(" ".join(texts).lower().split())
    for names in required(package["license"]) if package["license"] else []:
        if not any(name in PHRASES and PHRASES[name] in plain for name in names):
            texts.append(standard_text(package, names))
    return texts


def main() -> None:
    sys.stdout.reconfigure(encoding="utf-8")
    owners: dict[str, list[str]] = defaultdict(list)
    print("Specula links these libraries. Their licenses follow.\n")
    for package in linked_packages(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))):
        name = f"{package['name']} {package['version']}"
        print(f"{name}: {package['license'] or 'see its text'}")
        for text in texts_of(package):
            owners[text].append(name)
    for folder in map(Path, sys.argv[2:]):
        texts = texts_in(folder)
        if not texts:
            sys.exit(f"licenses.py: {folder} has no license")
        for text in texts:
            owners[text].append(folder.name)
    for text, names in owners.items():
        print("\n" + "=" * 100 + "\n" + ", ".join(dict.fromkeys(names)) + "\n" + "-" * 100 + "\n\n" + text)


main()
