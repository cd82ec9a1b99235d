"""The command line: verbs, options, exit codes 2 and 3, help, check, info, doctor and print-config."""

import json
import os
import unittest

from program import ROOT, ProgramTest, cloth

VERBS = ["view", "simulate", "shot", "render", "figures", "check", "info", "doctor", "bench", "version"]


class Usage(ProgramTest):
    def usage(self, *arguments, expect=()):
        done = self.run_program(*arguments, code=2)
        self.assertEqual(done.stdout, "")
        self.assertIn("percale: error: ", done.stderr)
        for words in [expect] if isinstance(expect, str) else expect:
            self.assertIn(words, done.stderr)
        self.assertNotIn("terminate", done.stderr)

    def test_wrong_verbs(self):
        self.usage("simulat", expect="did you mean `simulate`?")
        self.usage("rendr", "x.json", expect="did you mean `render`?")
        self.usage("frobnicate", expect="the verbs are view, simulate")
        self.usage("help", "sho", expect="did you mean `shot`?")

    def test_wrong_options(self):
        self.usage("simulate", "--frmaes", 3, expect="did you mean `--frames`?")
        self.usage("shot", "--shadr", "Phong", expect="did you mean `--shader`?")
        self.usage("--nonsense", expect="--nonsense")
        # Where an option does exist, it is not its spelling that is wrong.
        self.usage("simulate", "--shader", "Phong", expect="no option of simulate; it belongs to view, shot, render")
        self.usage("a.json", "--seconds", 3, expect="--seconds needs a verb before it: simulate, shot, render")
        self.usage("shot", "--frames", 3, expect="no option of shot; it belongs to simulate, render, bench")
        self.usage("simulate", "a.json", "b.json", expect='"b.json"')
        self.usage("simulate", "a.json", "-f", "b.json", expect="two scenes")

    def test_wrong_numbers(self):
        for option, bad in [("--frames", ["-1", "x", "1.5", "", "1e99", "nan"]), ("--seconds", ["-1", "x", "inf"]),
                            ("--limit", ["0", "-5", "x"]), ("--every", ["0", "-1", "x"]),
                            ("--threads", ["0", "-1", "x", "1e9"])]:
            for value in bad:
                self.usage("simulate", self.scene(), option, value, "-o", "a.csv", expect=[option, "expected"])
        self.assertEqual(self.files(), ["scene.json"])

    def test_wrong_picture_options(self):
        scene = self.scene()
        for option, bad in [("--size", ["10", "0x10", "10x", "axb", "99999x10"]), ("--samples", ["0", "3", "x"]),
                            ("--camera", ["1", "0,95", "0,0,0", "a,b", "0,0,1,2"]), ("--target", ["1,2", "a,b,c"]),
                            ("--uniform", ["x", "=1", "x=", "x=1,2", "nosuch=1"]), ("--shader", ["Phon", "../Phong"]),
                            ("-a", ["1", "x", "-3", "99999"]), ("-o", ["2", "-4"])]:
            for value in bad:
                self.usage("shot", scene, "--shader", "Normal", option, value, expect=option)
        self.usage("shot", scene, "-o", "a.jpg", expect=".png")
        self.usage("render", scene, "-o", "a.avi", expect=".mp4")
        self.usage("render", scene, "--fps", 0, expect="--fps")
        self.assertEqual(self.files(), ["scene.json"])

    def test_wrong_figures(self):
        for bad in ("0", "50", "a", "22-19", "", "1,", "1-2-3", "-3", "1.5"):
            self.usage("figures", "--only", bad, expect=["--only", "1..49", "19-22,31"])
        self.usage("figures", "--size", "0x0", expect="--size")
        self.usage("figures", "-o", "", expect="-o")
        self.usage("figures", "-r", "nowhere", expect="shaders/")
        self.usage("figures", "--shader", "Phong", expect="no option of figures; it belongs to view, shot, render")
        self.assertEqual(self.files(), [])

    def test_the_course_flags(self):
        self.usage("-a", "x", expect="-a")
        self.usage("-o", "x", expect="-o")
        self.usage("-r", self.folder, expect="shaders/")
        self.usage("simulate", "-r", "nowhere", expect="shaders/")
        done = self.run_program("simulate", "-f", self.scene(), "-a", 16, "-o", 16, "-r", ROOT, "--frames", 2, "-o", "a.csv")
        self.assertIn("a.csv", done.stdout)

    def test_wrong_outputs(self):
        self.usage("simulate", self.scene(), "-o", "a.xyz", expect=".csv, .obj, .ply or .pc2")
        self.usage("simulate", self.scene(), "-o", "noextension", expect=".csv")
        self.usage("simulate", self.scene(), "--every", 3, expect="-o FILE")

    def test_options_that_contradict(self):
        self.usage("simulate", self.scene(), "--frames", 3, "--seconds", 1, expect="--frames and --seconds")
        self.usage("shot", self.scene(), "--frame", 3, "--until-rest", expect="give one")

    def test_wrong_assignments(self):
        scene = self.scene()
        for assignment, word in [("cloth.kss=5", "did you mean `ks`?"), ("ks=5", "cloth.ks"), ("cloth.ks", "="),
                                 ("cloth.ks=-5", ">= 0"), ("cloth.ks=five", "number"), ("cloth.9.ks=5", "cloth.9"),
                                 ("clothh.ks=5", "did you mean `cloth`?"), ("sphere.radius=1", "no sphere"),
                                 ("cloth.ks=1e999", "number")]:
            self.usage("simulate", scene, "--set", assignment, expect=[assignment, word])

    def test_wrong_benchmarks(self):
        self.usage("bench", "spring", expect="did you mean `springs`?")

    def test_help_of_every_verb(self):
        self.assertIn("simulate", self.run_program("--help").stdout)
        for verb in VERBS:
            done = self.run_program(verb, "--help")
            self.assertIn("Examples:", done.stdout)
            self.assertIn(f"percale {verb}", done.stdout)
            self.assertIn("Exit codes:", done.stdout)
            self.assertEqual(done.stderr, "")
            self.assertEqual(self.run_program("help", verb).stdout, done.stdout)
        self.assertIn("-o N|FILE", self.run_program("simulate", "--help").stdout)

    def test_version(self):
        self.assertRegex(self.run_program("version").stdout, r"^percale \d+\.\d+\.\d+\n$")
        self.assertEqual(self.run_program("--version").stdout, self.run_program("version").stdout)


class InvalidInput(ProgramTest):
    def invalid(self, *arguments, expect=()):
        done = self.run_program(*arguments, code=3)
        for words in [expect] if isinstance(expect, str) else expect:
            self.assertIn(words, done.stderr)
        self.assertNotIn("terminate", done.stderr)
        return done

    def test_a_missing_scene(self):
        for verb in ("simulate", "check", "info", "shot", "render", "view"):
            self.invalid(verb, "nowhere.json", expect="nowhere.json: error: ")
        self.invalid("nowhere.json", expect="nowhere.json: error: ")

    def test_a_wrong_value_has_its_place(self):
        text = json.dumps({"cloth": cloth()}, indent=2).replace('"ks": 5000', '"ks": "5k"')
        self.write("bad.json", text)
        line = next(i for i, l in enumerate(text.splitlines(), 1) if "5k" in l)
        for verb in ("simulate", "check", "info", "shot", "render"):
            done = self.invalid(verb, "bad.json", expect=[f"bad.json:{line}:11: error: /cloth/ks: expected", '"5k"'])
            self.assertEqual(done.stdout, "")

    def test_files_that_are_no_scenes(self):
        (self.folder / "folder.json").mkdir()
        (self.folder / "binary.json").write_bytes(bytes(range(256)) * 20)
        for name, content in [("empty.json", ""), ("spaces.json", " \n" * 1000), ("cut.json", '{"cloth": {"width": 1,'),
                              ("list.json", "[1, 2, 3]"), ("deep.json", "[" * 100000), ("nocloth.json", "{}")]:
            self.write(name, content)
        for name in ("folder", "binary", "empty", "spaces", "cut", "list", "deep", "nocloth"):
            self.invalid("simulate", f"{name}.json", expect=f"{name}.json")

    def test_assignments_that_do_not_fit_together(self):
        self.invalid("simulate", self.scene(), "--set", "cloth.num_width_points=5", expect="pinned")

    def test_a_scene_that_asks_for_an_unknown_shader(self):
        self.write("look.json", {"cloth": cloth(), "look": {"shader": "Phongg"}})
        self.invalid("shot", "look.json", expect="did you mean `Phong`?")

    def test_nothing_is_written(self):
        self.write("bad.json", "{")
        self.invalid("simulate", "bad.json", "-o", "a.csv")
        self.invalid("shot", "bad.json", "-o", "a.png")
        self.invalid("render", "bad.json", "-o", "a.mp4")
        self.assertEqual(self.files(), ["bad.json"])


class CheckVerb(ProgramTest):
    def test_all_scenes_of_the_project(self):
        scenes = sorted((ROOT / "scene").glob("*.json"))
        self.assertGreaterEqual(len(scenes), 9)
        done = self.run_program("check", *scenes)
        self.assertEqual(done.stdout.count(": ok\n"), len(scenes))
        self.assertEqual(done.stderr, "")

    def test_every_problem_of_every_file(self):
        self.write("a.json", {"cloth": {**cloth(), "ks": -1, "density": "heavy"}})
        self.write("b.json", {"cloth": {**cloth(), "widht": 1}})
        done = self.run_program("check", "a.json", ROOT / "scene/pinned2.json", "b.json", code=3)
        for words in ("/cloth/ks", "/cloth/density", "did you mean `width`?"):
            self.assertIn(words, done.stderr)
        self.assertIn("pinned2.json: ok", done.stdout)

    def test_the_default_scene(self):
        self.assertIn("pinned2.json: ok", self.run_program("check", "-r", ROOT).stdout)

    def test_the_schema_is_json(self):
        schema = json.loads(self.run_program("check", "--schema").stdout)
        self.assertIn("cloth", schema["properties"])


class InfoVerb(ProgramTest):
    def test_a_scene(self):
        done = self.run_program("info", ROOT / "scene/pinned2.json")
        for words in ("2500 (50 x 50), 2 pinned", "4900 structural, 4802 shearing, 4800 bending", "0.06 kg per point",
                      "stable below 2.187e+05 N/m", "sensible up to 0.0102 m", "1/2700 s"):
            self.assertIn(words, done.stdout)

    def test_springs_are_counted_as_they_are_made(self):
        self.write("narrow.json", {"cloth": {**cloth(), "num_width_points": 2, "num_height_points": 5, "pinned": []}})
        self.assertIn("13 structural, 8 shearing, 6 bending", self.run_program("info", "narrow.json").stdout)

    def test_caches(self):
        scene = self.scene(points=5)
        for name in ("a.csv", "a.pc2", "a.obj", "a.ply"):
            self.run_program("simulate", scene, "--frames", 4, *(["--every", 2] if name == "a.csv" else []), "-o", name)
        done = self.run_program("info", "a.csv", "a.pc2", "a.obj", "a.ply")
        parts = done.stdout.split("\n\n")
        self.assertEqual(len(parts), 4)
        for part, frames, triangles in zip(parts, (3, 5, 1, 1), (None, None, 32, 32)):
            self.assertRegex(part, rf"frames +{frames}\n")
            self.assertRegex(part, r"vertices +25\n")
            if triangles:
                self.assertRegex(part, rf"triangles +{triangles}\n")

    def test_broken_caches(self):
        self.run_program("simulate", self.scene(points=5), "--frames", 4, "-o", "a.pc2")
        data = (self.folder / "a.pc2").read_bytes()
        (self.folder / "cut.pc2").write_bytes(data[:-1])
        (self.folder / "short.pc2").write_bytes(data[:20])
        (self.folder / "negative.pc2").write_bytes(data[:16] + b"\xff\xff\xff\xff" + data[20:])
        (self.folder / "huge.pc2").write_bytes(data[:16] + b"\xff\xff\xff\x7f" + data[20:28] + b"\xff\xff\xff\x7f" + data[32:])
        (self.folder / "nan.pc2").write_bytes(data[:32] + b"\x00\x00\xc0\x7f" + data[36:])
        self.write("empty.obj", "")
        self.write("face.obj", "v 0 0 0\nf 1 2 3\n")
        self.write("head.csv", "frame,x\n")
        self.write("cut.csv", "frame,cloth,vertex,x,y,z\n0,0,0,1,2,3\n0,0,1,1,2,3\n1,0,0,1,2,3\n")
        self.write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nend_header\n1\n")
        for name in ("cut.pc2", "short.pc2", "negative.pc2", "huge.pc2", "nan.pc2", "empty.obj", "face.obj", "head.csv",
                     "cut.csv", "bad.ply", "nowhere.obj"):
            done = self.run_program("info", name, code=3)
            self.assertIn(f"{name}", done.stderr)
            self.assertIn("error: ", done.stderr)


class Configuration(ProgramTest):
    def lines(self, *arguments):
        done = self.run_program(*arguments, "--print-config")
        result = {}
        for line in done.stdout.splitlines():
            path, rest = line.split(" = ", 1)
            value, origin = rest.rsplit("  # ", 1)
            result[path.strip()] = (value.strip(), origin.strip())
        return result

    def test_each_value_has_its_origin(self):
        config = self.lines("simulate", self.scene(), "--set", "cloth.ks=500", "--set", "cloth.ks=600")
        self.assertEqual(config["cloth.ks"], ("600 N/m", "--set cloth.ks=600"))
        self.assertRegex(config["cloth.density"][1], r"scene\.json:\d+:\d+$")
        self.assertEqual(config["simulation.frames_per_second"], ("90 1/s", "default"))

    def test_options_for_the_picture_are_origins_too(self):
        scene = self.write("look.json", {"cloth": cloth(), "look": {"shader": "Normal"}, "camera": {"azimuth": 5}})
        self.assertRegex(self.lines("shot", scene)["look.shader"][1], r"look\.json:\d+:\d+$")
        self.assertEqual(self.lines("shot", scene)["camera.automatic"], ("false", "follows from the rest"))
        config = self.lines("shot", scene, "--shader", "Phong", "--camera", "10,20", "--target", "1,2,3")
        self.assertEqual(config["look.shader"], ('"Phong"', "--shader Phong"))
        self.assertEqual(config["camera.azimuth"], ("10 degree", "--camera"))
        self.assertEqual(config["camera.elevation"], ("20 degree", "--camera"))
        self.assertEqual(config["camera.target"], ("[1, 2, 3] m", "--target"))

    def test_it_runs_nothing(self):
        self.lines("simulate", self.scene(), "-o", "a.csv")
        self.assertEqual(self.files(), ["scene.json"])

    def test_assignments_act(self):
        a = self.summary(self.run_program("simulate", self.scene(), "--frames", 5))["state"]
        b = self.summary(self.run_program("simulate", self.scene(), "--frames", 5, "--set", "cloth.ks=50"))["state"]
        c = self.summary(self.run_program("simulate", self.scene(ks=50), "--frames", 5))["state"]
        self.assertNotEqual(a, b)
        self.assertEqual(b, c)


class WithoutGraphics(ProgramTest):
    """A machine without OpenGL, made by hiding its drivers."""

    def setUp(self):
        super().setUp()
        self.environment["__EGL_VENDOR_LIBRARY_DIRS"] = str(self.folder)

    def test_pictures_say_what_to_install(self):
        scene = self.scene()
        for verb, output in (("shot", "a.png"), ("render", "a.mp4")):
            done = self.run_program(verb, scene, "-o", output, code=5)
            self.assertIn("install", done.stderr)
        self.run_program("figures", "-r", ROOT, "-o", "gallery", code=5)
        self.assertEqual(self.files(), ["scene.json"])

    def test_simulate_needs_none(self):
        self.run_program("simulate", self.scene(), "--frames", 2)

    def test_doctor_tells(self):
        done = self.run_program("doctor", code=1)
        self.assertRegex(done.stdout, r"MISSING +graphics")


class Doctor(ProgramTest):
    def test_all_is_there(self):
        done = self.run_program("doctor", "-r", ROOT)
        for what in ("version", "compiler", "cores", "threads", "instructions", "project", "graphics", "display", "ffmpeg"):
            self.assertRegex(done.stdout, rf"(?m)^(ok|note) +{what} ")

    def test_a_missing_ffmpeg_is_a_note(self):
        done = self.run_program("doctor", environment={"PATH": str(self.folder)})
        self.assertRegex(done.stdout, r"note +ffmpeg +not found")


class Keys(ProgramTest):
    def test_the_documentation_has_the_table_of_the_program(self):
        printed = self.run_program("view", "--keys").stdout
        self.assertIn("| P | Run or pause the simulation | Simulation |\n", printed)
        documented = (ROOT / "docs" / "viewer.md").read_text(encoding="utf-8")
        self.assertIn("\n\n" + printed + "\n", documented, "remedy: paste what `percale view --keys` prints")


class WithoutDisplay(ProgramTest):
    def test_view_says_so(self):
        done = self.run_program("view", self.scene(), code=5)
        self.assertIn("display", done.stderr)
        self.run_program(self.scene(), code=5)


if __name__ == "__main__":
    unittest.main()
