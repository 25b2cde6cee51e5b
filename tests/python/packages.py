"""The scripts of scripts/packaging.

Each package that is linked has the text of each license that binds it, or nothing is packed; the description of the wheel needs no file beside it.
"""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

REPOSITORY = Path(os.environ["REPOSITORY"])
PACKAGING = REPOSITORY / "scripts/packaging"
OWN_TEXT = "Permission is hereby granted, free of charge, to any\nperson obtaining a copy of this software: its own text"


def run(metadata, *folders):
    path = Path("metadata.json")
    path.write_text(metadata, encoding="utf-8")
    return subprocess.run([sys.executable, PACKAGING / "licenses.py", path, *folders], capture_output=True, text=True, encoding="utf-8", check=False)


def package(name, license, authors=(), files=(), kind=None, target="lib"):
    """A package with these files, on which the root depends in this way."""
    folder = Path(name)
    folder.mkdir(exist_ok=True)
    for file, text in files:
        (folder / file).write_text(text, encoding="utf-8")
    fields = {"id": name, "name": name, "version": "1.0.0", "license": license, "authors": list(authors)}
    return {**fields, "manifest_path": str(folder / "Cargo.toml"), "targets": [{"kind": [target]}]}, kind


def made(*packages):
    root, _ = package("root", "MIT")
    edges = [{"pkg": package["id"], "dep_kinds": [{"kind": kind}]} for package, kind in packages]
    nodes = [{"id": "root", "deps": edges}] + [{"id": package["id"], "deps": []} for package, _ in packages]
    return json.dumps({"packages": [root, *(package for package, _ in packages)], "resolve": {"root": "root", "nodes": nodes}})


def sections(text):
    """The texts, by the packages that they name."""
    found = {}
    for part in text.split("=" * 100)[1:]:
        names, body = part.split("-" * 100)
        found.setdefault(names.strip(), []).append(body.strip())
    return found


def standard_texts_replace_missing_ones():
    ended = run(made(
        package("own", "MIT/Apache-2.0", files=[("LICENSE-MIT", OWN_TEXT)]),
        package("mit", "MIT", ["Ada Lovelace <ada@example.org>", "Alan Turing"]),
        package("either", "MIT OR Apache-2.0", ["Ada Lovelace"]),
        package("both", "(MIT OR Zlib) AND BSD-3-Clause", files=[("LICENSE", OWN_TEXT + " of both")]),
        package("nobody", "BSD-2-Clause"),
        package("derive", "Secret-1.0", target="proc-macro"),
        package("tests-only", "Secret-1.0", kind="dev"),
    ))  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    found = sections(ended.stdout)
    assert found["own 1.0.0"] == [OWN_TEXT]
    (mit,) = found["mit 1.0.0"]
    assert "Copyright (c) Ada Lovelace, Alan Turing\n" in mit and "Permission is hereby granted" in mit and "example.org" not in mit
    # The text of Apache's license names no holders, so nothing has to be guessed.
    (either,) = found["either 1.0.0"]
    assert either == (REPOSITORY / "LICENSE-APACHE").read_text(encoding="utf-8").strip()
    own, other = found["both 1.0.0"]
    assert own == OWN_TEXT + " of both" and "BSD 3-Clause" in other and "Neither the name" in other
    (nobody,) = found["nobody 1.0.0"]
    assert "Copyright (c) The authors of nobody. All rights reserved." in nobody
    assert "Secret" not in ended.stdout


def what_has_no_text_is_an_error():
    for license, files in (("Secret-1.0", []), (None, []), ("MIT AND Secret-1.0", [("LICENSE", OWN_TEXT)])):
        ended = run(made(package("strange", license, files=files)))
        assert ended.returncode == 1 and "strange 1.0.0 has no " in ended.stderr, (license, ended.stderr)
    Path("library").mkdir()
    ended = run(made(), "library")
    assert ended.returncode == 1 and "library has no license" in ended.stderr, ended.stderr
    Path("library/LICENSE.TXT").write_text("of a library", encoding="utf-8")
    ended = run(made(), "library")
    assert ended.returncode == 0 and sections(ended.stdout) == {"library": ["of a library"]}, ended.stdout


def all_that_specula_links_has_a_text():
    cargo = [os.environ.get("CARGO", "cargo"), "metadata", "--locked", "--offline", "--format-version", "1"]
    host = subprocess.run(["rustc", "-vV"], capture_output=True, text=True, check=True).stdout.split("host: ")[1].split()[0]
    metadata = subprocess.run([*cargo, "--filter-platform", host], cwd=REPOSITORY, capture_output=True, text=True, check=True).stdout
    ended = run(metadata)
    assert ended.returncode == 0, ended.stderr
    listed, *_ = ended.stdout.split("=" * 100)
    names = {line.split(": ")[0] for line in listed.splitlines() if ": " in line}
    with_text = {name for owners in sections(ended.stdout) for name in owners.split(", ")}
    assert len(names) > 200 and names == with_text, names ^ with_text
    for part in ("Copyright (c) 2020-2022 NVIDIA", "2011 Morten S. Mikkelsen", "Copyright (c) Ralf Biedert", "The Khronos Group"):
        assert part.lower() in ended.stdout.lower(), part


def the_description_of_the_wheel_needs_no_file():
    Path("usr/bin").mkdir(parents=True)
    Path("usr/bin/specula").write_bytes(b"program")

    def wheel(readme):
        names = ["usr", "specula", "0.1.0", "Test", "linux_x86_64", REPOSITORY / readme, REPOSITORY / "assets/python/specula", "out"]
        return subprocess.run([sys.executable, PACKAGING / "wheel.py", *names], capture_output=True, text=True, check=False)

    refused = wheel("README.md")
    assert refused.returncode == 1 and "(assets/manual/python.md)" in refused.stderr, refused.stderr
    assert not Path("out").exists()
    made = wheel("assets/python/README.md")
    assert made.returncode == 0, made.stderr
    with zipfile.ZipFile(made.stdout.strip()) as file:
        fields, description = file.read("specula-0.1.0.dist-info/METADATA").decode().split("\n\n", 1)
    assert "Requires-Python: >=3.8" in fields.splitlines()
    assert description == (REPOSITORY / "assets/python/README.md").read_text(encoding="utf-8")


standard_texts_replace_missing_ones()
what_has_no_text_is_an_error()
all_that_specula_links_has_a_text()
the_description_of_the_wheel_needs_no_file()
