"""However a session ends, it leaves no process and no file."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import specula
from specula._channel import _channels
from specula._scratch import Scratch

PATIENCE_S = 60
MEMORY = Path("/dev/shm")

# The interpreter ends with a session that draws at that moment. It prints the process first.
SCRIPT = """
import os, signal, sys, threading
import specula
session = specula.Session("sphere-grid", env="none", size=(64, 36))
session.render()
print(session._channel.pid, flush=True)
if sys.argv[1] == "kill":
    threading.Thread(target=session.turntable, kwargs={"frames": 2000}, daemon=True).start()
    while not session._channel._pending:
        pass
    os.kill(os.getpid(), signal.SIGKILL)
if sys.argv[1] == "raise":
    raise RuntimeError("an error of the user")
"""


def is_there(process):
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def children(process):
    return Path(f"/proc/{process}/task/{process}/children").read_text().split()


def wait_for_end(what, processes):
    end = time.monotonic() + PATIENCE_S
    while any(is_there(process) for process in processes):
        assert time.monotonic() < end, f"{what}: a process is left"
        time.sleep(0.01)


def joins():
    """Another program's session is joined by its socket, and goes on after this one."""
    socket = Path("private/s.sock").absolute()
    socket.parent.mkdir(mode=0o700)
    command = [os.environ["SPECULA"], "serve", "sphere-grid", "--env", "none", "--size", "64x36", "--socket", str(socket)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        assert '"listening"' in server.stdout.readline()
        files = open_files()
        for _ in range(2):
            with specula.Session(window=str(socket)) as session:
                before = session.render()
                assert before.shape == (36, 64, 4)
                session["view.ev"] = session["view.ev"] + 1
                assert (session.render() != before).any()
                folder = session._scratch._folder
            assert not folder.exists() and server.poll() is None
            assert open_files() == files and threading.active_count() == 1, (files, open_files(), threading.enumerate())
        server.stdin.close()
        assert server.wait(PATIENCE_S) == 0
    try:
        specula.Session(window=str(socket))
    except specula.ProcessError as error:
        assert "no window listens" in str(error), error
    else:
        raise AssertionError("a window that is closed was joined")


def open_files():
    return len(os.listdir("/proc/self/fd"))


def gives_back_files_and_threads():
    """Starts that fail, and sessions that end."""
    Path("no-program").write_text("x")
    os.chmod("no-program", 0o755)
    for number in range(3):
        if number == 1:
            before = open_files()
        for options, part in (({"program": "./no-program"}, "could not be started"), ({"options": ["--ev", "x"]}, "--ev")):
            try:
                specula.Session("sphere-grid", **options)
            except specula.ProcessError as error:
                assert part in str(error), error
            else:
                raise AssertionError(f"a session with {options}")
        with specula.Session("sphere-grid", env="none", size=(32, 18)) as session:
            assert session.render().shape == session.diff(session.render(), session.render()).map.shape
    assert open_files() == before, f"{before} open files became {open_files()}"
    assert [thread.name for thread in threading.enumerate()] == ["MainThread"]


def ends_with_its_program():
    """A program that is killed takes the process that draws with it."""
    session = specula.Session("sphere-grid", env="none", size=(64, 36))
    session.render()
    processes = [session._channel.pid, *children(session._channel.pid)]
    assert len(processes) == 2, processes
    os.kill(processes[0], signal.SIGKILL)
    wait_for_end("the program was killed", processes)
    session.close()


def is_interrupted():
    """Ctrl+C while a session starts, and while it ends."""
    for moment in ("start", "end"):
        seen = set()

        def interrupt():
            end = time.monotonic() + PATIENCE_S
            while time.monotonic() < end:
                seen.update(process for process in children(os.getpid()) if is_there(process))
                if seen and (moment == "start" or any(channel._is_closed for channel in list(_channels))):
                    break
            os.kill(os.getpid(), signal.SIGINT)

        before, thread = open_files(), threading.Thread(target=interrupt)
        gc.collect()
        thread.start()
        try:
            specula.Session("sphere-grid", env="none", size=(64, 36)).close()
            thread.join()
        except KeyboardInterrupt:
            thread.join()
        else:
            raise AssertionError(f"{moment}: the call was not interrupted")
        wait_for_end(f"Ctrl+C at the {moment}", seen)
        end = time.monotonic() + PATIENCE_S
        while open_files() > before or threading.active_count() > 1:
            assert time.monotonic() < end, f"{moment}: {open_files()} open files of {before}, {threading.enumerate()}"
            time.sleep(0.01)


def main():
    joins()
    gives_back_files_and_threads()
    ends_with_its_program()
    is_interrupted()
    # Wrong options: what the program says.
    try:
        specula.Session("sphere-grid", options=["--tonemap", "nonsense"])
    except specula.ProcessError as error:
        assert error.code == 2 and "nonsense" in str(error), error
    else:
        raise AssertionError("a wrong option was taken")
    # A file that is no model: no picture, until another one is opened.
    Path("bad.glb").write_text("x")
    with specula.Session("bad.glb", env="none", size=(64, 36)) as session:
        try:
            session.render()
        except specula.CommandError as error:
            assert "bad.glb" in str(error) and "glTF" in str(error), error
        else:
            raise AssertionError("a picture without its model was drawn")
        session.open(model="sphere-grid")
        assert session.render()[..., 3].max() == 255
    try:
        specula.Session(program="/nowhere/specula")
    except specula.ProgramNotFound as error:
        assert "/nowhere/specula" in str(error)

    with specula.Session("sphere-grid", env="none", size=(64, 36)) as session:
        processes = [session._channel.pid, *children(session._channel.pid)]
        session.turntable(".gif", frames=2, size=(16, 9))
        folder = session._scratch._folder
        forked = os.fork()
        if forked == 0:
            # The other process has no part in it, and does not keep it alive.
            try:
                session.render()
            except specula.ProcessError:
                session.close()
                os._exit(0)
            os._exit(1)
        assert os.waitpid(forked, 0)[1] == 0 and folder.exists()
        assert session.render().shape == (36, 64, 4)
    assert not any(is_there(process) for process in processes) and not folder.exists()

    session = specula.Session("sphere-grid", env="none", size=(64, 36))
    processes = [session._channel.pid, *children(session._channel.pid)]
    del session
    gc.collect()
    assert not any(is_there(process) for process in processes), "garbage is collected, and the program runs on"

    for way, code in (("raise", 1), ("kill", -signal.SIGKILL)):
        ended = subprocess.Popen([sys.executable, "-c", SCRIPT, way], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        process = int(ended.stdout.readline())
        below = children(process) if is_there(process) else []
        assert ended.wait(PATIENCE_S) == code, (way, ended.returncode)
        wait_for_end(way, [process, *below])
    # The killed one could not remove its folder, which the next session does. Other sessions may have theirs.
    own = Scratch()
    own.path(".gif")
    for folder in MEMORY.glob("specula-py-*"):
        owners = [path for path in Path("/proc").glob("[0-9]*/fd/*") if leads_to(path, folder)]
        assert owners or not folder.exists(), f"{folder} is left"
    own.remove()


def leads_to(path, folder):
    try:
        return os.readlink(path).startswith(f"{folder}/")
    except OSError:
        return False


if __name__ == "__main__":
    main()
