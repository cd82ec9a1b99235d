#!/usr/bin/env python3
"""The hand in the picture: dragging, pinning, colliders, balls, gusts; undo, history, and the replay of it
all from the session log, to the bit."""

import json
import math
import os
import subprocess
import tempfile
import unittest

from window import PERCALE, ViewerTest, scene


class Eye:
    """Where points of the scene are in the picture, by the course's camera (render/camera.h)."""

    def __init__(self, viewer, target=(0.5, 0.5, 0.5), distance=1.8):
        self.width, self.height = viewer.box("panels")["x"], viewer.start["height"]
        self.target, self.distance = target, distance
        vertical, horizontal = (math.tan(math.radians(a) / 2) for a in (35, 50))
        self.top = max(vertical, horizontal * self.height / self.width)

    def at(self, x, y, z):
        depth = self.target[2] + self.distance - z
        right, up = x - self.target[0], y - self.target[1]
        return (self.width / 2 * (1 + right / depth / self.top * self.height / self.width),
                self.height / 2 * (1 - up / depth / self.top))


class HandTest(ViewerTest):
    def drag(self, viewer, begin, end, steps=8, shift=True):
        since = viewer.mark()
        viewer.point(*begin)
        if shift:
            viewer.xdotool("keydown", "shift")
        viewer.xdotool("mousedown", 1)
        for i in range(1, steps + 1):
            viewer.point(*(b + (e - b) * i / steps for b, e in zip(begin, end)))
            viewer.xdotool("sleep", "0.03")
        viewer.xdotool("mouseup", 1)
        if shift:
            viewer.xdotool("keyup", "shift")
        return since

    def click(self, viewer, at):
        since = viewer.mark()
        viewer.point(*at)
        viewer.xdotool("keydown", "shift", "click", 1, "keyup", "shift")
        return since

    def replay(self, log, *arguments):
        return subprocess.run([PERCALE, "replay", log, *arguments], capture_output=True, text=True, timeout=300)

    def done(self, viewer, line):
        return viewer.wait("done", command=line["command"])

    def test_everything_that_a_hand_does_is_logged_undone_and_replayed(self):
        # Without gravity the cloth is where it is looked for, however late the hand comes.
        with self.viewer("-f", scene("pinned2"), "--shader", "Normal", "--history", "64", "--set",
                         "simulation.gravity=[0,0,0]", "--set", "cloth.damping=2") as viewer:
            eye = Eye(viewer)
            start = viewer.start["hash"]

            # Pinned and let go; both undone, one after the other.
            at = eye.at(0.25, 1, 0.7)
            for expected in (3, 2):
                since = self.click(viewer, at)
                pinned = viewer.wait("set", since, path="/cloth/0/pinned")
                self.assertEqual(len(pinned["value"]), expected)
            for expected in (3, 2):
                since = viewer.key("ctrl+z", "undo")
                settings = viewer.wait("settings", since)
                self.assertEqual(len(json.loads(settings["config"])["cloth"]["pinned"]), expected)
            viewer.key("ctrl+y", "redo")
            viewer.settle()

            # Paused: the cloth is where the hand puts it, at once.
            since = self.drag(viewer, eye.at(0.5, 1, 0.8), eye.at(0.5, 1.1, 0.8))
            place = viewer.wait("place", since, where=lambda e: not e.get("undoable"))
            vertex = place["handles"][0]["vertex"]
            self.assertAlmostEqual(vertex % 50 / 49, 0.5, delta=0.03)
            self.assertAlmostEqual(vertex // 50 / 49, 0.8, delta=0.05)
            viewer.settle()
            self.assertEqual(viewer.state()["frame"], 0)
            self.assertNotEqual(viewer.state()["hash"], start)
            since = viewer.key("ctrl+z", "undo")
            viewer.settle()
            viewer.wait("state", since, hash=start)
            viewer.key("ctrl+y", "redo")
            viewer.settle()
            self.assertNotEqual(viewer.state()["hash"], start)

            # Running: it is drawn along.
            viewer.key("p", "pause")
            viewer.wait("state", where=lambda e: e["frame"] > 5)
            since = self.drag(viewer, eye.at(0.5, 1, 0.3), eye.at(0.6, 1.1, 0.3))
            handles = viewer.wait("handles", since)
            self.assertTrue(handles["undoable"])
            viewer.wait("handles", since, handles=[])
            viewer.key("x", "ball")
            viewer.wait("ball")
            viewer.key("g", "gust")
            gust = viewer.wait("gust")
            frame = self.done(viewer, gust)["frame"]
            viewer.wait("state", where=lambda e: e["frame"] > frame + 20)
            since = viewer.key("p", "pause")
            viewer.wait("run", since, running=False)
            viewer.settle()

            # Through the history, and on from there.
            last = viewer.state()["frame"]
            since = viewer.key("comma", "step_back")
            seek = viewer.wait("seek", since)
            self.assertEqual(seek["frame"], last - 1)
            viewer.key("comma", "step_back")
            viewer.key("period", "step_forward")
            viewer.settle()
            self.assertEqual(viewer.state()["frame"], last - 1)
            since = viewer.key("l", "loop")
            viewer.wait("loop", since)
            viewer.wait("state", since, where=lambda e: e["frame"] < last - 5)
            viewer.key("p", "pause")
            viewer.settle()
            viewer.step()
            since = viewer.key("r", "reset")
            viewer.settle()
            self.assertEqual(viewer.state()["frame"], 0)
            since = viewer.key("ctrl+z", "undo")
            viewer.settle()
            self.assertGreater(viewer.state()["frame"], 0)
            viewer.step()
            self.assertEqual(viewer.count("message", severity="error"), 0)
            end = viewer.state()["hash"]
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)

            replayed = self.replay(viewer.log)
            self.assertEqual(replayed.returncode, 0, replayed.stderr)
            self.assertIn(f"state   {end}", replayed.stdout)
            self.assertEqual(self.replay(viewer.log, "--threads", "2").stdout, replayed.stdout)
            self.broken_logs(viewer.log)

    def broken_logs(self, log):
        """What a log can have suffered, and what is said about it."""
        with open(log, encoding="utf-8") as file:
            lines = file.read().splitlines()

        def play(changed, text=None):
            name = log + ".changed"
            with open(name, "w", encoding="utf-8") as file:
                file.write(text if text is not None else "\n".join(changed) + "\n")
            return self.replay(name)

        def change(kind, edit):
            """The lines, with the last of that kind edited."""
            changed = list(lines)
            at = max(i for i, line in enumerate(lines) if json.loads(line)["event"] == kind)
            event = json.loads(lines[at])
            edit(event)
            changed[at] = json.dumps(event)
            return at + 1, changed

        number, changed = change("state", lambda e: e.update(hash="0123456789abcdef"))
        result = play(changed)
        self.assertEqual(result.returncode, 1)
        self.assertIn(f":{number}: the log tells frame", result.stderr)

        number, changed = change("ball", lambda e: e.update(velocity=[0, 0, -1]))
        self.assertEqual(play(changed).returncode, 1)

        for kind, edit, message in (
                ("ball", lambda e: e.update(radius=-1), "radius: expected a number > 0 m, got -1"),
                ("ball", lambda e: e.pop("mass"), "mass: expected a number, got nothing"),
                ("gust", lambda e: e.update(drag="much"), "drag: expected a number"),
                ("set", lambda e: e.update(value=[[99, 99]]), "99"),
                ("seek", lambda e: e.update(frame=1.5), "frame: expected a whole number"),
                ("start", lambda e: e.update(log=1), "version 1"),
                ("start", lambda e: e.update(config="{}"), "cloth"),
                ("done", lambda e: e.update(command=987654), "was never given")):
            number, changed = change(kind, edit)
            result = play(changed)
            self.assertEqual(result.returncode, 3, (kind, result.stderr))
            self.assertIn(message, result.stderr)
            self.assertIn(f":{number}", result.stderr)

        result = play(lines[:len(lines) // 2])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("breaks off", result.stderr)
        result = play(None, "\n".join(lines)[:-200])
        self.assertEqual(result.returncode, 0, result.stderr)
        for text in ("", "hello\n", "[]\n", '{"event":"state"}\n', "\0\0\0\n", '{"event":"start"}'):
            result = play(None, text)
            self.assertEqual(result.returncode, 3, (text, result.stderr))
        self.assertEqual(self.replay(os.path.dirname(log)).returncode, 3)
        self.assertEqual(self.replay(log + ".missing").returncode, 3)

    def test_spheres_and_planes_are_moved_by_the_body_and_by_the_gizmo(self):
        with self.viewer("-f", scene("sphere"), "--shader", "Phong") as viewer:
            eye = Eye(viewer)
            since = self.drag(viewer, eye.at(0.5, 0.2, 0.6), eye.at(0.7, 0.3, 0.6))
            moved = viewer.wait("set", since, path="/sphere/0/origin", where=lambda e: e["value"][0] > 0.65)
            viewer.settle()
            origin = [e for e in viewer.events if e["event"] == "set"][-1]["value"]
            self.assertGreater(origin[1], 0.25)
            self.assertAlmostEqual(origin[2], 0.5, delta=1e-6)
            # By the arrow: along x alone.
            x, y = eye.at(*origin)
            since = self.drag(viewer, (x + 50, y), (x - 70, y - 40), shift=False)
            moved = viewer.wait("set", since, path="/sphere/0/origin")
            viewer.settle()
            last = [e for e in viewer.events if e["event"] == "set"][-1]["value"]
            self.assertLess(last[0], origin[0] - 0.1)
            self.assertEqual(last[1:], origin[1:])
            self.assertEqual(viewer.count("camera", since), 0)
            # Each drag is one change.
            since = viewer.key("ctrl+z", "undo")
            first = json.loads(viewer.wait("settings", since)["config"])["sphere"]["origin"]
            self.assertEqual(first, origin)
            since = viewer.key("ctrl+z", "undo")
            first = json.loads(viewer.wait("settings", since)["config"])["sphere"]["origin"]
            self.assertEqual(first, [0.5, 0.2, 0.5])
            del moved
        with self.viewer("-f", scene("plane"), "--shader", "Phong") as viewer:
            eye = Eye(viewer)
            since = self.drag(viewer, eye.at(0.5, 0, 1.2), eye.at(0.5, 0.1, 1.2))
            moved = viewer.wait("set", since, path="/plane/0/point", where=lambda e: e["value"][1] > 0.05)
            self.assertEqual([moved["value"][0], moved["value"][2]], [0, 0])

    def test_colliders_of_other_shapes_are_moved_as_spheres_are(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "wall.obj"), "w", encoding="ascii") as file:
                file.write("v 0 0 0\nv 0.3 0 0\nv 0.3 0.3 0\nv 0 0.3 0\nf 1 2 3 4\n")
            path = os.path.join(folder, "a.json")
            with open(path, "w", encoding="ascii") as file:
                # The box has been turned by half a turn about (0.5, 0.5) when the time is over: what follows the
                # pointer to the right is its position to the left.
                json.dump({"simulation": {"engine": "fabric", "gravity": [0, 0, 0]},
                           "cloth": {"origin": [0, 5, 0], "num_width_points": 4, "num_height_points": 4},
                           "collider": [{"shape": "box", "position": [0.8, 0.3, 0], "size": [0.2, 0.2, 0.2]},
                                        {"shape": "mesh", "mesh": "wall.obj", "position": [0.6, 0.1, 0],
                                         "two_sided": True},
                                        {"shape": "torus", "position": [0.2, 0.2, 0], "rotation": [90, 0, 0],
                                         "radius": 0.15}],
                           "collider_motion": {"end": 0.01, "axis": [0, 0, 1], "angle": 180, "centre": [0.5, 0.5, 0]},
                           "camera": {"target": [0.5, 0.5, 0], "distance": 2}}, file)
            with self.viewer(path, "--shader", "Phong") as viewer:
                viewer.step()
                eye = Eye(viewer, (0.5, 0.5, 0), 2)
                since = self.drag(viewer, eye.at(0.2, 0.7, 0.1), eye.at(0.3, 0.7, 0.1))
                viewer.wait("set", since, path="/collider/0/position", where=lambda e: e["value"][0] < 0.75)
                viewer.settle()
                position = [e for e in viewer.events if e["event"] == "set"][-1]["value"]
                for found, expected in zip(position, (0.7, 0.3, 0)):
                    self.assertAlmostEqual(found, expected, delta=0.01)
                since = self.drag(viewer, eye.at(0.75, 0.25, 0), eye.at(0.75, 0.35, 0))
                moved = viewer.wait("set", since, path="/collider/1/position", where=lambda e: e["value"][1] > 0.15)
                self.assertAlmostEqual(moved["value"][0], 0.6, delta=0.01)
                # Through the hole one grips nothing, but the tube.
                since = self.drag(viewer, eye.at(0.2, 0.2, 0), eye.at(0.3, 0.2, 0))
                viewer.settle()
                self.assertEqual(viewer.count("set", since), 0)
                since = self.drag(viewer, eye.at(0.2, 0.35, 0.05), eye.at(0.3, 0.35, 0.05))
                viewer.wait("set", since, path="/collider/2/position", where=lambda e: e["value"][0] > 0.25)

    def test_a_mesh_is_pinned_and_dragged_as_a_grid_is(self):
        # A standing square of four triangles around vertex 1; vertex 0 belongs to nothing.
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "a.obj"), "w", encoding="ascii") as file:
                file.write("v 9 9 9\nv 0.5 0.5 0\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                           "g all\nf 2 3 4\nf 2 4 5\nf 2 5 6\nf 2 6 3\n")
            path = os.path.join(folder, "a.json")
            with open(path, "w", encoding="ascii") as file:
                json.dump({"simulation": {"engine": "fabric", "gravity": [0, 0, 0]},
                           "cloth": {"shape": "mesh", "mesh": "a.obj", "pinned_group": "all"},
                           "camera": {"target": [0.5, 0.5, 0], "distance": 2}}, file)
            with self.viewer("-f", path, "--shader", "Normal") as viewer:
                eye = Eye(viewer, (0.5, 0.5, 0), 2)
                since = self.click(viewer, eye.at(0.52, 0.5, 0))
                settings = json.loads(viewer.wait("settings", since)["config"])["cloth"]
                self.assertEqual(settings["pinned_group"], "")
                self.assertEqual(settings["pinned"], [[2, 0], [3, 0], [4, 0], [5, 0]])
                since = self.click(viewer, eye.at(0.52, 0.5, 0))
                self.assertIn([1, 0], viewer.wait("set", since, path="/cloth/0/pinned")["value"])
                since = self.click(viewer, eye.at(0.52, 0.5, 0))
                self.assertNotIn([1, 0], viewer.wait("set", since, path="/cloth/0/pinned")["value"])
                start = viewer.start["hash"]
                since = self.drag(viewer, eye.at(0.5, 0.5, 0), eye.at(0.6, 0.6, 0))
                self.assertEqual(viewer.wait("place", since)["handles"][0]["vertex"], 0)
                viewer.settle()
                self.assertNotEqual(viewer.state()["hash"], start)
                self.assertEqual(viewer.count("message", severity="error"), 0)
                end = viewer.state()["hash"]
                viewer.xdotool("key", "Escape")
                self.assertEqual(viewer.ended(), 0)
                replayed = self.replay(viewer.log)
                self.assertEqual(replayed.returncode, 0, replayed.stderr)
                self.assertIn(f"state   {end}", replayed.stdout)


if __name__ == "__main__":
    unittest.main()
