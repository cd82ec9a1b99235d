"""Every command line of the README and of docs/ runs as it stands there, but for a long film or run to rest, which is
cut short."""

import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PERCALE = os.environ["PERCALE"]
VERBS = {"simulate", "shot", "render", "figures", "check", "verify", "info", "doctor"}


def commands():
    """(file, arguments) of each indented line that calls the program, apart from those that open a window."""
    for file in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        for line in file.read_text(encoding="utf-8").splitlines():
            match = re.match(r"    (?:\./run|percale) (.+)", line)
            if match:
                arguments = shlex.split(match.group(1), comments=True)
                if arguments and arguments[0] in VERBS:
                    yield file.name, arguments


SHORT = "0.2"  # of a film or a simulation [s]


def shortened(arguments):
    """The same command for a short while, where as it stands it takes more than some seconds."""
    words = list(arguments)
    if words[0] in ("simulate", "render") and "--until-rest" in words:
        at = words.index("--until-rest")
        words[at:at + 1] = ["--seconds", SHORT]
    if words[0] == "render" and "--seconds" in words:
        words[words.index("--seconds") + 1] = SHORT
    return words


class Docs(unittest.TestCase):
    def test_commands(self):
        found = list(commands())
        self.assertGreaterEqual(len(found), 6)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("presets", "scene", "shaders", "textures"):
                os.symlink(ROOT / name, pathlib.Path(folder) / name)
            for file, arguments in found:
                with self.subTest(file=file, command=" ".join(arguments)):
                    done = subprocess.run([PERCALE, *shortened(arguments)], cwd=folder, capture_output=True, text=True, timeout=600)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    if "-o" in arguments:
                        output = arguments[arguments.index("-o") + 1]
                        self.assertTrue((pathlib.Path(folder) / output).exists(), output)

    def test_files_that_are_named_exist(self):
        for file in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
            for target in re.findall(r"\]\(([^)#:]+)\)", file.read_text(encoding="utf-8")):
                with self.subTest(file=file.name, target=target):
                    self.assertTrue((file.parent / target).exists())


if __name__ == "__main__":
    unittest.main()
