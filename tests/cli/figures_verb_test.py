"""percale figures as a verb: parts of the whole, what is kept, and what goes wrong. The whole is in figures_test.py."""

import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

from picture_test import read_png
from program import PERCALE, ROOT, SANITIZED, ProgramTest


class SomeFigures(ProgramTest):
    def figures(self, *arguments, **options):
        return self.run_program("figures", "-r", ROOT, "--size", "64x50", *arguments, **options)

    def copy_root(self):
        """What the program reads, for a test to change."""
        for name in ("shaders", "textures", "scene"):
            shutil.copytree(ROOT / name, self.folder / name)

    def test_only(self):
        done = self.figures("--only", "1,3-4,37")
        self.assertIn("4 of 49 figures", done.stdout)
        self.assertEqual([f for f in self.files() if f.endswith(".png")],
                         [f"figures/figure_{n:02}.png" for n in (1, 3, 4, 37)])
        page = (self.folder / "figures/index.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("<figure"), 4)
        # What is there from before stays on the page, unless it is of another size.
        self.assertIn("5 of 49 figures, 1 of them drawn now", self.figures("--only", "40").stdout)
        self.assertIn("1 of 49 figures, 1 of them drawn now", self.figures("--only", "45", "--size", "32x25").stdout)

    def test_the_number_of_threads_makes_no_difference(self):
        for threads in (1, 3):
            self.figures("--only", "2,8,23,29", "--threads", threads, "-o", f"with {threads}")
        for name in ("index.html", "figures.json", "figure_23.png", "figure_29.png"):
            self.assertEqual((self.folder / "with 1" / name).read_bytes(), (self.folder / "with 3" / name).read_bytes())

    def test_short_runs_end(self):
        for k in range(2 if SANITIZED else 5):  # one thread may be done before another starts
            self.figures("--only", "1-3", "--size", "8x8", "--threads", 8, "-o", k)

    def test_a_changed_shader_is_noticed(self):
        self.copy_root()
        only = ("figures", "-r", ".", "--size", "64x50", "--only", "1", "-o", "out")
        self.run_program(*only)
        self.assertIn("0 of them drawn now", self.run_program(*only).stdout)
        shader = self.folder / "shaders/Wireframe.frag"
        shader.write_text(shader.read_text() + "// changed\n")
        self.assertIn("1 of them drawn now", self.run_program(*only).stdout)

    @unittest.skipIf(SANITIZED, "a minute's simulation, and pictures like those of other tests")
    def test_kept_shader_values_are_not_used(self):
        self.copy_root()
        only = ("figures", "-r", ".", "--size", "64x50", "--only", "48", "-o", "out")
        self.run_program(*only)
        self.write("shaders/Flag.json", {"u_bands": 3})
        self.assertIn("0 of them drawn now", self.run_program(*only).stdout)
        command = json.loads((self.folder / "out/figures.json").read_text())["figures"][0]["command"]
        subprocess.run([os.path.abspath(PERCALE), *shlex.split(command)[1:], "-r", "."], cwd=self.folder, check=True,
                       env=self.environment, stdout=subprocess.PIPE)
        self.assertEqual(read_png(self.folder / "figure_48.png")[:3], read_png(self.folder / "out/figure_48.png")[:3])

    @unittest.skipUnless(sys.platform.startswith("linux"), "needs programs that run with bytes appended")
    def test_a_changed_program_is_noticed(self):
        program = self.folder / "percale"
        shutil.copy(PERCALE, program)

        def drawn():
            done = subprocess.run([program, "figures", "-r", ROOT, "--size", "8x8", "--only", "8", "-o", "out"],
                                  cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr)
            table = self.folder / "out/measured/pinned2_cloth.density_0.csv"
            return "1 of them drawn now" in done.stdout, table.read_text().splitlines()[0]

        first, key = drawn()
        self.assertTrue(first)
        self.assertEqual(drawn(), (False, key))
        with program.open("ab") as file:
            file.write(b"another build")
        again, other = drawn()
        self.assertTrue(again)
        self.assertNotEqual(other, key)

    def test_divergence_is_told(self):
        self.copy_root()
        for name in ("pinned2", "selfCollision"):
            file = self.folder / f"scene/{name}.json"
            scene = json.loads(file.read_text())
            scene.setdefault("simulation", {})["steps_per_frame"] = 1
            file.write_text(json.dumps(scene))
        for k in range(1 if SANITIZED else 5):  # whichever simulation is the first to say so
            done = self.run_program("figures", "-r", ".", "--size", "8x8", "-o", k, code=4)
            self.assertRegex(done.stderr, "the simulation of .* diverged: ")
            self.assertIn("of 49 figures", done.stdout)

    def test_unwritable(self):
        self.write("file", "")
        for output in ("file", "file/below"):
            self.assertIn("file", self.figures("--only", "1", "-o", output, code=1).stderr)
        self.assertEqual(self.files(), ["file"])

    def test_a_broken_scene_leaves_no_folder(self):
        self.copy_root()
        self.write("scene/plane.json", "{")
        self.assertIn("plane.json:1:2", self.run_program("figures", "-r", ".", "--only", "1", "-o", "out", code=3).stderr)
        self.assertFalse((self.folder / "out").exists())

    @unittest.skipIf(os.name == "nt", "POSIX signals")
    def test_interrupt_keeps_what_was_done(self):
        process = subprocess.Popen([os.path.abspath(PERCALE), "figures", "-r", str(ROOT), "--size", "64x50", "--threads",
                                    "1", "--only", "1-23", "-o", "out", "--progress", "json"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.environment, text=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
        deadline = time.monotonic() + 120
        while not list(self.folder.glob("out/figure_*.png")) and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, out + err)
        self.assertIn("interrupted", err)
        kept = len(list(self.folder.glob("out/figure_*.png")))
        self.assertGreater(kept, 0)
        self.assertIn(f"{kept} of 49 figures", out)
        self.assertEqual([f for f in self.files() if "tmp" in f], [])


if __name__ == "__main__":
    unittest.main()
