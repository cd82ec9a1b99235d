"""Drives the viewer under a display of its own: keys and mouse by xdotool, what came of them from
the session log (apps/viewer/session_log.h). Everything is waited for with a deadline; nothing
relies on how fast the machine is."""

import ctypes
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PERCALE = os.path.abspath(os.environ.get("PERCALE", os.path.join(ROOT, "build/dev/bin/percale")))
PATIENCE = 60  # seconds


def wait_for(what, probe, patience=PATIENCE):
    """Calls `probe` until it returns something true, and returns that."""
    deadline = time.monotonic() + patience
    while True:
        found = probe()
        if found:
            return found
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {patience} s for {what}")
        time.sleep(0.02)


def load_x11():
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XInternAtom.restype = ctypes.c_ulong
    x11.XDefaultRootWindow.restype = ctypes.c_ulong
    return x11


class Display:
    """A display that no one else uses."""

    def __init__(self, size="1280x1000"):
        read_end, write_end = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", size + "x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[write_end], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise RuntimeError("Xvfb did not start")
        self.name = ":" + number

    def set_resources(self, text):
        """What xrdb does: settings of the desktop, such as its density."""
        x11 = load_x11()
        display = ctypes.c_void_p(x11.XOpenDisplay(self.name.encode()))
        resource_manager, string, replace = 23, 31, 0
        data = text.encode()
        x11.XChangeProperty(display, ctypes.c_ulong(x11.XDefaultRootWindow(display)), ctypes.c_ulong(resource_manager),
                            ctypes.c_ulong(string), 8, replace, data, len(data))
        x11.XCloseDisplay(display)

    def close(self):
        self.process.terminate()
        self.process.wait()


class Viewer:
    """One run of the program. Use it in a with block; `events` holds the log so far."""

    def __init__(self, display, *arguments, environment=None, cwd=None):
        self.folder = tempfile.mkdtemp(prefix="percale-viewer-")
        self.log = os.path.join(self.folder, "session.log")
        # What the viewer keeps for the next start is no business of the user who runs the tests.
        self.environment = {**os.environ, "DISPLAY": display.name,
                            "PERCALE_CONFIG_DIR": os.path.join(self.folder, "config"), **(environment or {})}
        self.environment.pop("WAYLAND_DISPLAY", None)
        self.errors = open(os.path.join(self.folder, "stderr"), "w+", encoding="utf-8", errors="replace")
        root = [] if "-r" in arguments else ["-r", ROOT]
        # In the checkout nothing is to be kept, and nothing that was kept there is to count.
        root += ["--shader-defaults"] if root else []
        self.process = subprocess.Popen([PERCALE, "view", *arguments, *root, "--log", self.log], env=self.environment,
                                        cwd=cwd or self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=self.errors)
        self.events = []
        self.read = 0
        self.rest = ""
        self.first = "panel Parameters"  # a control of the first picture

    def __enter__(self):
        try:
            self.start = self.wait("start")
            # The first picture: from then on the window takes input.
            self.wait("widget", name=self.first)
            self.window = wait_for("the window", lambda: self.xdotool(
                "search", "--onlyvisible", "--pid", str(self.process.pid), "--name", "Percale", check=False).split())[0]
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.errors.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    # What came of it.

    def update(self):
        if os.path.exists(self.log):
            with open(self.log, encoding="utf-8") as file:
                file.seek(self.read)
                self.rest += file.read()
                self.read = file.tell()
        *lines, self.rest = self.rest.split("\n")
        self.events += [json.loads(line) for line in lines]

    def find(self, kind, since=0, where=None, **facts):
        """The first event after number `since` with these facts, or None."""
        for event in self.events[since:]:
            if event["event"] != kind or any(event.get(key) != value for key, value in facts.items()):
                continue
            if where is None or where(event):
                return event
        return None

    def wait(self, kind, since=0, where=None, patience=PATIENCE, **facts):
        def probe():
            self.update()
            found = self.find(kind, since, where, **facts)
            if not found and self.process.poll() is not None:
                self.update()
                found = self.find(kind, since, where, **facts)
                if not found:
                    raise AssertionError(f"the viewer ended with {self.process.returncode} while waiting for "
                                         f"{kind} {facts}: {self.stderr()}")
            return found
        try:
            return wait_for(f"{kind} {facts}", probe, patience)
        except AssertionError as error:
            raise AssertionError(f"{error}; last events {self.events[-5:]}; stderr: {self.stderr()}") from None

    def mark(self):
        """The number of the next event, for `since`."""
        self.update()
        return len(self.events)

    def count(self, kind, since=0, **facts):
        self.update()
        return sum(1 for event in self.events[since:]
                   if event["event"] == kind and all(event.get(key) == value for key, value in facts.items()))

    def state(self):
        """The newest state."""
        self.update()
        return next(event for event in reversed(self.events) if event["event"] == "state")

    def stderr(self):
        with open(self.errors.name, encoding="utf-8", errors="replace") as file:
            return file.read()

    def ended(self):
        """Waits for the end; returns the exit code."""
        try:
            code = self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            raise AssertionError("the viewer does not end") from None
        self.update()
        return code

    # What is done.

    def xdotool(self, *arguments, check=True):
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, capture_output=True, text=True)
        if check and done.returncode != 0:
            raise AssertionError(f"xdotool {arguments}: {done.stderr}")
        return done.stdout

    def title(self):
        return self.xdotool("getwindowname", self.window).strip()

    def key(self, key, action):
        """Presses a key and waits until the viewer has taken it; returns the number of that event."""
        since = self.mark()
        self.xdotool("key", "--clearmodifiers", key)
        self.wait("action", since, name=action)
        return since

    def choose(self, query, command):
        """Opens the palette, types, and waits until that command is the selected one."""
        since = self.mark()
        self.xdotool("key", "ctrl+k")
        self.wait("palette", since, visible=True)
        self.wait_for_active("palette query")
        self.xdotool("type", "--delay", "15", "--", query)
        return self.wait("palette", since, query=query, selected=command)

    def step(self):
        """One frame; returns the state after it."""
        since = self.key("n", "step")
        command = self.wait("step", since)["command"]
        done = self.wait("done", since, command=command)
        return self.wait("state", self.events.index(done))

    def settle(self):
        """Waits until every command sent so far has been carried out, and the state after it is told."""
        def probe():
            self.update()
            sent = max((event.get("command", 0) for event in self.events if event["event"] != "done"), default=0)
            done = max((event["command"] for event in self.events if event["event"] == "done"), default=0)
            newest = next((event["event"] for event in reversed(self.events) if event["event"] in ("done", "state")), None)
            return done >= sent and newest != "done"
        wait_for("the simulation", probe)

    def box(self, name):
        """Where a control is now."""
        def probe():
            self.update()
            for event in reversed(self.events):
                if event["event"] == "widget" and event["name"] == name:
                    return event if event["width"] > 0 else None
            return None
        return wait_for(f"control {name!r}", probe)

    def point(self, x, y):
        self.xdotool("mousemove", "--window", self.window, round(x), round(y))

    def point_at(self, name, share=0.5):
        box = self.box(name)
        self.point(box["x"] + share * box["width"], box["y"] + box["height"] / 2)

    def now(self, event):
        """The control that the newest event of that kind names: that has the pointer ("hover"), or is in use ("active")."""
        self.update()
        return next((line["name"] for line in reversed(self.events) if line["event"] == event), "")

    def click(self, name):
        """Clicks on a control once the pointer is seen to be over it: what changes elsewhere may still move it."""
        pointed = None
        def probe():
            nonlocal pointed
            box = self.box(name)
            if box is not pointed:
                pointed = box
                self.point_at(name)
            return self.now("hover") == name
        try:
            wait_for(f"the pointer to be over {name!r}", probe)
        except AssertionError as error:
            raise AssertionError(f"{error}; it is over {self.now('hover')!r}; box {pointed}") from None
        self.xdotool("click", 1)

    def wait_for_active(self, name):
        """Waits until that control is held down, edited, or takes what is typed."""
        wait_for(f"{name!r} to be in use", lambda: self.now("active") == name)

    def type_into(self, name, text):
        self.click(name)
        self.wait_for_active(name)
        self.xdotool("type", "--delay", "60", "--", text)

    def type_number(self, name, text):
        """Types into the box beside a slider, and waits until it has been taken or refused."""
        self.type_into(name + " box", text)
        since = self.mark()
        # Enter counts for the box only if it is down while a picture is made.
        self.xdotool("keydown", "Return")
        try:
            def probe():
                self.update()
                return any(event["event"] in ("set", "message") for event in self.events[since:])
            wait_for(f"{name} to take {text!r}", probe)
        finally:
            self.xdotool("keyup", "Return")

    def drop(self, path):
        """What a file manager does when a file is dropped on the window (the XDND protocol)."""
        subprocess.run([sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "drop.py"),
                        self.window, path], env=self.environment, check=True, timeout=PATIENCE)

    def close_window(self):
        """What a window manager sends when the user closes the window."""
        x11 = load_x11()

        class ClientMessage(ctypes.Structure):
            _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                        ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong),
                        ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("padding", ctypes.c_long * 24)]

        display = ctypes.c_void_p(x11.XOpenDisplay(self.environment["DISPLAY"].encode()))
        protocols = x11.XInternAtom(display, b"WM_PROTOCOLS", 0)
        close = x11.XInternAtom(display, b"WM_DELETE_WINDOW", 0)
        event = ClientMessage(type=33, window=int(self.window), message_type=protocols, format=32)
        event.data[0] = close
        x11.XSendEvent(display, ctypes.c_ulong(int(self.window)), 0, ctypes.c_long(0), ctypes.byref(event))
        x11.XFlush(display)
        x11.XCloseDisplay(display)


def state_hash(scene, frames, *arguments):
    """The fingerprint of the state after so many frames, without a window."""
    done = subprocess.run([PERCALE, "simulate", scene, "--frames", str(frames), "--progress", "none", *arguments],
                          capture_output=True, text=True, check=True)
    return re.search(r"^state\s+([0-9a-f]{16})$", done.stdout, re.MULTILINE).group(1)


def scene(name):
    return os.path.join(ROOT, "scene", name + ".json")


class ViewerTest(unittest.TestCase):
    """Tests with a display."""

    @classmethod
    def setUpClass(cls):
        cls.display = Display()

    @classmethod
    def tearDownClass(cls):
        cls.display.close()

    def viewer(self, *arguments, **options):
        return Viewer(self.display, *arguments, **options)
