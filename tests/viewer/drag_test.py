#!/usr/bin/env python3
"""A sheet is dragged by hand for a while, through a sphere and through itself: nothing ever passes through anything.

PERCALE_DRAG_SECONDS: how long, by the clock.
"""

import json
import math
import os
import random
import subprocess
import tempfile
import time
import unittest

from window import PERCALE, ViewerTest

SECONDS = float(os.environ.get("PERCALE_DRAG_SECONDS", 20))
SPEED = 900    # of the hand [pixel/s]; a metre is some 500
PERIOD = 0.02  # between two of its moves [s]

SCENE = {
    "simulation": {"engine": "fabric"},
    "cloth": {"fabric": "cotton", "width": 0.8, "height": 0.8, "num_width_points": 30, "num_height_points": 30,
              "orientation": 1, "origin": [0, 0.2, 0], "pinned": [[0, 29], [29, 29]]},
    "sphere": {"origin": [0.4, 0.25, 0.12], "radius": 0.1, "friction": 0.3},
    "camera": {"target": [0.4, 0.5, 0], "distance": 1.9, "azimuth": 35, "elevation": 10},
    "look": {"shader": "Fabric"},
}


class DragTest(ViewerTest):
    def test_dragged_through_a_sphere_and_itself_nothing_passes_through_anything(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "drag.json")
            with open(path, "w", encoding="ascii") as file:
                json.dump(SCENE, file)
            cache = os.path.join(folder, "drag.pc2")
            with self.viewer(path, "--history", "0") as viewer:
                grips, states = self.drag_about(viewer)
                self.run_program("replay", viewer.log, "-o", cache)
            judged = self.run_program("check", "--intersections", cache)
            print(f"{grips} drags, {states[-1]['frame']} frames, the slowest of {max(s['ms'] for s in states):.0f} ms, "
                  f"greatest stretch {max(s['stretch'] for s in states):.2f}; {judged}", flush=True)
            self.assertGreater(grips, SECONDS / 10)
            self.assertGreater(states[-1]["frame"], 2 * SECONDS)
            self.assertLess(max(state["stretch"] for state in states), 4)
            self.assertRegex(judged, r"drag\.pc2: \d+ frames, 0 intersections")

    def drag_about(self, viewer):
        """Drags at random for a while; returns how often there was cloth to drag, and the states."""
        width, height = viewer.box("panels")["x"], viewer.start["height"]
        chance, grips = random.Random(5), 0
        viewer.key("p", "pause")
        end = time.monotonic() + SECONDS
        viewer.xdotool("keydown", "shift")
        while time.monotonic() < end:
            # From where the sheet mostly is, on over it and the sphere.
            way = [(chance.uniform(0.3, 0.7) * width, chance.uniform(0.35, 0.7) * height)]
            way += [(chance.uniform(0.15, 0.85) * width, chance.uniform(0.15, 0.85) * height)
                    for _ in range(chance.randint(2, 5))]
            grips += self.drag(viewer, way)
        viewer.xdotool("keyup", "shift")
        viewer.key("p", "pause")
        viewer.settle()
        self.assertEqual(viewer.count("message", severity="error"), 0)
        viewer.xdotool("key", "Escape")
        self.assertEqual(viewer.ended(), 0)
        # What the status line has told; the judge of what was recorded comes later.
        self.assertEqual({event["count"] for event in viewer.events if event["event"] == "intersections"}, {0})
        return grips, [event for event in viewer.events if event["event"] == "state"]

    def drag(self, viewer, way):
        """From point to point, at the speed of a hand. Returns whether cloth came along."""
        since = viewer.mark()
        commands = ["mousemove", "--window", viewer.window, round(way[0][0]), round(way[0][1]), "mousedown", 1]
        for a, b in zip(way, way[1:]):
            steps = max(1, round(math.dist(a, b) / SPEED / PERIOD))
            for i in range(1, steps + 1):
                at = [round(p + (q - p) * i / steps) for p, q in zip(a, b)]
                commands += ["sleep", PERIOD, "mousemove", "--window", viewer.window, *at]
        viewer.xdotool(*commands, "mouseup", 1)
        viewer.update()
        return viewer.find("handles", since, lambda event: len(event["handles"]) > 0) is not None

    def run_program(self, *arguments):
        done = subprocess.run([PERCALE, *arguments], capture_output=True, text=True, timeout=900)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout


if __name__ == "__main__":
    unittest.main()
