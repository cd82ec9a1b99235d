"""Drives the real program: shared by the tests of the command line."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PERCALE = os.environ.get("PERCALE", "build/dev/bin/percale")
# Under a sanitizer, which is slow, what is done again and again is done less often: tests/sanitized.h.
SANITIZED = os.environ.get("PERCALE_SANITIZED") == "1"
ROOT = pathlib.Path(__file__).resolve().parents[2]


def cloth(points=10, **changes):
    """A cloth of points x points, hung up by two corners, with the course's values."""
    values = {
        "width": 1, "height": 1, "num_width_points": points, "num_height_points": points, "thickness": 0.0095,
        "orientation": 0, "pinned": [[0, 0], [points - 1, 0]], "enable_structural": True, "enable_shearing": True,
        "enable_bending": True, "damping": 0.2, "density": 150, "ks": 5000,
    }
    values.update(changes)
    return values


class ProgramTest(unittest.TestCase):
    """Each test runs in an empty folder of its own."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="percale test é "))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        # A user's own presets are not to change what is tested.
        self.environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.environment["PERCALE_CONFIG_DIR"] = str(self.folder / "config")

    def run_program(self, *arguments, code=0, environment=None, stdout=subprocess.PIPE):
        """Runs percale and checks its exit code; returns what it printed."""
        if arguments and arguments[0] in ("shot", "render") and "--help" not in arguments:
            # What a viewer has kept of shaders in this checkout is not to count.
            arguments = (*arguments, "--shader-defaults")
        done = subprocess.run([os.path.abspath(PERCALE), *map(str, arguments)], cwd=self.folder, stdout=stdout,
                              stderr=subprocess.PIPE, env={**self.environment, **(environment or {})}, timeout=300)
        done.stdout = (done.stdout or b"").decode("utf-8")
        done.stderr = done.stderr.decode("utf-8")
        self.assertEqual(done.returncode, code, f"percale {' '.join(map(str, arguments))}\n{done.stdout}\n{done.stderr}")
        return done

    def write(self, name, content):
        """A file in the test's folder; what is not text is written as JSON."""
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content, indent=1), encoding="utf-8")
        return path

    def scene(self, name="scene.json", points=10, **changes):
        return self.write(name, {"cloth": cloth(points, **changes)})

    def files(self):
        """Everything in the test's folder, hidden files included."""
        return sorted(str(p.relative_to(self.folder)) for p in self.folder.rglob("*"))

    def summary(self, done):
        """The lines of simulate's summary as a dictionary."""
        lines = {}
        for line in done.stdout.splitlines():
            if len(line) > 18 and line[0] != " ":
                lines.setdefault(line[:18].strip(), line[18:].strip())
        return lines
