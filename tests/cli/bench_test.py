"""percale bench as a verb: what it prints and writes. Times are told, never judged."""

import json
import unittest
import xml.etree.ElementTree

from program import ProgramTest


class Bench(ProgramTest):
    def test_fabric_json(self):
        done = self.run_program("bench", "fabric", "--sizes", "10,16", "--json", "-o", "a/b")
        data = json.loads(done.stdout)
        runs = data["error_against_time"]
        self.assertEqual({(run["side"], run["stiffness"]) for run in runs},
                         {(side, stiffness) for side in (10, 16) for stiffness in (1, 8, 64)})
        for side in (10, 16):
            for stiffness in (1, 8, 64):
                mine = [run for run in runs if (run["side"], run["stiffness"]) == (side, stiffness)]
                error = {(run["method"], run["setting"]): run["error"] for run in mine}
                # What is asked to do more comes nearer to the converged run, by whatever method.
                self.assertLess(error["engine", "8 x 16"], 0.01)
                self.assertLess(error["Newton, direct", "4 iterations"], 0.01)
                self.assertLess(error["XPBD", "320 substeps"], error["XPBD", "10 substeps"])
                self.assertTrue(all(run["ms_per_frame"] > 0 for run in mine))
        self.assertEqual([scale["side"] for scale in data["scaling"]], [10, 16])
        self.assertTrue(all(scale["peak_bytes"] > 1e6 and scale["newton"] >= 1 for scale in data["scaling"]))
        self.assertEqual([(target["measured"], target["holds"]) for target in data["targets"]], [("equal", True)])
        self.assertTrue((self.folder / "a/b/fabric.html").exists())
        self.assertEqual(json.loads((self.folder / "a/b/fabric.json").read_text(encoding="utf-8")), data)

    def test_fabric_table_and_page(self):
        done = self.run_program("bench", "fabric", "--sizes", "10", "--frames", "21", "--threads", "3")
        for text in ("10 x 10 vertices, 64 times cotton's stiffness", "3 threads", "times faster than XPBD",
                     "equal to the last bit"):
            self.assertIn(text, done.stdout)
        self.assertEqual(self.files(), ["benchmarks"] + ["benchmarks/fabric" + name for name in
                                                         (".html", ".json", ".txt", "_cost.svg", "_error.svg")])
        for name in ("cost", "error"):
            plot = xml.etree.ElementTree.parse(self.folder / f"benchmarks/fabric_{name}.svg").getroot()
            self.assertEqual(plot.tag, "{http://www.w3.org/2000/svg}svg")
            self.assertTrue(plot.findall(".//{http://www.w3.org/2000/svg}circle"))
        page = (self.folder / "benchmarks/fabric.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("<svg"), 4)  # three stiffnesses, and the cost per vertex
        self.assertNotRegex(page, r"(src|href)=\"(?!#|data:)")  # needs no other file

    def test_springs_beside_the_plain_twin(self):
        done = self.run_program("bench", "springs", "--sizes", "12", "--frames", "4", "--json")
        data = json.loads(done.stdout)
        self.assertTrue(all(run["equal"] for run in data["ns_per_point_and_step"]))
        self.assertEqual(self.files(), [])
        self.keeps_what_it_prints("springs", "--frames", "1")

    def test_what_contact_costs(self):
        done = self.run_program("bench", "contact", "--sizes", "12", "--frames", "40", "--threads", "2", "--json")
        data = json.loads(done.stdout)
        self.assertTrue(data["equal"])
        self.assertEqual({(run["scene"], run["threads"], run["phase"]) for run in data["runs"]},
                         {(scene, threads, phase) for threads in (1, 2) for scene, phase in
                          (("drape", "falls"), ("drape", "lands"), ("drape", "rests in folds"), ("no contact", "swings"))})
        self.assertIn({"what": "intersections", "goal": "0", "measured": "0", "holds": True}, data["targets"])
        self.assertEqual(self.files(), [])
        self.keeps_what_it_prints("contact", "--frames", "4", "--threads", "1")

    def keeps_what_it_prints(self, name, *arguments):
        """With -o the folder holds the tables that are printed, and the same as JSON."""
        done = self.run_program("bench", name, "--sizes", "8", *arguments, "-o", "kept/here")
        self.assertEqual(self.files(), ["kept", "kept/here", f"kept/here/{name}.json", f"kept/here/{name}.txt"])
        table = (self.folder / f"kept/here/{name}.txt").read_text(encoding="utf-8")
        self.assertGreater(table.count("\n"), 5)
        self.assertTrue(done.stdout.startswith(table))
        self.assertIn(f"{name}.txt", done.stdout[len(table):])
        self.assertTrue(json.loads((self.folder / f"kept/here/{name}.json").read_text(encoding="utf-8")))

    def test_an_unwritable_place_shows_before_the_work(self):
        (self.folder / "benchmarks").write_text("a file")
        done = self.run_program("bench", "fabric", "--sizes", "10", code=1)
        self.assertIn("benchmarks", done.stderr)
        self.assertNotIn("stiffness", done.stderr)
        for name in ("springs", "contact"):
            done = self.run_program("bench", name, "--sizes", "10", "-o", "benchmarks", code=1)
            self.assertIn("benchmarks", done.stderr)
            self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    unittest.main()
