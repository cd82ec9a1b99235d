#!/usr/bin/env python3
"""What the viewer keeps from one start to the next; hints and tooltips; dense displays and small windows."""

import json
import os
import tempfile
import unittest

from window import Display, Viewer, ViewerTest, scene


class Settings(ViewerTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.config = os.path.join(self.folder, "config")
        self.file = os.path.join(self.config, "viewer.json")

    def open(self, *arguments):
        return self.viewer(*arguments, environment={"PERCALE_CONFIG_DIR": self.config})

    def quit(self, viewer):
        viewer.xdotool("key", "Escape")
        self.assertEqual(viewer.ended(), 0, viewer.stderr())

    def kept(self):
        with open(self.file, encoding="utf-8") as file:
            return json.load(file)

    def test_the_next_start_is_as_the_last_was_left(self):
        with self.open(scene("pinned2")) as viewer:
            since = viewer.mark()
            viewer.xdotool("windowmove", viewer.window, 60, 40)
            viewer.xdotool("windowsize", viewer.window, 900, 700)
            viewer.wait("window", since, width=900, height=700)
            viewer.click("panel Spring types")
            viewer.wait("panel", since, name="Spring types", open=False)
            viewer.key("c", "console")
            viewer.key("braceright", "next_scene")
            opened = viewer.wait("open", since)["scene"]
            viewer.wait("widget", since, name="console", where=lambda box: box["width"] > 0)
            self.quit(viewer)
        kept = self.kept()
        self.assertEqual(kept["recent_scenes"], [opened, scene("pinned2")])
        with self.open(scene("sphere")) as viewer:
            self.assertEqual((viewer.start["width"], viewer.start["height"]), (900, 700))
            geometry = viewer.xdotool("getwindowgeometry", viewer.window)
            self.assertIn("Position: 60,40", geometry)
            viewer.box("console")
            viewer.box("panel Spring types")
            self.assertIsNone(viewer.find("widget", name="cloth.enable_bending"))
            # A recent scene from the panel.
            viewer.click("panel Scenes")
            viewer.click("recent scene")
            since = viewer.mark()
            viewer.click("recent scene/" + scene("pinned2"))
            self.assertEqual(viewer.wait("open", since)["scene"], scene("pinned2"))
            viewer.key("Tab", "panels")
            self.quit(viewer)
        # What is asked for wins, hidden panels stay hidden.
        with self.hidden_panels("--size", "800x600") as viewer:
            self.assertEqual((viewer.start["width"], viewer.start["height"]), (800, 600))

    def hidden_panels(self, *arguments):
        """A viewer that starts without panels, so that its first control is none of theirs."""
        viewer = self.open(scene("pinned2"), *arguments)
        viewer.first = "console"
        return viewer

    def test_fresh(self):
        with self.open(scene("pinned2")) as viewer:
            viewer.key("c", "console")
            self.quit(viewer)
        before = self.kept()
        with self.open(scene("sphere"), "--fresh") as viewer:
            viewer.key("c", "console")
            self.quit(viewer)
            self.assertEqual([event["visible"] for event in viewer.events if event["event"] == "console"], [True])
        self.assertEqual(self.kept(), before)

    def test_a_broken_file_is_a_warning(self):
        os.makedirs(self.config)
        for text in ("{", '{"panels_visible": 3, "window": {"x": 90000, "width": 1, "height": 1}}'):
            with open(self.file, "w", encoding="utf-8") as file:
                file.write(text)
            with self.open(scene("pinned2")) as viewer:
                self.assertIn("warning", viewer.stderr())
                self.assertIn("viewer.json:1:", viewer.stderr())
                self.quit(viewer)
            self.assertTrue(self.kept()["panels_visible"])

    def test_a_folder_that_cannot_be_written(self):
        with open(self.config, "w", encoding="utf-8") as file:
            file.write("no folder")
        with self.open(scene("pinned2")) as viewer:
            self.quit(viewer)
            self.assertIn("warning", viewer.stderr())
            self.assertIn("for the next start is lost", viewer.stderr())

    def test_a_window_that_would_be_off_the_screen(self):
        os.makedirs(self.config)
        with open(self.file, "w", encoding="utf-8") as file:
            json.dump({"window": {"x": 9000, "y": -4000, "width": 700, "height": 500}}, file)
        with self.open(scene("pinned2")) as viewer:
            self.assertEqual((viewer.start["width"], viewer.start["height"]), (700, 500))
            geometry = viewer.xdotool("getwindowgeometry", viewer.window)
            self.assertNotIn("9000", geometry)

    def test_hints_until_their_keys_were_used(self):
        with self.open(scene("pinned2")) as viewer:
            self.assertIn("Ctrl+K", viewer.wait("hint")["text"])
            since = viewer.key("p", "pause")
            self.assertNotIn("P:", viewer.wait("hint", since)["text"])
            viewer.key("p", "pause")
            since = viewer.key("F1", "help")
            viewer.wait("hint", since, text="Ctrl+K: Find any command")
            viewer.key("Escape", "quit")  # The help first.
            self.quit(viewer)
        with self.open(scene("pinned2")) as viewer:
            viewer.wait("hint", text="Ctrl+K: Find any command")
            since = viewer.mark()
            viewer.xdotool("key", "ctrl+k")
            viewer.wait("hint", since, text="")


class Tooltips(ViewerTest):
    def test_controls_explain_themselves(self):
        with self.viewer(scene("pinned2")) as viewer:
            for control, words in (("cloth.ks", ("N/m", ">= 0", "typically", "by default")), ("cloth.ks box", ("N/m",)),
                                   ("cloth.enable_bending", ("cloth.enable_bending",)), ("look.shader", ("[", "]")),
                                   ("button pause", ("Key: P",)), ("look.color", ("look.color",)),
                                   ("panel Gravity", ("Closes",))):
                with self.subTest(control=control):
                    since = viewer.mark()
                    viewer.point_at(control)
                    text = viewer.wait("tooltip", since, control=control)["text"]
                    for word in words:
                        self.assertIn(word, text)


class Sizes(ViewerTest):
    def inside(self, viewer, name, width, height):
        box = viewer.box(name)
        self.assertGreaterEqual(box["x"], 0, name)
        self.assertGreaterEqual(box["y"], 0, name)
        self.assertLessEqual(box["x"] + box["width"], width, name)
        self.assertLessEqual(box["y"] + box["height"], height, name)

    def windows_are_inside(self, viewer, width, height):
        for key, name, window in (("F1", "help", "help"), ("c", "console", "console"), ("ctrl+k", "palette", "palette")):
            viewer.key(key, name)
            self.inside(viewer, window, width, height)
            viewer.key(key, name)
        # The last panel is reached, by the palette or by the wheel.
        viewer.choose("panel statistics", "panel Statistics")
        since = viewer.mark()
        viewer.xdotool("key", "Return")
        viewer.wait("focus", since, name="panel Statistics")
        self.inside(viewer, "panel Statistics", width, height)
        viewer.xdotool("key", "Escape")
        viewer.wait("focus", since, name="")
        viewer.point_at("panel Statistics")
        for _ in range(12):
            viewer.xdotool("click", 4)
        self.inside(viewer, "panel Spring types", width, height)

    def test_a_small_window(self):
        with self.viewer(scene("sphere"), "--size", "640x400") as viewer:
            self.windows_are_inside(viewer, 640, 400)

    def test_twice_the_size(self):
        with self.viewer(scene("sphere")) as viewer:
            ordinary = viewer.box("cloth.ks box")
        large = Display("1700x1300")
        try:
            with Viewer(large, scene("sphere"), "--ui-scale", "2", "--size", "1600x1200") as viewer:
                box = viewer.box("cloth.ks box")
                self.assertAlmostEqual(box["width"] / ordinary["width"], 2, delta=0.05)
                self.assertAlmostEqual(box["height"] / ordinary["height"], 2, delta=0.15)
                self.windows_are_inside(viewer, 1600, 1200)
        finally:
            large.close()


if __name__ == "__main__":
    unittest.main()
