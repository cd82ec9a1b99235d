"""percale verify as a verb: the table, the report, exit codes and what goes wrong."""

import json
import os
import signal
import subprocess
import sys
import time
import unittest

from program import PERCALE, SANITIZED, ProgramTest

FAST = "hanging_sheet,patch,momentum,decay"


class Verify(ProgramTest):
    def test_table_and_report(self):
        done = self.run_program("verify", "--only", FAST)
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0].split(), ["case", "quantity", "measured", "expected", "error", "gate", "verdict"])
        names = [line.split()[0] for line in lines if line and not line.startswith(" ")]
        for name in ("Membrane", "hanging_sheet", "patch", "Time", "momentum", "decay"):
            self.assertIn(name, names)
        self.assertNotIn("Bending", names)
        row = next(line for line in lines if line.startswith("hanging_sheet"))
        self.assertRegex(row, r"0\.0028\d+ +0\.00281897 +[-+]0\.\d+ % +1 % +holds$")
        self.assertIn("8 of 8 quantities within their gates", done.stdout)
        self.assertEqual(done.stderr, "")
        self.assertEqual(self.files(), ["verify", "verify/verify.html"])
        page = (self.folder / "verify/verify.html").read_text(encoding="utf-8")
        for text in ("<!DOCTYPE html>", 'id="patch"', "percale verify --only decay", "8 of 8 quantities"):
            self.assertIn(text, page)
        self.assertNotRegex(page, r"(src|href)=\"(?!#|data:)")  # needs no other file

    def test_json(self):
        done = self.run_program("verify", "--only", FAST, "--json", "-o", "a/b")
        data = json.loads(done.stdout)
        self.assertEqual([case["name"] for case in data["cases"]], FAST.split(","))
        self.assertEqual((data["readings"], data["holding"]), (8, 8))
        sheet = data["cases"][0]["readings"][0]
        self.assertAlmostEqual(sheet["expected"], 0.15 * 9.81 / (2 * 261), places=9)
        self.assertTrue(sheet["low"] <= sheet["measured"] <= sheet["high"] and sheet["holds"])
        self.assertTrue((self.folder / "a/b/verify.html").exists())

    def test_the_number_of_threads_makes_no_difference(self):
        tables = [self.run_program("verify", "--only", FAST, "--json", "--threads", n).stdout for n in (1, 3)]
        self.assertEqual(*tables)

    @unittest.skipIf(SANITIZED, "the same cases, only finer")
    def test_fine(self):
        done = self.run_program("verify", "--only", "hanging_sheet,self_buckling,pendulum", "--fine")
        self.assertIn("4 of 4 quantities", done.stdout)
        page = (self.folder / "verify/verify.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("<svg"), 2)
        self.assertIn("Error by elements along an edge", page)
        self.assertIn("Error by steps per second", page)

    @unittest.skipIf(SANITIZED, "twenty seconds for a plot")
    def test_shapes_are_plotted(self):
        self.run_program("verify", "--only", "cantilever")
        self.assertIn("<svg", (self.folder / "verify/verify.html").read_text(encoding="utf-8"))

    @unittest.skipIf(SANITIZED, "contact of the engine, which other tests have as well")
    def test_contact(self):
        done = self.run_program("verify", "--only", "capstan,impact", "--json")
        data = json.loads(done.stdout)
        self.assertEqual((data["readings"], data["holding"]), (8, 8))
        self.assertEqual((self.folder / "verify/verify.html").read_text(encoding="utf-8").count("<svg"), 3)

    def test_progress(self):
        done = self.run_program("verify", "--only", FAST, "--progress", "json")
        last = json.loads(done.stderr.splitlines()[-1])
        self.assertEqual((last["verb"], last["done"]), ("verify", True))

    def test_order_and_repetition_of_names_do_not_matter(self):
        done = self.run_program("verify", "--only", "patch,decay,patch", "--json")
        self.assertEqual([case["name"] for case in json.loads(done.stdout)["cases"]], ["patch", "decay"])

    def test_bad_names(self):
        done = self.run_program("verify", "--only", "cantilevr", code=2)
        self.assertIn("there is no case", done.stderr)
        self.assertIn("did you mean `cantilever`?", done.stderr)
        self.assertIn("catenary", done.stderr)
        self.run_program("verify", "--only", "", code=2)
        self.run_program("verify", "--only", "patch,,decay", code=2)
        self.run_program("verify", "patch", code=2)
        self.run_program("verify", "-o", "", code=2)
        self.assertEqual(self.files(), [])

    def test_a_folder_that_cannot_be_made(self):
        self.write("taken", "a file")
        done = self.run_program("verify", "--only", "decay", "-o", "taken", code=1)
        self.assertIn("taken", done.stderr)
        self.assertEqual(done.stdout, "")
        done = self.run_program("verify", "--only", "decay", "-o", "taken/below", code=1)
        self.assertIn("cannot be made", done.stderr)

    @unittest.skipIf(hasattr(os, "geteuid") and os.geteuid() == 0, "root may write everywhere")
    def test_a_folder_that_cannot_be_written(self):
        (self.folder / "locked").mkdir()
        os.chmod(self.folder / "locked", 0o500)
        done = self.run_program("verify", "--only", "decay", "-o", "locked", code=1)
        self.assertIn("locked", done.stderr)

    def test_help_lists_the_cases(self):
        done = self.run_program("verify", "--help")
        for name in ("cantilever", "catenary", "capstan", "drape", "--fine", "--only"):
            self.assertIn(name, done.stdout)

    @unittest.skipUnless(sys.platform.startswith("linux"), "sends a signal")
    def test_interrupted(self):
        process = subprocess.Popen([os.path.abspath(PERCALE), "verify", "--only", "decay,cantilever,chord_angle,catenary",
                                    "--threads", "1"], cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, err)
        self.assertIn(b"interrupted", err)
        self.assertIn(b"quantities within their gates", out)


if __name__ == "__main__":
    unittest.main()
