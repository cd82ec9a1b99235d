"""percale shot and render: pictures and videos as files."""

import json
import os
import shutil
import signal
import struct
import subprocess
import time
import unittest
import zlib

from program import PERCALE, ROOT, ProgramTest


def read_png(path):
    """(width, height, rows of pixels as (r, g, b), texts); checks every checksum."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, header, packed, texts = 8, None, b"", {}
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        elif kind == b"tEXt":
            key, text = body.split(b"\0", 1)
            texts[key.decode("latin-1")] = text.decode("utf-8", "replace")
        elif kind == b"zTXt":
            key, rest = body.split(b"\0", 1)
            texts[key.decode("latin-1")] = zlib.decompress(rest[1:]).decode("utf-8", "replace")
        elif kind == b"iTXt":
            key, rest = body.split(b"\0", 1)
            text = rest[2:].split(b"\0", 2)[2]
            texts[key.decode("latin-1")] = (zlib.decompress(text) if rest[0] else text).decode("utf-8")
        at += 12 + length
    width, height, depth, color, _, _, interlace = header
    assert depth == 8 and color in (2, 6) and interlace == 0
    channels = 3 if color == 2 else 4
    raw, rows, stride = zlib.decompress(packed), [], width * channels
    above = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            a = line[x - channels] if x >= channels else 0
            b = above[x]
            c = above[x - channels] if x >= channels else 0
            if kind == 1:
                line[x] = (line[x] + a) & 255
            elif kind == 2:
                line[x] = (line[x] + b) & 255
            elif kind == 3:
                line[x] = (line[x] + (a + b) // 2) & 255
            elif kind == 4:
                p = a + b - c
                line[x] = (line[x] + min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]) & 255
        above = line
        rows.append([tuple(line[x:x + 3]) for x in range(0, stride, channels)])
    return width, height, rows, texts


def probe(path):
    text = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-of", "json", "-show_entries",
                           "stream=codec_name,width,height,r_frame_rate,nb_read_frames,pix_fmt", str(path)],
                          stdout=subprocess.PIPE, check=True).stdout
    return json.loads(text)["streams"][0]


class Shot(ProgramTest):
    def shot(self, *arguments, name="a.png"):
        self.run_program("shot", *arguments, "-o", name)
        return read_png(self.folder / name)

    def test_size_background_and_cloth(self):
        width, height, rows, _ = self.shot(self.scene(), "--size", "160x120", "--shader", "Normal", "--frame", 20)
        self.assertEqual((width, height, len(rows), len(rows[0])), (160, 120, 120, 160))
        self.assertTrue(all(abs(c - 64) <= 1 for c in rows[0][0]), rows[0][0])
        self.assertGreater(sum(max(p) - min(p) > 30 for row in rows for p in row), 500)

    def test_same_bytes_again(self):
        self.shot(self.scene(), "--size", "96x80", "--frame", 5, "--threads", 1, name="a.png")
        self.shot(self.scene(), "--size", "96x80", "--frame", 5, "--threads", 2, name="b.png")
        self.assertEqual((self.folder / "a.png").read_bytes(), (self.folder / "b.png").read_bytes())

    def test_options_change_the_picture(self):
        scene = ROOT / "scene/sphere.json"
        base = ["--size", "96x80", "--shader", "Phong", "--frame", "30", "--set", "cloth.num_width_points=20",
                "--set", "cloth.num_height_points=20"]
        pictures = [self.shot(scene, *base, *more)[2] for more in
                    ([], ["--camera", "40,30"], ["--camera", "0,0,3"], ["--target", "0,0,0"], ["--frame", "0"],
                     ["--uniform", "ambient_on=0"], ["--set", "look.color=[1,0,0]"])]
        for i, a in enumerate(pictures):
            for b in pictures[:i]:
                self.assertNotEqual(a, b)

    def test_options_go_before_what_a_picture_tells(self):
        scene = [ROOT / "scene/sphere.json", "--size", "96x80", "--frame", 10]
        sphere = ["-a", 40, "-o", 40]
        self.shot(*scene, "-a", 9, "-o", 9, "--heat-map", "stretch", name="told.png")
        told = self.folder / "told.png"
        for options in ([*sphere, "--heat-map", "off"], [*sphere, "--heat-map", "stretch", "--heat-range", "1,3"]):
            self.assertEqual(self.shot(told, "--size", "96x80", *options)[2], self.shot(*scene, *options)[2])
        self.assertEqual(self.shot(told, "--size", "96x80", "--heat-range", "1,3")[2],
                         self.shot(*scene, "-a", 9, "-o", 9, "--heat-map", "stretch", "--heat-range", "1,3")[2])

    def test_a_switch_is_no_fraction(self):
        for value in ("bands=2.5", "axis=0.5", "lit=0.5", "bands=4"):
            done = self.run_program("shot", self.scene(), "--shader", "Flag", "--uniform", value, code=2)
            self.assertIn(f"u_{value.split('=')[0]}: expected a whole number", done.stderr)

    def test_heat_maps_and_overlays(self):
        base = [self.scene(), "--size", "160x120", "--frame", 10]
        plain = self.shot(*base)[2]
        maps = [self.shot(*base, "--heat-map", name)[2] for name in ("stretch", "speed", "curvature", "contact")]
        pins = self.shot(*base, "--overlay", "pins,normals", "--shader", "Phong")[2]
        fixed = self.shot(*base, "--heat-map", "stretch", "--heat-range", "1,3")[2]
        pictures = [plain, *maps, pins, fixed]
        for i, a in enumerate(pictures):
            for b in pictures[:i]:
                self.assertNotEqual(a, b)
        self.assertTrue(any((230, 159, 0) in row for row in pins))
        # The legend is dark around its bar, in a corner that is empty without one.
        self.assertEqual(plain[2][2], (64, 64, 64))
        self.assertEqual(fixed[2][2], (22, 22, 22))

        errors = self.run_program("shot", *base, "--heat-map", "strech", code=2).stderr
        self.assertIn("did you mean `stretch`?", errors)
        self.assertIn("did you mean `normals`?", self.run_program("shot", *base, "--overlay", "pins,normal", code=2).stderr)
        for bad in ("1", "2,1", "1,x", "1,1"):
            self.assertIn("LOW,HIGH", self.run_program("shot", *base, "--heat-range", bad, code=2).stderr)

    def test_default_name(self):
        self.run_program("shot", self.scene("tuch.json"), "--size", "32x32")
        self.assertIn("tuch.png", self.files())

    def test_the_scene_is_in_the_picture(self):
        texts = self.shot(self.scene(), "--size", "32x32", "--frame", 3, "--camera", "10,20,2", "--set", "cloth.ks=123")[3]
        self.assertEqual(texts["percale:frame"], "3")
        self.write("again.json", texts["percale:scene"])
        config = self.run_program("simulate", "again.json", "--print-config").stdout
        self.assertRegex(config, r"cloth\.ks += 123 N/m")
        self.assertRegex(config, r"camera\.azimuth += 10 ")
        again = self.shot("again.json", "--size", "32x32", "--frame", 3, name="b.png")
        self.assertEqual(again[2], read_png(self.folder / "a.png")[2])

    def test_a_picture_is_drawn_again_as_it_is(self):
        told = self.shot(self.scene(), "--size", "70x50", "--frame", 3, name="told.png")
        self.assertEqual(self.shot("told.png", name="again.png")[:3], told[:3])
        self.assertEqual(self.shot("told.png", "--size", "32x20", name="small.png")[:2], (32, 20))

    def test_a_picture_names_meshes_as_from_the_project(self):
        scene = [ROOT / "scene/gauntlet/funnel.json", "--size", "24x18", "--frame", 0]
        told = self.shot(*scene, "-r", ROOT, name="told.png")
        self.assertNotIn(str(ROOT), told[3]["percale:scene"])
        self.assertIn('"scene/meshes/funnel.obj"', told[3]["percale:scene"])
        self.assertEqual(self.shot("told.png", "-r", ROOT, name="again.png")[:3], told[:3])
        for name in ("shaders", "textures"):
            shutil.copytree(ROOT / name, self.folder / "bare" / name)
        (self.folder / "bare/scene").mkdir()
        done = self.run_program("shot", "told.png", "-r", "bare", "-o", "lost.png", code=3)
        self.assertRegex(done.stderr, r'told\.png: error: its scene needs the file "scene/meshes/funnel.obj".*, bare; put')

    def test_every_shader(self):
        names = sorted(p.stem for p in (ROOT / "shaders").glob("*.frag"))
        for shader in (name for name in names if "." not in name):  # NAME.plane is a part of NAME.
            rows = self.shot(ROOT / "scene/sphere.json", "--size", "64x48", "--shader", shader)[2]
            self.assertGreater(len({p for row in rows for p in row}), 3, shader)

    def test_until_rest(self):
        done = self.run_program("shot", self.scene(damping=2), "--until-rest", "--size", "32x32")
        self.assertIn("at rest", done.stdout)

    def test_unwritable(self):
        scene = self.scene()
        for output in ["nowhere/a.png"] + (["/dev/full"] if os.path.exists("/dev/full") else []):
            done = self.run_program("shot", scene, "--size", "32x32", "-o", output, code=1)
            self.assertIn(output, done.stderr)
        self.assertEqual(self.files(), ["scene.json"])

    def test_a_shader_that_does_not_compile(self):
        for name in ("shaders", "textures", "scene"):
            shutil.copytree(ROOT / name, self.folder / name)
        self.write("shaders/Broken.frag", "#version 330\nout vec4 out_color;\nvoid main() {\n  out_color = nonsense;\n}\n")
        done = self.run_program("shot", "--shader", "Broken", "--size", "32x32", "-o", "a.png", code=3)
        self.assertRegex(done.stderr, r"Broken\.frag:4.*error")
        self.assertNotIn("a.png", self.files())

    def test_a_shader_that_asks_for_what_is_not_there(self):
        for name in ("shaders", "scene"):
            shutil.copytree(ROOT / name, self.folder / name)
        self.write("shaders/Odd.frag", "#version 330\nuniform vec3 u_color;\nout vec4 out_color;\n"
                                       "void main() { out_color = vec4(u_color, 1); }\n")
        done = self.run_program("shot", self.scene(), "-r", ".", "--shader", "Odd", "--size", "32x32", "-o", "a.png")
        self.assertIn("Odd.frag:2:14: warning: u_color is a vec4", done.stderr)

    def test_divergence_shows_the_last_good_frame(self):
        self.run_program("shot", ROOT / "scene/pinned2.json", "--set", "simulation.steps_per_frame=1", "--frame", 60,
                         "--size", "32x32", "-o", "a.png", code=4)
        self.assertIn("a.png", self.files())


@unittest.skipUnless(shutil.which("ffmpeg") and shutil.which("ffprobe"), "ffmpeg is not installed")
class Video(ProgramTest):
    def test_real_time_by_default(self):
        done = self.run_program("render", self.scene(), "--seconds", 0.5, "--size", "64x48", "-o", "a.mp4")
        self.assertIn("a.mp4: 15 pictures", done.stdout)
        stream = probe(self.folder / "a.mp4")
        self.assertEqual((stream["codec_name"], stream["width"], stream["height"], stream["pix_fmt"]), ("h264", 64, 48, "yuv420p"))
        self.assertEqual((stream["r_frame_rate"], stream["nb_read_frames"]), ("30/1", "15"))

    def test_other_rates(self):
        for fps, pictures in ((90, 18), (45, 9), (25, 5), (180, 36)):
            self.run_program("render", self.scene(), "--frames", 18, "--fps", fps, "--size", "32x32", "-o", f"{fps}.mp4")
            stream = probe(self.folder / f"{fps}.mp4")
            self.assertEqual((stream["r_frame_rate"], stream["nb_read_frames"]), (f"{fps}/1", str(pictures)))

    def test_capitals_in_the_ending(self):
        self.run_program("render", self.scene(), "--frames", 3, "--size", "32x32", "-o", "A.MP4")
        self.assertEqual(probe(self.folder / "A.MP4")["codec_name"], "h264")
        self.run_program("shot", "scene.json", "--size", "32x32", "-o", "A.Png")
        self.assertIn("A.Png", self.files())

    def test_default_name(self):
        self.run_program("render", self.scene("tuch.json"), "--frames", 3, "--size", "32x32")
        self.assertEqual(self.files(), ["tuch.json", "tuch.mp4"])

    def test_unwritable(self):
        scene = self.scene()
        self.run_program("render", scene, "--frames", 3, "--size", "32x32", "-o", "nowhere/a.mp4", code=1)
        self.assertEqual(self.files(), ["scene.json"])

    def test_divergence_keeps_the_good_part(self):
        self.run_program("render", ROOT / "scene/pinned2.json", "--set", "simulation.steps_per_frame=1", "--frames", 60,
                         "--fps", 90, "--size", "32x32", "-o", "a.mp4", code=4)
        self.assertGreaterEqual(int(probe(self.folder / "a.mp4")["nb_read_frames"]), 5)

    @unittest.skipIf(os.name == "nt", "POSIX signals")
    def test_interrupt_keeps_the_film_so_far(self):
        process = subprocess.Popen([os.path.abspath(PERCALE), "render", self.scene(points=30), "--frames", "1000000", "--size",
                                    "64x64", "-o", "a.mp4", "--progress", "json"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, env=self.environment, text=True, start_new_session=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
        self.assertIn("frame", process.stderr.readline())
        time.sleep(0.1)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does, to ffmpeg as well
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, out + err)
        self.assertGreaterEqual(int(probe(self.folder / "a.mp4")["nb_read_frames"]), 1)
        self.assertEqual(self.files(), ["a.mp4", "scene.json"])


class NumberedPictures(ProgramTest):
    def test_a_folder(self):
        self.run_program("render", self.scene(), "--frames", 9, "--size", "40x30", "-o", "film")
        names = [f"film/{n:04}.png" for n in range(1, 4)]
        self.assertEqual(self.files(), ["film", *names, "scene.json"])
        self.assertEqual(read_png(self.folder / names[0])[:2], (40, 30))

    def test_without_ffmpeg(self):
        done = self.run_program("render", self.scene(), "--frames", 9, "--size", "40x30", "-o", "film.mp4",
                                environment={"PATH": str(self.folder)})
        self.assertIn("ffmpeg", done.stderr)
        self.assertEqual(len([f for f in self.files() if f.endswith(".png")]), 3)
        self.assertNotIn("film.mp4", self.files())


class WithoutArguments(ProgramTest):
    def test_no_display_gives_a_picture_and_a_video(self):
        done = self.run_program("-r", ROOT, "--size", "64x48")
        self.assertEqual([f for f in self.files() if not f.endswith((".mp4", ".png"))], ["out"])
        self.assertIn("out/pinned2.png", done.stdout)
        self.assertEqual(read_png(self.folder / "out/pinned2.png")[:2], (64, 48))
        if shutil.which("ffmpeg"):
            self.assertIn("out/pinned2.mp4", done.stdout)


if __name__ == "__main__":
    unittest.main()
