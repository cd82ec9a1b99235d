"""percale simulate: frames, caches, summaries, and what happens when something goes wrong."""

import csv
import json
import math
import os
import shutil
import signal
import struct
import subprocess
import time
import unittest

from program import PERCALE, ROOT, ProgramTest, cloth


def read_csv(path):
    """{frame: [(cloth, vertex, x, y, z)]} with the coordinates as text."""
    frames = {}
    with open(path, newline="") as stream:
        rows = csv.reader(stream)
        assert next(rows) == ["frame", "cloth", "vertex", "x", "y", "z"]
        for frame, cloth_index, vertex, x, y, z in rows:
            frames.setdefault(int(frame), []).append((int(cloth_index), int(vertex), x, y, z))
    return frames


def read_pc2(path):
    data = path.read_bytes()
    signature, version, points, start, sampling, samples = struct.unpack("<12siiffi", data[:32])
    assert signature == b"POINTCACHE2\0" and version == 1
    assert len(data) == 32 + 12 * points * samples, "size"
    numbers = struct.unpack(f"<{3 * points * samples}f", data[32:])
    frames = [[numbers[3 * (s * points + p):3 * (s * points + p) + 3] for p in range(points)] for s in range(samples)]
    return start, sampling, frames


def read_obj(path):
    vertices, uvs, normals, faces = [], [], [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if not words or words[0] in ("#", "o"):
            continue
        if words[0] == "f":
            faces.append([tuple(map(int, corner.split("/"))) for corner in words[1:]])
        else:
            {"v": vertices, "vt": uvs, "vn": normals}[words[0]].append(tuple(map(float, words[1:])))
    return vertices, uvs, normals, faces


def read_ply(path):
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    counts = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element")}
    vertex = struct.Struct("<3d5f")
    vertices = [vertex.unpack_from(body, i * vertex.size)[:3] for i in range(counts["vertex"])]
    face = struct.Struct("<B3i")
    faces = [face.unpack_from(body, vertex.size * len(vertices) + i * face.size) for i in range(counts["face"])]
    assert len(body) == vertex.size * len(vertices) + face.size * len(faces)
    return vertices, faces


class Frames(ProgramTest):
    def test_every_writes_the_start_each_kth_and_the_last(self):
        self.run_program("simulate", self.scene(), "--frames", 10, "--every", 4, "-o", "a.csv")
        self.assertEqual(list(read_csv(self.folder / "a.csv")), [0, 4, 8, 10])

    def test_without_every_the_last_frame_is_written(self):
        self.run_program("simulate", self.scene(), "--frames", 7, "-o", "a.csv")
        self.assertEqual(list(read_csv(self.folder / "a.csv")), [7])

    def test_seconds_count_in_frames_of_the_scene(self):
        done = self.run_program("simulate", self.scene(), "--seconds", 0.3)
        self.assertEqual(self.summary(done)["frames"], "27")
        self.assertEqual(float(self.summary(done)["simulated"].split()[0]), 0.3)

    def test_zero_frames_is_the_start(self):
        self.run_program("simulate", self.scene(points=3), "--frames", 0, "-o", "a.csv")
        frames = read_csv(self.folder / "a.csv")
        self.assertEqual(frames[0][4], (0, 4, "0.5", "1", "0.5"))

    def test_until_rest_stops_by_itself(self):
        done = self.run_program("simulate", self.scene(damping=2), "--until-rest")
        self.assertIn("at rest", self.summary(done)["frames"])
        self.assertEqual(self.summary(done)["at rest"], "yes")

    def test_until_rest_says_when_the_limit_comes_first(self):
        done = self.run_program("simulate", self.scene(), "--until-rest", "--limit", 0.1)
        self.assertEqual(self.summary(done)["frames"], "9, did not come to rest")
        self.assertIn("did not come to rest within 9 frames", done.stderr)

    def test_the_course_scene_has_the_frames_asked_for(self):
        self.run_program("simulate", ROOT / "scene/pinned2.json", "--frames", 30, "--every", 10, "-o", "p.csv")
        frames = read_csv(self.folder / "p.csv")
        self.assertEqual(list(frames), [0, 10, 20, 30])
        self.assertEqual({len(rows) for rows in frames.values()}, {2500})


class Files(ProgramTest):
    def test_csv_holds_every_bit(self):
        self.run_program("simulate", self.scene(), "--frames", 20, "-o", "a.csv")
        rows = read_csv(self.folder / "a.csv")[20]
        self.assertEqual([row[1] for row in rows], list(range(100)))
        for row in rows:
            for text in row[2:]:
                self.assertEqual("%.17g" % float(text), text)
        self.assertTrue(any(len(text) >= 18 for row in rows for text in row[2:]), "17 digits are used")

    def test_obj_and_ply_hold_the_same_mesh(self):
        scene = self.scene(points=6)
        for name in ("a.obj", "a.ply", "a.csv"):
            self.run_program("simulate", scene, "--frames", 9, "-o", name)
        vertices, uvs, normals, faces = read_obj(self.folder / "a.obj")
        rows = read_csv(self.folder / "a.csv")[9]
        self.assertEqual((len(vertices), len(uvs), len(normals), len(faces)), (36, 36, 36, 50))
        ply_vertices, ply_faces = read_ply(self.folder / "a.ply")
        for row, v, p in zip(rows, vertices, ply_vertices):
            exact = tuple(map(float, row[2:]))
            self.assertEqual(p, exact)
            for a, b in zip(v, exact):
                self.assertAlmostEqual(a, b, delta=1e-8)
        for face, ply_face in zip(faces, ply_faces):
            self.assertEqual(tuple(corner[0] - 1 for corner in face), ply_face[1:])
            for corner in face:
                self.assertEqual(len(set(corner)), 1)
        # Quad (0, 0): A C B and B C D.
        self.assertEqual(ply_faces[0][1:], (0, 6, 1))
        self.assertEqual(ply_faces[1][1:], (1, 6, 7))
        for n in normals:
            self.assertAlmostEqual(math.hypot(*n), 1, delta=1e-5)

    def test_several_frames_are_numbered(self):
        done = self.run_program("simulate", self.scene(), "--frames", 4, "--every", 2, "-o", "m.obj")
        self.assertEqual(self.files(), ["m_0000.obj", "m_0002.obj", "m_0004.obj", "scene.json"])
        self.assertIn("m_0004.obj", done.stdout)

    def test_pc2_holds_all_frames_and_its_mesh(self):
        scene = self.scene(points=5)
        self.run_program("simulate", scene, "--frames", 6, "-o", "film.pc2")
        self.run_program("simulate", scene, "--frames", 6, "--every", 1, "-o", "film.csv")
        start, sampling, frames = read_pc2(self.folder / "film.pc2")
        rows = read_csv(self.folder / "film.csv")
        self.assertEqual((start, len(frames)), (0, 7))
        self.assertAlmostEqual(sampling, 1 / 90, delta=1e-8)
        for number, frame in enumerate(frames):
            for point, row in zip(frame, rows[number]):
                self.assertEqual(point, tuple(struct.unpack("<f", struct.pack("<f", float(t)))[0] for t in row[2:]))
        vertices, _, _, faces = read_obj(self.folder / "film.pc2.obj")
        self.assertEqual((len(vertices), len(faces)), (25, 32))
        for vertex, point in zip(vertices, frames[0]):
            for a, b in zip(vertex, point):
                self.assertAlmostEqual(a, b, delta=1e-7)

    def test_pc2_with_every_is_evenly_spaced(self):
        self.run_program("simulate", self.scene(points=5), "--frames", 10, "--every", 4, "-o", "film.pc2")
        _, sampling, frames = read_pc2(self.folder / "film.pc2")
        self.assertEqual(len(frames), 3)
        self.assertAlmostEqual(sampling, 4 / 90, delta=1e-8)

    def test_several_cloths_are_one_mesh(self):
        self.write("two.json", {"cloth": [cloth(4), cloth(3, origin=[0, 1, 0])]})
        for name in ("two.csv", "two.obj", "two.ply"):
            self.run_program("simulate", "two.json", "--frames", 1, "-o", name)
        rows = read_csv(self.folder / "two.csv")[1]
        self.assertEqual([(c, v) for c, v, *_ in rows], [(0, v) for v in range(16)] + [(1, v) for v in range(9)])
        vertices, _, _, faces = read_obj(self.folder / "two.obj")
        self.assertEqual((len(vertices), len(faces)), (25, 18 + 8))
        self.assertEqual(min(corner[0] for face in faces[18:] for corner in face), 17)
        self.assertEqual(max(corner[0] for face in faces for corner in face), 25)
        ply_vertices, ply_faces = read_ply(self.folder / "two.ply")
        self.assertEqual(max(max(face[1:]) for face in ply_faces), len(ply_vertices) - 1)

    def test_threads_do_not_change_a_byte(self):
        self.write("two.json", {"cloth": [cloth(40, pinned=[]), cloth(30, pinned=[], origin=[0.1, 0.05, 0.1])],
                                "sphere": {"origin": [0.5, 0.7, 0.5], "radius": 0.2, "friction": 0.3}})
        for threads in (1, 2, 3):
            for name in ("t.csv", "t.pc2", "t.ply"):
                self.run_program("simulate", "two.json", "--frames", 12, "--threads", threads, "-o", f"{threads}{name}")
        for name in ("t.csv", "t.pc2", "t.ply"):
            first = (self.folder / f"1{name}").read_bytes()
            for threads in (2, 3):
                self.assertEqual((self.folder / f"{threads}{name}").read_bytes(), first, f"{name}, {threads} threads")

    def test_an_older_file_is_replaced_whole(self):
        old = self.write("a.csv", "old\n" * 100000)
        self.run_program("simulate", self.scene(points=3), "--frames", 1, "-o", "a.csv")
        self.assertEqual(len(old.read_text().splitlines()), 10)

    def test_a_link_is_followed(self):
        (self.folder / "real").mkdir()
        self.write("real/a.csv", "old")
        (self.folder / "a.csv").symlink_to("real/a.csv")
        self.run_program("simulate", self.scene(points=3), "--frames", 1, "-o", "a.csv")
        self.assertTrue((self.folder / "a.csv").is_symlink())
        self.assertEqual(len((self.folder / "real/a.csv").read_text().splitlines()), 10)

    def test_names_with_spaces_and_other_alphabets(self):
        self.scene("mein tuch ß 布.json", points=3)
        self.run_program("simulate", "mein tuch ß 布.json", "--frames", 1, "-o", "größe 布.obj")
        self.assertIn("größe 布.obj", self.files())


class Streams(ProgramTest):
    def test_a_table_on_stdout_is_nothing_but_a_table(self):
        done = self.run_program("simulate", self.scene(points=3), "--frames", 2, "-o", "/dev/stdout")
        self.assertEqual(len(done.stdout.splitlines()), 10)
        self.assertTrue(done.stdout.startswith("frame,cloth,vertex,x,y,z\n2,0,0,"))
        self.assertIn("kinetic energy", done.stderr)

    def test_what_each_frame_did_as_a_table(self):
        scene = self.scene(damping=0)
        done = self.run_program("simulate", scene, "--frames", 12, "--csv", "frames.csv", "-o", "points.csv")
        self.assertIn("written           frames.csv", done.stdout)
        with open(self.folder / "frames.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([int(row["frame"]) for row in rows], list(range(1, 13)))
        for row in rows:
            self.assertGreaterEqual(float(row["greatest_stretch"]), float(row["stretch_p99"]))
            self.assertGreater(float(row["elastic_energy_J"]), 0)
        self.assertAlmostEqual(float(rows[-1]["time_s"]), 12 / 90)
        self.assertIn(f"kinetic energy    {float(rows[-1]['kinetic_energy_J']):.6g} J", done.stdout)
        # What falls gives up energy, and the rest of it is found again but for what damping takes.
        first, last = rows[0], rows[-1]
        gained = sum(float(last[name]) - float(first[name]) for name in ("kinetic_energy_J", "elastic_energy_J"))
        given = float(first["potential_energy_J"]) - float(last["potential_energy_J"])
        self.assertGreater(given, gained)
        self.assertGreater(gained, 0.8 * given)
        table = self.run_program("simulate", scene, "--frames", 3, "--csv", "/dev/stdout").stdout
        self.assertEqual(len(table.splitlines()), 4)
        self.run_program("simulate", scene, "--frames", 3, "--csv", "none/frames.csv", code=1)
        self.assertEqual(self.files(), ["frames.csv", "points.csv", "scene.json"])

    def test_the_summary_is_on_stdout_and_stderr_is_silent(self):
        done = self.run_program("simulate", self.scene(), "--frames", 5)
        self.assertEqual(done.stderr, "")
        summary = self.summary(done)
        self.assertEqual(summary["steps"], "150 of 1/2700 s")
        for key in ("wall time", "greatest stretch", "kinetic energy", "at rest", "contacts"):
            self.assertIn(key, summary)
        for stage in ("ApplyForces", "FindContacts", "SelfCollide", "Collide", "LimitStrain", "FinishStep"):
            self.assertRegex(done.stdout, rf"\n  {stage} +\d")
        self.assertRegex(summary["state"], "^[0-9a-f]{16}$")

    def test_progress_for_programs(self):
        done = self.run_program("simulate", self.scene(points=20), "--frames", 200, "--progress", "json")
        lines = [json.loads(line) for line in done.stderr.splitlines()]
        self.assertEqual(lines[-1]["frame"], 200)
        self.assertEqual(lines[-1]["done"], True)
        self.assertEqual([line["frame"] for line in lines], sorted(line["frame"] for line in lines))
        self.assertEqual(lines[-1]["frames"], 200)

    def test_progress_bar_and_none(self):
        done = self.run_program("simulate", self.scene(points=30), "--frames", 100, "--progress", "bar")
        self.assertIn("\r", done.stderr)
        done = self.run_program("simulate", self.scene(points=30), "--frames", 100, "--progress", "none")
        self.assertEqual(done.stderr, "")

    def test_a_closed_pipe_does_not_crash(self):
        read, write = os.pipe()
        os.close(read)
        with os.fdopen(write, "wb") as closed:
            self.run_program("simulate", self.scene(), "--frames", 1, stdout=closed)

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_a_full_stdout_is_a_failure(self):
        with open("/dev/full", "wb") as full:
            done = self.run_program("simulate", self.scene(), "--frames", 1, code=1, stdout=full)
        self.assertIn("standard output", done.stderr)


class Unwritable(ProgramTest):
    def refused(self, output, *words):
        scene = self.scene(points=4)
        before = self.files()
        done = self.run_program("simulate", scene, "--frames", 2, "-o", output, code=1)
        self.assertIn(str(output), done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(self.files(), before)

    def test_a_folder_that_is_not_there(self):
        for extension in ("csv", "obj", "ply", "pc2"):
            self.refused(f"nowhere/a.{extension}", "there is no folder")

    def test_a_file_in_place_of_the_folder(self):
        self.write("file", "")
        self.refused("file/a.csv", "is not a folder")

    def test_a_folder_in_place_of_the_file(self):
        (self.folder / "a.csv").mkdir()
        self.refused("a.csv", "got a folder")

    @unittest.skipIf(hasattr(os, "geteuid") and os.geteuid() == 0, "root may write anywhere")
    def test_a_protected_folder(self):
        (self.folder / "closed").mkdir(mode=0o555)
        self.refused("closed/a.csv", "Permission denied")

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_a_full_disk(self):
        self.refused("/dev/full", "disk is full")
        for extension in ("csv", "obj", "ply", "pc2"):
            (self.folder / f"full.{extension}").symlink_to("/dev/full")
            self.refused(f"full.{extension}", "disk is full")

    @unittest.skipUnless(shutil.which("bash"), "no bash")
    def test_a_limit_on_the_size_of_files(self):
        scene = self.scene(points=30)
        for extension in ("csv", "obj", "ply", "pc2"):
            done = subprocess.run(["bash", "-c", f'ulimit -f 16; exec "$0" simulate scene.json --frames 3 --every 1 '
                                                 f'-o a.{extension}', os.path.abspath(PERCALE)],
                                  cwd=self.folder, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("larger than the system allows", done.stderr)
            self.assertEqual(self.files(), [scene.name])

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_a_mesh_that_does_not_fit_takes_its_cache_along(self):
        (self.folder / "a.pc2.obj").symlink_to("/dev/full")
        self.run_program("simulate", self.scene(), "--frames", 2, "-o", "a.pc2", code=1)
        self.assertEqual(self.files(), ["a.pc2.obj", "scene.json"])


class Divergence(ProgramTest):
    def test_the_step_the_cause_and_the_command(self):
        done = self.run_program("simulate", ROOT / "scene/pinned2.json", "--set", "simulation.steps_per_frame=1",
                                "--frames", 100, "--every", 5, "-o", "d.csv", code=4)
        for words in ("diverged in step", "vertex", "cause: ", "remedy: "):
            self.assertIn(words, done.stderr)
        frames = read_csv(self.folder / "d.csv")
        self.assertIn(5, frames)
        good = int(self.summary(done)["frames"].split(",")[0])
        self.assertEqual(max(frames), good)
        self.assertLess(good, 100)
        for rows in frames.values():
            for row in rows:
                for text in row[2:]:
                    self.assertTrue(math.isfinite(float(text)))
        command = next(line for line in done.stderr.splitlines() if "reproduce:" in line).split("reproduce: percale ")[1]
        again = subprocess.run(f'"{os.path.abspath(PERCALE)}" {command}', shell=True, cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=self.environment, text=True)
        self.assertEqual(again.returncode, 4)
        self.assertIn(f"(frame {good + 1})", again.stderr)

    def test_at_once(self):
        done = self.run_program("simulate", ROOT / "scene/pinned2.json", "--set", "cloth.density=10", "--set",
                                "cloth.ks=1e5", "--frames", 20, "-o", "d.pc2", code=4)
        self.assertIn("warning", done.stderr)
        _, _, frames = read_pc2(self.folder / "d.pc2")
        for frame in frames:
            for point in frame:
                self.assertTrue(all(map(math.isfinite, point)))


@unittest.skipIf(os.name == "nt", "POSIX signals")
class Interrupt(ProgramTest):
    def interrupted(self, output, *arguments):
        process = subprocess.Popen([os.path.abspath(PERCALE), *map(str, arguments), "-o", output, "--progress", "json"],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.environment,
                                   text=True, start_new_session=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
        first = process.stderr.readline()  # it is well under way
        self.assertIn("frame", first)
        time.sleep(0.1)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to the programs that it started, too
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, out + err)
        return out, err

    def test_simulate_keeps_what_was_done(self):
        out, err = self.interrupted("a.pc2", "simulate", self.scene(points=40), "--frames", 1000000)
        self.assertIn("interrupted after frame", err)
        self.assertIn("interrupted", out)
        _, _, frames = read_pc2(self.folder / "a.pc2")
        done = int(next(line for line in out.splitlines() if line.startswith("frames")).split()[1].rstrip(","))
        self.assertEqual(len(frames), done + 1)
        self.assertEqual(self.files(), ["a.pc2", "a.pc2.obj", "scene.json"])

    def test_simulate_writes_the_last_frame(self):
        self.interrupted("a.csv", "simulate", self.scene(points=40), "--frames", 1000000)
        self.assertEqual(len(read_csv(self.folder / "a.csv")), 1)
        self.assertEqual(self.files(), ["a.csv", "scene.json"])


if __name__ == "__main__":
    unittest.main()
