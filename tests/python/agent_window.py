"""An agent in a window: `specula mcp --socket` works on the picture that the user sees, and only where a window listens.

The arguments are the name of the socket, and whether the agent is allowed there.
"""

import asyncio
import sys
from pathlib import Path

from agent import call, picture_of, refused, server, text_of
from mcp import Client

NDF = "brdf/ndf.glsl"
LINE = "float a2 = alpha * alpha;"


async def works(client):
    async def draw(name):
        Path(f"{name}.png").write_bytes(picture_of(await call(client, "render")))

    await draw("first")
    changed = text_of(await call(client, "set", values={"view.ev": 2}))
    assert "view.ev:" in changed and "-> 2" in changed, changed
    await draw("brighter")
    # The tree is that of the window. A wrong text stays in the file, and the window keeps its picture.
    await refused(client, "edit_shader", "undeclared identifier", file=NDF, old=LINE, new="float a2 = aplha;")
    await draw("kept")
    edited = text_of(await call(client, "edit_shader", file=NDF, old="float a2 = aplha;", new="float a2 = alpha;"))
    assert f"Wrote {Path('shaders').absolute()}/{NDF}" in edited, edited
    await draw("edited")
    await refused(client, "render", "--out-folder", save="a.png")


async def is_refused(client):
    for tool, arguments in (
        ("render", {}),
        ("set", {"values": {"view.ev": 4}}),
        ("read_shader", {"file": NDF}),
        ("edit_shader", {"file": NDF, "old": LINE, "new": "float a2 = alpha;"}),
    ):
        await refused(client, tool, "no window listens", **arguments)


async def main():
    name, is_allowed = sys.argv[1:]
    async with Client(server("--socket", name)) as client:
        await (works(client) if is_allowed == "allowed" else is_refused(client))


if __name__ == "__main__":
    asyncio.run(main())
