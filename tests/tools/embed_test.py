"""The library in another project: examples/embed built against an installed Percale and with
Percale as a subdirectory gives the same numbers."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLE = os.path.join(ROOT, "examples", "embed")
BUILD = os.environ["PERCALE_BUILD"]
CMAKE = os.environ["PERCALE_CMAKE"]
CXX = os.environ["PERCALE_CXX"]


class Embed(unittest.TestCase):
    def setUp(self):
        # A space in the path, since other people's paths have them.
        self.folder = os.path.join(tempfile.mkdtemp(), "another project")
        os.mkdir(self.folder)
        self.addCleanup(shutil.rmtree, os.path.dirname(self.folder))

    def call(self, *command, **options):
        done = subprocess.run(command, capture_output=True, text=True, cwd=self.folder, **options)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout

    def build(self, name, *settings):
        """Copies the example out of the project, builds it there, and returns the program."""
        source = os.path.join(self.folder, name)
        shutil.copytree(EXAMPLE, source)
        build = os.path.join(source, "build")
        # -O0, also for the kernels, which are optimised fully in any type but Debug, and several files as one: a quarter
        # of the time it takes to compile the library; the results are the same to the bit.
        self.call(CMAKE, "-S", source, "-B", build, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={CXX}",
                  "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -DNDEBUG",
                  f"-DCMAKE_CXX_COMPILER_LAUNCHER={shutil.which('ccache') or ''}", "-DPERCALE_UNITY=ON", *settings)
        self.call(CMAKE, "--build", build)
        return os.path.join(build, "embed")

    def test_installed_and_as_a_subdirectory(self):
        prefix = os.path.join(self.folder, "prefix")
        self.call(CMAKE, "--install", BUILD, "--prefix", prefix)
        # Moved after the installation: nothing in it may name where it was.
        moved = os.path.join(self.folder, "moved")
        os.rename(prefix, moved)
        exported = [os.path.join(folder, file) for folder, _, files in os.walk(moved) for file in files
                    if file.endswith(".cmake")]
        self.assertTrue(exported)
        for file in exported:
            with open(file, encoding="utf-8") as text:
                self.assertNotIn(ROOT, text.read(), file)

        scene = os.path.join(ROOT, "scene", "pinned2.json")
        program = self.build("installed", f"-DCMAKE_PREFIX_PATH={moved}")
        installed = self.call(program, scene)
        self.assertEqual(os.listdir(os.path.join(moved, "include")), ["percale"])
        subdirectory = self.call(self.build("subdirectory", f"-DPERCALE_SOURCES={ROOT}"), scene)
        self.assertEqual(installed, subdirectory)
        match = re.fullmatch(r"lowest point after 1\.0 s: (\S+) m\n", installed)
        self.assertTrue(match, installed)
        # After one second the free edge has swung down from y = 1 and cannot be below the pins by
        # more than the sheet's length and Provot's tenth.
        self.assertLess(float(match.group(1)), 0.9)
        self.assertGreater(float(match.group(1)), -0.2)

        # A scene that is not there is explained, not crashed on.
        done = subprocess.run([program, "nowhere.json"], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, 3)
        self.assertIn("nowhere.json", done.stderr)

        # A user of the library asks for neither the program nor the tests.
        targets = self.call(CMAKE, "--build", os.path.join(self.folder, "subdirectory", "build"), "--target", "help")
        self.assertNotIn("percale_program", targets)
        self.assertNotIn("percale_test_main", targets)

    def test_the_example_stays_short(self):
        for file in ["main.cpp", "CMakeLists.txt"]:
            with open(os.path.join(EXAMPLE, file), encoding="utf-8") as text:
                self.assertLess(len(text.readlines()), 30, file)


if __name__ == "__main__":
    unittest.main()
