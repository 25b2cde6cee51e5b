"""`specula mcp` with the official client: an agent that looks, edits, measures and must stay where it may write."""

import asyncio
import base64
import os
import subprocess
import time
from pathlib import Path

from mcp import Client, MCPError, StdioServerParameters

SIZE = "96x54"
SHAPE = (96).to_bytes(4, "big") + (54).to_bytes(4, "big")


RUNTIME = Path("runtime").absolute()


def server(*arguments):
    # The client hands on few variables; the others choose the device.
    env = {**os.environ, "XDG_RUNTIME_DIR": str(RUNTIME)}
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
    await call(client, "camera", view="front")
    await call(client, "open", environment="none")
    await refused(client, "open", "no such", model="nonsense")


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
    assert "compile" in text_of(await call(client, "check"))
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


async def main():
    here = Path.cwd()
    # Other commands take ./shaders by themselves; an agent must be given it.
    tree, out = here / "shaders", here / "out"
    assert os.spawnl(os.P_WAIT, os.environ["SPECULA"], "specula", "new", str(tree)) == 0
    steps = [
        ("looks", looks, ()), ("edits", edits, (tree,)), ("measures", measures, (out,)), ("cancels", cancels, ()),
    ]  # fmt: skip
    RUNTIME.mkdir(mode=0o700)
    start = server("sphere-grid", "--shaders", str(tree), "--out-folder", str(out), "--size", SIZE, "--env", "none")
    async with Client(start) as client:
        assert client.server_info.name == "specula" and client.protocol_version in ("2025-06-18", "2025-11-25")
        for name, step, arguments in steps:
            begun = time.monotonic()
            await step(client, *arguments)
            print(f"{name}: {time.monotonic() - begun:.2f} s", flush=True)
    # Without a tree and a folder.
    async with Client(server("sphere-grid", "--size", SIZE, "--env", "none")) as client:
        await refused(client, "render", "--out-folder", save="a.png")
        edited = await call(client, "edit_shader", file="brdf/ndf.glsl", old="a2 = alpha * alpha;", new="a2 = alpha;")
        assert "in memory" in text_of(edited), text_of(edited)
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
