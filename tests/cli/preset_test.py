"""Presets from the command line: default < --preset < scene file < --set."""

import re
import unittest

from program import ProgramTest


class Presets(ProgramTest):
    def config(self, *arguments):
        """path -> (value, origin)"""
        done = self.run_program("simulate", self.scene(), "--print-config", *arguments)
        rows = {}
        for line in done.stdout.splitlines():
            path, value, origin = re.fullmatch(r"(\S+) += (.*?) +# (.*)", line).groups()
            rows[path] = (value, origin)
        return rows, done.stderr

    def test_each_stands_in_its_place(self):
        self.write("mine.json", {"description": "x", "set": {"cloth.ks": 800, "cloth.seed": 5, "wind.drag": 3,
                                                             "simulation.steps_per_frame": 20}})
        rows, errors = self.config("--preset", "mine.json", "--set", "wind.drag=4")
        self.assertEqual(rows["cloth.ks"][0], "5000 N/m")  # The scene file states it.
        self.assertIn("scene.json:", rows["cloth.ks"][1])
        self.assertEqual(rows["cloth.seed"][0], "5")
        self.assertRegex(rows["cloth.seed"][1], r"--preset mine.json, mine.json:\d+:\d+")
        self.assertEqual(rows["simulation.steps_per_frame"][0], "20")
        self.assertEqual(rows["wind.drag"], ("4 kg/(m^2 s)", "--set wind.drag=4"))
        self.assertEqual(rows["simulation.frames_per_second"][1], "default")
        self.assertIn("the scene file states /cloth/0/ks itself, which wins; with --set preset=mine.json", errors)

    def test_a_preset_above_the_scene_file(self):
        rows, errors = self.config("--set", "preset=silk", "--set", "cloth.damping=0.1")
        self.assertEqual(rows["cloth.ks"][0], "1500 N/m")
        self.assertRegex(rows["cloth.ks"][1], r"--set preset=silk, .*silk\.json:\d+:\d+")
        self.assertEqual(rows["cloth.damping"][0], "0.1 %")
        self.assertEqual(errors, "")

    def test_the_later_wins(self):
        rows, _ = self.config("--preset", "moon", "--preset", "weightless")
        self.assertEqual(rows["simulation.gravity"][0], "[0, 0, 0] m/s^2")

    def test_a_preset_changes_the_motion(self):
        scene = self.scene()
        def state(*arguments):
            return self.summary(self.run_program("simulate", scene, "--frames", 3, *arguments))["state"]
        self.assertNotEqual(state(), state("--preset", "moon"))
        self.assertEqual(state("--preset", "moon"), state("--set", "simulation.gravity=[0,-1.62,0]"))
        self.assertEqual(state("--set", "preset=no_bending"), state("--set", "cloth.enable_bending=false"))

    def test_the_users_own_come_first(self):
        (self.folder / "config" / "presets").mkdir(parents=True)
        self.write("config/presets/moon.json", {"set": {"simulation.gravity": [0, -1, 0]}})
        rows, _ = self.config("--preset", "moon")
        self.assertEqual(rows["simulation.gravity"][0], "[0, -1, 0] m/s^2")

    def test_what_is_wrong(self):
        scene = self.scene()
        done = self.run_program("simulate", scene, "--preset", "sillk", code=2)
        self.assertIn("--preset: there is no preset \"sillk\" (did you mean `silk`?)", done.stderr)
        self.write("bad.json", '{"set": {\n  "cloth.ks": -5\n}}')
        done = self.run_program("simulate", scene, "--set", "preset=bad.json", code=3)
        self.assertIn("bad.json:2:15: error: cloth.ks: expected a number >= 0 N/m, got -5", done.stderr)
        self.assertIn("^", done.stderr)
        self.run_program("simulate", scene, "--preset", "no/such.json", code=3)

    def test_every_verb_takes_them(self):
        scene = self.scene()
        for verb in ("check", "info"):
            self.run_program(verb, scene, "--preset", "moon")
        self.run_program("check", scene, "--preset", "sillk", code=2)


if __name__ == "__main__":
    unittest.main()
