"""percale check --intersections: caches, meshes and scenes, against exact arithmetic of Python's whole numbers."""

import itertools
import math
import re
import struct
import unittest
from fractions import Fraction

from program import ROOT, ProgramTest, cloth

LINE = re.compile(r"frame (\d+): (\d+) intersections?, first: edge (\d+)-(\d+) of cloth (\d+) through triangle (\d+)"
                  r"(?: of cloth (\d+))? at \((\S+), (\S+), (\S+)\)")


def determinant(a, b, c, d):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = ([p[k] - d[k] for k in range(3)] for p in (a, b, c))
    return ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)


def sign(x):
    return (x > 0) - (x < 0)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def meets(p, q, a, b, c):
    """Whether a segment meets a triangle."""
    above, below = sign(determinant(a, b, c, p)), sign(determinant(a, b, c, q))
    if above * below > 0:
        return False
    sides = ((a, b), (b, c), (c, a))
    if above or below:
        return not {1, -1} <= {sign(determinant(p, q, *side)) for side in sides}
    # In one plane: what is left of the segment within all three sides.
    normal = cross([b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)])
    first, last = Fraction(0), Fraction(1)
    for start, end in sides:
        inward = cross(normal, [end[k] - start[k] for k in range(3)])
        at_p, at_q = (sum(inward[k] * (x[k] - start[k]) for k in range(3)) for x in (p, q))
        if at_p < 0 and at_q < 0:
            return False
        if at_p < 0:
            first = max(first, Fraction(at_p, at_p - at_q))
        elif at_q < 0:
            last = min(last, Fraction(at_p, at_p - at_q))
    return first <= last


def brute_force(vertices, triangles):
    """All (edge, triangle) of a mesh that intersect, in order."""
    # To whole numbers: all doubles here are multiples of 2^-200, or so small that they make no difference to them.
    points = [[int(Fraction(x) * 2**200) for x in v] for v in vertices]
    edges = sorted({tuple(sorted(e)) for t in triangles for e in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))})
    found = []
    for edge, (index, t) in itertools.product(edges, enumerate(triangles)):
        if not set(edge) & set(t):
            boxes = [[sorted(points[v][k] for v in part) for k in range(3)] for part in (edge, t)]
            if all(e[0] <= f[-1] and f[0] <= e[-1] for e, f in zip(*boxes)):
                if meets(*(points[v] for v in (*edge, *t))):
                    found.append((edge, index))
    return found


def read_ply(path):
    head, body = path.read_bytes().split(b"end_header\n", 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element")}
    vertex, face = struct.Struct("<3d5f"), struct.Struct("<B3i")
    vertices = [vertex.unpack_from(body, i * vertex.size)[:3] for i in range(counts["vertex"])]
    start = vertex.size * len(vertices)
    return vertices, [face.unpack_from(body, start + i * face.size)[1:] for i in range(counts["face"])]


class Intersections(ProgramTest):
    def crossing(self, name="crossing.json", points=9):
        """A sheet that lies, and one that stands across it."""
        lying, standing = cloth(points), cloth(points, orientation=1, origin=[0.0131, 0.4527, 0.4373])
        return self.write(name, {"cloth": [lying, standing]})

    def check_file(self, *files, code=0):
        done = self.run_program("check", "--intersections", *files, code=code)
        lines = done.stdout.splitlines()
        return done, [LINE.fullmatch(line) for line in lines[:-1]], lines[-1] if lines else ""

    def test_none(self):
        scene = self.scene(points=8)
        self.run_program("simulate", scene, "--frames", 20, "--every", 5, "-o", "film.pc2")
        done, lines, last = self.check_file("film.pc2")
        self.assertEqual((lines, last, done.stderr), ([], "film.pc2: 5 frames, 0 intersections", ""))
        self.assertEqual(self.check_file(scene)[2], f"{scene}: 1 frame, 0 intersections")

    def test_the_count_and_the_first_are_those_of_exact_arithmetic(self):
        scene = self.crossing()
        self.run_program("simulate", scene, "--frames", 6, "--every", 3, "-o", "m.ply")
        done, lines, last = self.check_file("m.ply", code=1)
        self.assertEqual([int(line[1]) for line in lines], [0, 3, 6])
        total = 0
        for line in lines:
            vertices, triangles = read_ply(self.folder / f"m_000{line[1]}.ply")
            found = brute_force(vertices, triangles)
            self.assertGreater(len(found), 10)
            self.assertEqual(int(line[2]), len(found))
            self.assertEqual(((int(line[3]), int(line[4])), int(line[6])), found[0])
            total += len(found)
            # The place is on the edge.
            place = [float(line[k]) for k in (8, 9, 10)]
            p, q = (vertices[int(line[k])] for k in (3, 4))
            self.assertAlmostEqual(math.dist(p, place) + math.dist(place, q), math.dist(p, q), delta=1e-5)
        self.assertEqual(last, f"m.ply: 3 frames, {total} intersections")

    def test_scenes_and_all_formats_agree(self):
        scene = self.crossing()
        start = self.check_file(scene, code=1)[1]
        self.assertEqual((start[0][1], start[0][5], start[0][7]), ("0", "0", "1"))
        for name in ("a.pc2", "b.obj", "c.ply"):
            self.run_program("simulate", scene, "--frames", 0, "-o", name)
            _, lines, last = self.check_file(name, code=1)
            self.assertEqual([line[2] for line in lines], [start[0][2]])
            self.assertEqual(last, f"{name}: 1 frame, {start[0][2]} intersections")
            if name != "c.ply":  # which does not tell cloths apart
                self.assertEqual([line[k] for line in lines for k in (3, 4, 5, 6, 7)], [start[0][k] for k in (3, 4, 5, 6, 7)])

    def test_cloths_that_come_to_intersect(self):
        # Without thickness nothing holds them apart.
        falling = cloth(9, pinned=[], origin=[0.11, 0.02, 0.13], thickness=0)
        scene = self.write("s.json", {"cloth": [cloth(9, thickness=0), falling]})
        self.assertEqual(self.check_file(scene)[1], [])
        self.run_program("simulate", scene, "--frames", 30, "--every", 1, "-o", "f.pc2")
        _, lines, last = self.check_file("f.pc2", code=1)
        frames = [int(line[1]) for line in lines]
        self.assertGreater(frames[0], 0)
        self.assertEqual(frames, sorted(set(frames)))
        self.assertEqual(last, f"f.pc2: 31 frames, {sum(int(line[2]) for line in lines)} intersections")

    def test_touching_counts_and_a_gap_does_not(self):
        flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv {0} 0.25 0.25\nv 1 1 1\nv 1 2 1\nf 1 2 3\nf 4 5 6\n"
        tip = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.25 0.25 {0}\nv 1 1 1\nv 1 2 1\nf 1 2 3\nf 4 5 6\n"
        self.write("touch.obj", tip.format(0))
        self.write("gap.obj", tip.format("1e-80"))
        self.write("through.obj", tip.format("-1e-80"))
        self.write("flat.obj", flat.format(0))
        _, lines, last = self.check_file("touch.obj", code=1)
        self.assertEqual((last, lines[0][0]), ("touch.obj: 1 frame, 2 intersections",
                         "frame 0: 2 intersections, first: edge 3-4 of cloth 0 through triangle 0 at (0.25, 0.25, 0)"))
        self.assertEqual(self.check_file("gap.obj")[2], "gap.obj: 1 frame, 0 intersections")
        self.assertEqual(self.check_file("through.obj", code=1)[2], "through.obj: 1 frame, 2 intersections")

    def test_threads_make_no_difference(self):
        scene = self.crossing(points=30)
        one = self.run_program("check", "--intersections", scene, "--threads", 1, code=1).stdout
        for threads in (2, 3, 8):
            self.assertEqual(self.run_program("check", "--intersections", scene, "--threads", threads, code=1).stdout, one)

    def test_several_files_and_the_worst_code(self):
        good, bad = self.scene(points=5), self.crossing(points=5)
        self.write("broken.json", "{")
        self.write("table.csv", "frame,cloth,vertex,x,y,z\n")
        done = self.run_program("check", "--intersections", good, bad, code=1)
        self.assertIn("scene.json: 1 frame, 0 intersections\nframe 0: ", done.stdout)
        done = self.run_program("check", "--intersections", bad, "broken.json", "table.csv", good, code=3)
        self.assertIn("scene.json: 1 frame, 0 intersections\n", done.stdout)
        self.assertIn("broken.json", done.stderr)
        self.assertIn("table.csv: error: a table of points has no triangles; write the frames to .pc2, .obj or .ply", done.stderr)
        # Without the option the same scene is fine.
        self.assertIn("crossing.json: ok", self.run_program("check", bad).stdout)

    def test_the_scene_is_the_one_that_the_options_make(self):
        scene = self.crossing()
        apart = self.run_program("check", "--intersections", scene, "--set", "cloth.1.origin=[0,5,0]")
        self.assertIn("0 intersections", apart.stdout)
        self.assertIn("pinned2.json: 1 frame, 0 intersections",
                      self.run_program("check", "--intersections", "-r", ROOT).stdout)

    def test_what_cannot_be_judged(self):
        self.run_program("simulate", self.scene(points=5), "--frames", 4, "--every", 1, "-o", "a.pc2")
        data, mesh = ((self.folder / name).read_bytes() for name in ("a.pc2", "a.pc2.obj"))

        def case(name, content, beside, *expected):
            (self.folder / name).write_bytes(content)
            if beside is not None:
                (self.folder / f"{name}.obj").write_bytes(beside)
            done = self.run_program("check", "--intersections", name, code=3)
            for words in (name, "error: ", *expected):
                self.assertIn(words, done.stderr)
            return done

        case("cut.pc2", data[:-1], mesh, "5 frames of 25 points", "cut short or damaged")
        case("short.pc2", data[:20], mesh, "ends after 20 bytes, expected a PointCache2 header")
        case("huge.pc2", data[:16] + b"\xff\xff\xff\x7f" + data[20:28] + b"\xff\xff\xff\x7f" + data[32:], mesh, "2147483647")
        case("alone.pc2", data, None, "alone.pc2.obj: error: there is no such file")
        case("other.pc2", data, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "as \"other.pc2.obj\" has vertices, 3, got 25")
        at = 32 + 12 * (25 * 2 + 7)
        done = case("nan.pc2", data[:at] + b"\x00\x00\xc0\x7f" + data[at + 4:], mesh, "frame 2, point 7: expected a coordinate")
        self.assertEqual(done.stdout, "nan.pc2: 2 frames, 0 intersections\n", "what was judged is told")
        case("far.pc2", data[:at] + struct.pack("<f", 1e30) + data[at + 4:], mesh, "within 1000 km")
        case("empty.obj", b"", None, "the file is empty")
        case("nan.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", None, "nan.obj:1:3: error: ")
        case("twice.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n", None, "the same vertex twice")
        case("lie.ply", b"ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nend_header\n1\n", None)
        case("device.xyz", b"", None)
        for name in ("nowhere.pc2", "nowhere.obj", "nowhere.json"):
            self.assertIn(name, self.run_program("check", "--intersections", name, code=3).stderr)

    def test_a_mesh_that_was_cut_is_told(self):
        self.run_program("simulate", self.scene(points=5), "--frames", 1, "-o", "a.pc2")
        mesh = self.folder / "a.pc2.obj"
        mesh.write_bytes(mesh.read_bytes()[:-90])
        done = self.check_file("a.pc2")[0]
        self.assertIn("does not end in a line break", done.stderr)
        mesh.write_text(mesh.read_text().rsplit("\n", 5)[0] + "\n")
        self.assertIn("a.pc2.obj: warning: 5 vertices are of no triangle; the file may have been cut short",
                      self.check_file("a.pc2")[0].stderr)

    def test_a_series_of_meshes_is_of_one_mesh(self):
        self.run_program("simulate", self.scene(points=5), "--frames", 4, "--every", 2, "-o", "m.obj")
        self.assertEqual(self.check_file("m.obj")[2], "m.obj: 3 frames, 0 intersections")
        self.assertEqual(self.check_file("m_0002.obj")[2], "m_0002.obj: 1 frame, 0 intersections")
        self.write("m_0003.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        done = self.run_program("check", "--intersections", "m.obj", code=3)
        self.assertIn('m_0003.obj: error: expected the mesh of "m_0000.obj"', done.stderr)
        self.assertEqual(done.stdout, "m.obj: 2 frames, 0 intersections\n")


if __name__ == "__main__":
    unittest.main()
