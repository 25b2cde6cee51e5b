"""Prints how quick a window is: previews a second while the mouse turns the model, the time from the last movement to the whole picture, and
the time from a save to its picture.

python3 tests/python/window_bench.py PROGRAM [ARGUMENT...]: needs Xvfb and xdotool. The window has 1280x720 pixels, panels included.
"""

import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

SIZE = (1280, 720)
DRAGS, SAVES = 5, 8
# Between two movements, seconds
PAUSE_S = 0.016
LINE = "float a2 = alpha * alpha;"


class Window:
    """The program in a window of its own, driven by JSON lines and the mouse."""

    def __init__(self, program, model, folder, display):
        self.environment = {**os.environ, "DISPLAY": display, "HOME": folder, "XDG_STATE_HOME": f"{folder}/state"}
        for name in ("WAYLAND_DISPLAY", "WAYLAND_SOCKET"):
            self.environment.pop(name, None)
        self.process = subprocess.Popen(
            [program, "view", *model, "--shaders", f"{folder}/shaders", "--events", "json", "--size", "{}x{}".format(*SIZE)],
            env=self.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.asked = 0
        self.event("ready")

    def event(self, *names):
        """The next event with one of these names."""
        for line in self.process.stdout:
            event = json.loads(line)
            if event["event"] in names:
                return event
        raise SystemExit(f"the window ended before {names}")

    def do(self, command, **fields):
        """Sends a command, and waits until it is done."""
        self.asked += 1
        print(json.dumps({"id": self.asked, "command": command, **fields}), file=self.process.stdin, flush=True)
        answer = self.event("done", "error")
        while answer.get("id") != self.asked:
            answer = self.event("done", "error")
        return answer

    def mouse(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True)

    def drag(self, seconds):
        """Turns the model by the mouse, and returns the event of the previews."""
        x, y = 600, 330
        self.mouse("mousemove", x, y, "mousedown", 1)
        steps = []
        for step in range(int(seconds / PAUSE_S)):
            at = step * PAUSE_S
            steps += ["mousemove", int(x + 80 * math.sin(2 * at)), int(y + 30 * math.sin(3 * at)), "sleep", PAUSE_S]
        # One process: a process for each movement would take the time of the device.
        self.mouse(*steps)
        self.mouse("mouseup", 1)
        return self.event("previews")

    def save(self, file, text):
        """Saves a text, and returns the milliseconds until its picture is on screen."""
        start = time.perf_counter()
        file.write_text(text)
        event = self.event("reload", "diagnostic")
        assert event["event"] == "reload" and event["ok"], event
        passed = (time.perf_counter() - start) * 1e3
        self.event("settled")
        return passed


def main():
    program, model = sys.argv[1], sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "new", f"{folder}/shaders"], check=True, capture_output=True)
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", "1", "-screen", "0", "{}x{}x24".format(*SIZE), "-nolisten", "tcp"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        try:
            window = Window(program, model, folder, f":{server.stdout.readline().strip()}")
            # Done once the final picture is on screen
            window.do("set", values={"view.ev": 0})
            drags = [window.drag(4.0) for _ in range(DRAGS)]
            rates = [(drag["shown"] - 1) / drag["ms"] * 1e3 for drag in drags]
            print(f"previews a second while dragging  {min(rates):6.1f} to {max(rates):.1f}, at {drags[-1]['size']}")
            print(f"last preview to the whole picture {statistics.median(drag['whole_ms'] for drag in drags):6.0f} ms (median)")
            ndf = pathlib.Path(folder, "shaders/brdf/ndf.glsl")
            text = ndf.read_text()
            assert LINE in text, LINE
            saves = [window.save(ndf, text.replace(LINE, f"float a2 = alpha * (alpha + {n}e-4);")) for n in range(1, SAVES + 1)]
            print(f"save to its picture              {statistics.median(saves):6.0f} ms (median)")
            window.do("quit")
            window.process.wait()
        finally:
            server.kill()
            server.wait()


main()
