"""`specula mcp` with the official client: an agent that looks, edits, measures and must stay where it may write."""

import asyncio
import base64
import json
import os
import re
import subprocess
import time
from pathlib import Path

from mcp import Client, MCPError, StdioServerParameters

SIZE = "96x54"
SHAPE = (96).to_bytes(4, "big") + (54).to_bytes(4, "big")


RUNTIME = Path("runtime").absolute()
HOME = Path("home").absolute()
# Where a program may keep files without being asked to.
FOLDERS = ("SPECULA_CACHE", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME", "MESA_SHADER_CACHE_DIR")


def server(*arguments):
    # The client hands on few variables; the others choose the device.
    env = {name: value for name, value in os.environ.items() if name not in FOLDERS}
    env.update(XDG_RUNTIME_DIR=str(RUNTIME), HOME=str(HOME))
    return StdioServerParameters(command=os.environ["SPECULA"], args=["mcp", *arguments], env=env)


def text_of(result):
    return "\n".join(content.text for content in result.content if content.type == "text")


def picture_of(result):
    (image,) = [content for content in result.content if content.type == "image"]
    assert image.mime_type == "image/png"
    data = base64.b64decode(image.data)
    assert data.startswith(b"\x89PNG"), data[:8]
    return data


async def call(client, name, **arguments):
    result = await client.call_tool(name, arguments)
    assert not result.is_error, text_of(result)
    return result


async def drawn(client):
    """The number of a new picture."""
    return int(re.match(r"Picture (\d+): ", text_of(await call(client, "render")))[1])


async def is_equal(client, a, b):
    told = text_of(await call(client, "diff", a=a, b=b))
    assert ("are equal" in told) != ("mean FLIP" in told), told
    return "are equal" in told


async def camera(client, **arguments):
    """Position, target and field of view after a call."""
    told = text_of(await call(client, "camera", **arguments))
    number = r"(-?[\d.e-]+)"
    point = rf"\[{number},{number},{number}\] m"
    found = re.fullmatch(rf"The camera is at {point}, looks at {point}, with a vertical field of view of {number} degrees\.", told)
    assert found, told
    values = [float(value) for value in found.groups()]
    return values[:3], values[3:6], values[6]


async def refused(client, name, part, **arguments):
    result = await client.call_tool(name, arguments)
    assert result.is_error and part in text_of(result), (name, arguments, text_of(result))


async def looks(client):
    tools = {tool.name: tool for tool in (await client.list_tools()).tools}
    expected = "open set settings read_shader edit_shader check render probe trace furnace diff modes camera"
    assert set(tools) == set(expected.split()), tools.keys()
    assert tools["probe"].annotations.read_only_hint and tools["edit_shader"].annotations.destructive_hint
    first = await call(client, "render")
    assert picture_of(first)[16:24] == SHAPE and text_of(first) == "Picture 1: 96 x 54 pixels", text_of(first)
    changed = await call(client, "set", values={"view.ev": 2, "material": {"enabled": True}})
    assert "view.ev: 0.7 -> 2" in text_of(changed), text_of(changed)
    assert picture_of(await call(client, "render")) != picture_of(first)
    difference = await call(client, "diff", a=1, b=2)
    assert "mean FLIP" in text_of(difference) and picture_of(difference)
    assert "equal" in text_of(await call(client, "diff", a=1, b=1))
    await call(client, "set", values={"view.ev": 0.7, "material.enabled": False})
    await refused(client, "set", "view.ev", values={"view.evv": 1})
    assert "view.tonemap = " in text_of(await call(client, "settings", find="tonemap"))
    assert "d: Normal distribution D" in text_of(await call(client, "modes", find="ndf"))
    await opens(client)
    await moves(client)


async def opens(client):
    before = await drawn(client)
    for kind, other, own in [("environment", "furnace", "none"), ("model", "metal-grid", "sphere-grid")]:
        assert text_of(await call(client, "open", **{kind: other})) == f"Opened {kind} {other}."
        assert not await is_equal(client, before, await drawn(client)), kind
        assert text_of(await call(client, "open", **{kind: own})) == f"Opened {kind} {own}."
        assert await is_equal(client, before, await drawn(client)), kind
    await refused(client, "open", "no such", model="nonsense")
    assert await is_equal(client, before, await drawn(client))


def is_near(a, b):
    """Whether two cameras are the same but for rounding."""
    pairs = zip([*a[0], *a[1], a[2]], [*b[0], *b[1], b[2]])
    return all(abs(x - y) <= 1e-4 * max(1.0, abs(y)) for x, y in pairs)


async def moves(client):
    before = await drawn(client)
    _, _, fovy = await camera(client)
    eye, target, _ = await camera(client, view="front")
    assert abs(eye[0] - target[0]) < 1e-4 and abs(eye[1] - target[1]) < 1e-4 and eye[2] > target[2] + 0.1, (eye, target)
    front = await drawn(client)
    assert not await is_equal(client, before, front)
    placed = ([0.5, 1.25, 4.0], [0.0, 0.25, 0.0], 30.0)
    for found in (await camera(client, eye=placed[0], target=placed[1], fovy=placed[2]), await camera(client)):
        assert is_near(found, placed), found
    assert not await is_equal(client, front, await drawn(client))
    await camera(client, fovy=fovy)
    found = await camera(client, view="front")
    assert is_near(found, (eye, target, fovy)), found


async def edits(client, tree):
    ndf = "brdf/ndf.glsl"
    assert "float a2 = alpha * alpha;" in text_of(await call(client, "read_shader", file=ndf))
    assert ndf in text_of(await call(client, "read_shader"))
    line = text_of(await call(client, "read_shader", file=ndf, first=20, last=20))
    assert line.strip() == "float a2 = alpha * alpha;", line
    await refused(client, "edit_shader", "^^^^^", file=ndf, old="alpha * alpha", new="aplha * alpha")
    broken = await client.call_tool("edit_shader", {"file": ndf, "old": "aplha * alpha", "new": "aplha"})
    assert broken.is_error and "The picture stays" in text_of(broken) and "undeclared identifier" in text_of(broken)
    assert picture_of(await call(client, "render")), "the last good picture is gone"
    good = text_of(await call(client, "edit_shader", file=ndf, old="a2 = aplha;", new="a2 = alpha;"))
    assert f"Wrote {tree}/{ndf}" in good and "+    float a2 = alpha;" in good, good
    assert "float a2 = alpha;" in (tree / ndf).read_text(encoding="utf-8")
    assert text_of(await call(client, "check")) == "All files compile, without warnings."
    await checks_picture(client)
    await call(client, "edit_shader", file=ndf, old="a2 = alpha;", new="a2 = alpha * alpha;")
    # Edits at the same time keep each other; the whole of a file is written only over what the agent has seen.
    lines = [{"file": ndf, "old": "#endif", "new": f"// {n}\n#endif"} for n in range(3)]
    await asyncio.gather(*(call(client, "edit_shader", **line) for line in lines))
    text = (tree / ndf).read_text(encoding="utf-8")
    assert all(f"// {n}\n" in text for n in range(3)), text
    (tree / ndf).write_text(text + "// of the user\n", encoding="utf-8")
    await refused(client, "edit_shader", "read it again", file=ndf, text="// of the agent\n")
    await call(client, "read_shader", file=ndf)
    await call(client, "edit_shader", file=ndf, text=text)
    await call(client, "read_shader", file=ndf, first=2**63, last=2**64 - 1)
    # Where an agent may not write.
    outside = tree.parent / "outside.glsl"
    (tree / "link.glsl").symlink_to(outside)
    (tree / "linked").symlink_to(tree.parent)
    for file in ("../outside.glsl", str(outside), "link.glsl", "linked/outside.glsl", ".git/hooks.glsl", "Makefile"):
        result = await client.call_tool("edit_shader", {"file": file, "text": "// mine"})
        assert result.is_error, file
    assert not outside.exists() and not (tree / "Makefile").exists()
    resources = (await client.list_resources()).resources
    assert any(str(resource.uri) == f"specula://shaders/{ndf}" for resource in resources)
    (content,) = (await client.read_resource(f"specula://shaders/{ndf}")).contents
    assert "d_ggx" in content.text
    try:
        await client.read_resource("specula://shaders/none.glsl")
    except MCPError:
        pass
    else:
        raise AssertionError("a file that is not there was read")


async def checks_picture(client):
    """A check of the picture lists what fails in it."""
    chosen = text_of(await call(client, "settings", find="view.checks"))
    hook = "void user_surface(inout Surface s, Fragment f, vec3 v) {"
    wrong = '\n    assert(s.roughness > 2.0, "is rough");\n    float root = sqrt(-1.0 - s.roughness);'
    await call(client, "edit_shader", file="user.glsl", old=hook, new=hook + wrong)
    _, assertions = text_of(await call(client, "check", assertions=True)).split("\n", 1)
    (line,) = assertions.splitlines()
    assert re.search(r"user\.glsl:\d+: .*is rough.* \(\d+ times, first at \[\d+,\d+\]\)$", line), line
    _, undefined = text_of(await call(client, "check", undefined=True)).split("\n", 1)
    assert "is rough" in undefined and "sqrt" in undefined and "sqrt" not in assertions, undefined
    assert text_of(await call(client, "settings", find="view.checks")) == chosen
    await call(client, "edit_shader", file="user.glsl", old=hook + wrong, new=hook)
    told = text_of(await call(client, "check", assertions=True, undefined=True))
    assert told == "All files compile, without warnings.\nNo check of the picture failed.", told


async def measures(client, out):
    assert "albedo min" in text_of(await call(client, "furnace"))
    assert "pixel 48 27 of 96 x 54" in text_of(await call(client, "probe", x=48, y=27, modes=["d"]))
    assert "a2 =" in text_of(await call(client, "trace", x=60, y=30, file="brdf/ndf.glsl"))
    await refused(client, "probe", "outside", x=960, y=27, modes=["d"])
    saved = text_of(await call(client, "render", mode="d", save="a/d.exr"))
    assert f"Wrote {out}/a/d.exr" in saved and (out / "a/d.exr").stat().st_size > 0, saved
    await refused(client, "render", "stays as it is", mode="d", save="a/d.exr")
    await call(client, "render", save="final.png")
    assert "equal" in text_of(await call(client, "diff", a="final.png", b="final.png"))
    await refused(client, "open", ".toml", look=str(out / "final.png"))
    elsewhere = out.parent / "elsewhere.png"
    (out / "link.png").symlink_to(elsewhere)
    for name in ("../elsewhere.png", str(elsewhere), "link.png", "b/a.txt"):
        result = await client.call_tool("render", {"save": name})
        assert result.is_error, name
    assert not elsewhere.exists() and not (out / "b").exists()
    await refused(client, "edit_shader", "bytes", file="long.glsl", text="//" + 5_000_000 * "x")


async def cancels(client):
    """A call that takes long is given up, and the next one is answered."""
    try:
        await client.call_tool("render", {"mode": "paths", "size": [2048, 2048]}, read_timeout_seconds=0.2)
    except MCPError:
        pass
    else:
        raise AssertionError("the call was faster than this test expects")
    assert picture_of(await call(client, "render"))


WAVE = """#include "shape.glsl"
void main() {
    gl_FragColor = vec4(level(), 0.5, 0.0, 1.0);
}
"""


async def single_file(here):
    """A single file is the tree, with what it includes. Others in its folder stay as they are."""
    folder = here / "toy"
    folder.mkdir()
    texts = {"wave.fs": WAVE, "shape.glsl": "float level() { return 0.25; }\n", "other.glsl": "float other = 1.0;\n"}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    async with Client(server("--shaders", str(folder / "wave.fs"), "--size", SIZE)) as client:
        tree, *files = text_of(await call(client, "read_shader")).splitlines()
        assert tree == f"Shader tree: {folder}/wave.fs" and files[0] == "opened/wave.fs", files
        assert "opened/shape.glsl" in files and "opened/other.glsl" not in files, files
        pictures = [await drawn(client)]
        for name, old, new in [("wave.fs", "0.5", "0.75"), ("shape.glsl", "0.25", "0.5")]:
            told = text_of(await call(client, "edit_shader", file=f"opened/{name}", old=old, new=new))
            assert told.startswith(f"Wrote {folder}/{name}:\n") and "the picture shows it" in told, told
            texts[name] = texts[name].replace(old, new)
            pictures.append(await drawn(client))
            assert not await is_equal(client, *pictures[-2:]), name
        broken = await client.call_tool("edit_shader", {"file": "opened/wave.fs", "old": "level()", "new": "levle()"})
        assert broken.is_error and f"{folder}/wave.fs:3:" in text_of(broken), text_of(broken)
        await call(client, "edit_shader", file="opened/wave.fs", old="levle()", new="level()")
        await call(client, "read_shader", file="opened/other.glsl")
        await refused(client, "edit_shader", "does not belong to the shader tree", file="opened/other.glsl", text="// mine\n")
        await refused(client, "edit_shader", "single file", file="toy.glsl", text="// mine\n")
        await refused(client, "edit_shader", "out of its folder", file="opened/../outside.glsl", text="// mine\n")
        texts["new.glsl"] = "float added() { return 1.0; }\n"
        made = text_of(await call(client, "edit_shader", file="opened/new.glsl", text=texts["new.glsl"].replace("1.0", "0.0")))
        assert made.startswith(f"Made {folder}/new.glsl."), made
        await call(client, "edit_shader", file="opened/new.glsl", old="0.0", new="1.0")
    assert {path.name: path.read_text(encoding="utf-8") for path in folder.iterdir()} == texts


async def configured(here):
    """The start that the manual shows to clients, in a folder with a tree."""
    manual = (Path(os.environ["REPOSITORY"]) / "assets/manual/agents.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```json\n(.*?)```", manual, re.DOTALL)
    start = json.loads(block)["mcpServers"]["specula"]
    assert start["command"] == "specula" and start["args"][0] == "mcp", start
    async with Client(server(*start["args"][1:])) as client:
        tree = Path(text_of(await call(client, "read_shader")).splitlines()[0].removeprefix("Shader tree: "))
        assert tree.resolve() == here / "shaders", tree
        saved = text_of(await call(client, "render", size=[96, 54], save="seen.png"))
        assert f"Wrote {here}/pictures/seen.png" in saved and (here / "pictures/seen.png").exists(), saved


def files_below(folder):
    found = (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


async def main():
    here = Path.cwd()
    # Other commands take ./shaders by themselves; an agent must be given it.
    tree, out = here / "shaders", here / "out"
    assert os.spawnl(os.P_WAIT, os.environ["SPECULA"], "specula", "new", str(tree)) == 0
    steps = [
        ("looks", looks, ()), ("edits", edits, (tree,)), ("measures", measures, (out,)), ("cancels", cancels, ()),
    ]  # fmt: skip
    RUNTIME.mkdir(mode=0o700)
    HOME.mkdir()
    before = files_below(here)
    start = server("sphere-grid", "--shaders", str(tree), "--out-folder", str(out), "--size", SIZE, "--env", "none")
    async with Client(start) as client:
        assert client.server_info.name == "specula" and client.protocol_version in ("2025-06-18", "2025-11-25")
        for name, step, arguments in steps:
            begun = time.monotonic()
            await step(client, *arguments)
            print(f"{name}: {time.monotonic() - begun:.2f} s", flush=True)
    after = files_below(here)
    changed = {name for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
    cached = {name.split("/")[2] for name in changed if name.startswith("home/.cache/")}
    assert "specula" in cached and cached <= {"specula", "mesa_shader_cache", "mesa_shader_cache_db"}, cached
    written = {name for name in changed if not name.startswith("home/.cache/")}
    assert written == {"shaders/brdf/ndf.glsl", "out/a/d.exr", "out/final.png"}, written
    await single_file(here)
    await configured(here)
    # Without a tree and a folder.
    async with Client(server("sphere-grid", "--size", SIZE, "--env", "none")) as client:
        await refused(client, "render", "--out-folder", save="a.png")
        edited = await call(client, "edit_shader", file="brdf/ndf.glsl", old="a2 = alpha * alpha;", new="a2 = alpha;")
        assert "stay in the memory of the program" in text_of(edited), text_of(edited)
        assert "stay in the memory of the program" in text_of(await call(client, "read_shader")).splitlines()[0]
    # A session that somebody else has started, by its socket.
    socket = RUNTIME / "specula.sock"
    command = [os.environ["SPECULA"], "serve", "sphere-grid", "--env", "none", "--size", SIZE, "--socket", str(socket)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as joined:
        assert '"listening"' in joined.stdout.readline()
        async with Client(server("--socket", str(socket))) as client:
            assert picture_of(await call(client, "render"))[16:24] == SHAPE
            await call(client, "set", values={"view.ev": 2})
        joined.stdin.write('{"id": 1, "command": "get", "path": "view.ev"}\n')
        joined.stdin.close()
        answers = [line for line in joined.stdout if '"id":1' in line]
        assert len(answers) == 1 and '"result":2' in answers[0], answers
    left = [path for path in RUNTIME.rglob("*") if path.is_file() or "mcp" in path.name]
    assert not left, left


if __name__ == "__main__":
    asyncio.run(main())
