#!/usr/bin/env python3
"""Heat maps, overlays, the inspector and plots in the viewer."""

import csv
import os
import subprocess
import unittest

from window import PERCALE, ViewerTest, scene, state_hash


class HeatMaps(ViewerTest):
    def test_t_goes_through_them_all(self):
        with self.viewer(scene("sphere"), "--set", "cloth.num_width_points=20", "--set",
                         "cloth.num_height_points=20") as viewer:
            viewer.step()
            for name in ("stretch", "compression", "speed", "curvature", "contact", "off"):
                since = viewer.key("t", "heat_map")
                self.assertFalse(viewer.wait("heat_map", since, quantity=name)["fixed"])
            # Seeing changes nothing.
            self.assertEqual(viewer.step()["hash"], state_hash(
                scene("sphere"), 2, "--set", "cloth.num_width_points=20", "--set", "cloth.num_height_points=20"))
            self.assertEqual(viewer.stderr(), "")

    def test_the_panel_chooses_and_fixes_the_range(self):
        with self.viewer(scene("pinned2"), "--heat-map", "speed", "--heat-range", "0,2", "--size", "1024x1000") as viewer:
            for panel in ("Spring types", "Parameters", "Simulation", "Damping", "Gravity", "Appearance"):
                viewer.click("panel " + panel)
            viewer.click("panel Overlays")
            since = viewer.mark()
            viewer.type_into("heat map high box", "3.5")
            viewer.xdotool("keydown", "Return")
            try:
                typed = viewer.wait("heat_map", since, quantity="speed")
            finally:
                viewer.xdotool("keyup", "Return")
            self.assertEqual((typed["low"], typed["high"]), (0, 3.5))
            since = viewer.mark()
            viewer.click("heat map fixed")
            self.assertFalse(viewer.wait("heat_map", since)["fixed"])
            for name in ("normals", "pins", "contacts", "cones", "boxes"):
                since = viewer.mark()
                viewer.click("overlay " + name)
                self.assertTrue(viewer.wait("overlays", since)[name])
            viewer.step()
            self.assertEqual(viewer.stderr(), "")


class Contacts(ViewerTest):
    def test_forces_of_contact_and_what_passes_through_what(self):
        with self.viewer(scene("layers"), "--set", "simulation.engine=fabric", "--set",
                         "cloth.fabric=cotton") as viewer:
            for key, action in (("o", "contacts"), ("f", "cones")):
                since = viewer.key(key, action)
                self.assertTrue(viewer.wait("overlays", since)[action])
            viewer.step()
            self.assertEqual(viewer.wait("intersections")["count"], 0)
            self.assertEqual(viewer.stderr(), "")
        # Springs push points apart and not triangles: some frames do have intersections.
        with self.viewer(scene("layers")) as viewer:
            viewer.key("p", "pause")
            viewer.wait("intersections", where=lambda e: e["count"] > 0)


class Inspecting(ViewerTest):
    def test_the_vertex_under_the_pointer(self):
        with self.viewer(scene("selfCollision")) as viewer:
            viewer.point(320, 400)
            since = viewer.key("ctrl+i", "inspector")
            viewer.wait("inspector", since, visible=True)
            first = viewer.wait("inspect", since)
            self.assertEqual(first["cloth"], 0)
            viewer.wait("widget", since, name="inspector", where=lambda box: box["width"] > 100)
            since = viewer.mark()
            viewer.point(330, 300)
            second = viewer.wait("inspect", since)
            self.assertNotEqual(second["vertex"], first["vertex"])
            # Held, it stays with the vertex, wherever the pointer goes.
            since = viewer.key("ctrl+shift+i", "hold_vertex")
            viewer.wait("inspector", since, held=True)
            viewer.point(300, 450)
            viewer.step()
            self.assertEqual(viewer.count("inspect", since), 0)
            since = viewer.key("ctrl+i", "inspector")
            viewer.wait("widget", since, name="inspector", width=0)


class Plots(ViewerTest):
    def test_m_shows_them_and_the_button_writes_them(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.key("m", "plots")
            viewer.wait("plots", since, visible=True)
            for _ in range(5):
                viewer.step()
            files = []
            for _ in range(2):
                since = viewer.mark()
                viewer.click("plots export")
                files.append(viewer.wait("export", since)["file"])
            self.assertEqual(files, ["pinned2-plots-1.csv", "pinned2-plots-2.csv"])
            with open(os.path.join(viewer.folder, files[0]), encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([int(row["frame"]) for row in rows], [1, 2, 3, 4, 5])
            # The same as without a window, but for the times.
            table = os.path.join(viewer.folder, "headless.csv")
            subprocess.run([PERCALE, "simulate", scene("pinned2"), "--frames", "5", "--csv", table],
                           check=True, capture_output=True)
            with open(table, encoding="utf-8", newline="") as file:
                expected = list(csv.DictReader(file))
            columns = [name for name in expected[0] if name == "time_s" or not name.endswith("_s")]
            for row, other in zip(rows, expected):
                for name in columns:
                    if name != "stretch_p99" or row[name]:
                        self.assertEqual(row[name], other[name], name)
            self.assertTrue(rows[-1]["stretch_p99"])

            # Held plots stay at what they show.
            since = viewer.mark()
            viewer.click("plots hold")
            viewer.wait("plots", since, held=True)
            viewer.step()
            since = viewer.mark()
            viewer.click("plots export")
            with open(os.path.join(viewer.folder, viewer.wait("export", since)["file"]), encoding="utf-8") as file:
                self.assertEqual(len(file.readlines()), 6)
            since = viewer.key("m", "plots")
            viewer.wait("plots", since, visible=False)
            self.assertEqual(viewer.stderr(), "")

    def test_after_a_reset_they_begin_again(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.key("m", "plots")
            for _ in range(3):
                viewer.step()
            viewer.key("r", "reset")
            viewer.step()
            since = viewer.mark()
            viewer.click("plots export")
            with open(os.path.join(viewer.folder, viewer.wait("export", since)["file"]), encoding="utf-8") as file:
                self.assertEqual(len(file.readlines()), 2)


if __name__ == "__main__":
    unittest.main()
