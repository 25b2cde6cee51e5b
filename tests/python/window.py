"""A session with a window, on the display of the test: it draws what a session without one draws, but for the dither of a window."""

import subprocess
import sys

import numpy
from endings import children, wait_for_end

import specula

# Python ends as a notebook's kernel does that is started again.
KILLED = """
import os, signal
import specula
session = specula.Session("sphere-grid", env="none", window=True)
print(session._channel.pid, flush=True)
input()
os.kill(os.getpid(), signal.SIGKILL)
"""


def differ(a, b):
    """By how many of 255 steps two pictures differ at most."""
    return int(numpy.abs(a.astype(int) - b.astype(int)).max())


with specula.Session("sphere-grid", env="none", size=(96, 64)) as session:
    expected = session.render()
    session.set("view.ev", 2.0)
    brighter = session.render()
assert differ(expected, brighter) > 20

with specula.Session("sphere-grid", env="none", window=True) as session:
    session.set("passes.ground", False)
    assert differ(session.render(size=(96, 64)), expected) <= 2
    session.set("view.ev", 2.0)
    assert differ(session.render(size=(96, 64)), brighter) <= 2
    assert session.render().shape == (360, 640, 4)
    try:
        session.set("view.evv", 1)
    except specula.CommandError as error:
        assert "view.ev" in str(error), error
    else:
        raise AssertionError("a setting that does not exist is set")

with subprocess.Popen([sys.executable, "-c", KILLED], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as killed:
    process = int(killed.stdout.readline())
    processes = [process, *children(process)]
    assert len(processes) == 2, processes
    killed.stdin.close()
    wait_for_end("Python was killed", processes)
