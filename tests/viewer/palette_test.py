#!/usr/bin/env python3
"""The command palette, presets and the keyboard in the panels."""

import glob
import json
import os
import subprocess
import tempfile
import unittest

from window import PERCALE, ROOT, ViewerTest, scene


class Palette(ViewerTest):
    def run_choice(self, viewer, query, command):
        """Chooses and presses Enter; returns the number of the event from which on it acts."""
        viewer.choose(query, command)
        since = viewer.mark()
        viewer.xdotool("key", "Return")
        viewer.wait("palette", since, visible=False)
        return since

    def test_a_value_for_a_parameter(self):
        with self.viewer(scene("sphere")) as viewer:
            since = self.run_choice(viewer, "ks 800", "set cloth.ks")
            self.assertEqual(viewer.wait("set", since, path="/cloth/0/ks")["value"], 800)
            since = self.run_choice(viewer, "gravity 0 -1.6 0", "set simulation.gravity")
            self.assertEqual(viewer.wait("set", since, path="/simulation/gravity")["value"], [0, -1.6, 0])
            since = self.run_choice(viewer, "enable_bending false", "set cloth.enable_bending")
            self.assertIs(viewer.wait("set", since, path="/cloth/0/enable_bending")["value"], False)
            since = self.run_choice(viewer, "hash = linear", "set simulation.hash")
            self.assertEqual(viewer.wait("set", since, path="/simulation/hash")["value"], "linear")
            since = self.run_choice(viewer, "ks -5", "set cloth.ks")
            message = viewer.wait("message", since, severity="error")
            self.assertIn("expected a number >= 0 N/m", message["text"])
            self.assertEqual(viewer.count("set", since), 0)

    def test_a_parameter_is_shown_in_its_panel(self):
        with self.viewer(scene("sphere")) as viewer:
            viewer.key("Tab", "panels")  # Hidden panels come back for it.
            since = self.run_choice(viewer, "gustiness", "set wind.gustiness")  # of a panel that is closed
            viewer.wait("focus", since, name="wind.gustiness")
            viewer.wait("widget", since, name="wind.gustiness", where=lambda box: box["width"] > 0)
            self.assertEqual(viewer.count("panel", since), 0)
            # And keys act on it.
            viewer.xdotool("key", "Right")
            viewer.wait("focus", since, name="wind.gustiness box")
            viewer.xdotool("key", "Return")
            viewer.wait_for_active("wind.gustiness box")
            viewer.xdotool("type", "--delay", "60", "0.7")
            viewer.xdotool("key", "Return")
            self.assertEqual(viewer.wait("set", since, path="/wind/gustiness")["value"], 0.7)
            # One that no panel shows is set where it was named.
            since = viewer.mark()
            viewer.choose("num_width", "set cloth.num_width_points")
            viewer.xdotool("key", "Return")
            viewer.wait("palette", since, query="cloth.num_width_points ")
            viewer.xdotool("type", "--delay", "15", "30")
            viewer.wait("palette", since, query="cloth.num_width_points 30")
            viewer.xdotool("key", "Return")
            self.assertEqual(viewer.wait("set", since, path="/cloth/0/num_width_points")["value"], 30)

    def test_shaders_scenes_panels_and_presets(self):
        with self.viewer(scene("sphere")) as viewer:
            since = self.run_choice(viewer, "shader phong", "shader Phong")
            viewer.wait("shader", since, name="Phong")
            since = self.run_choice(viewer, "panel wind", "panel Wind")
            viewer.wait("focus", since, name="panel Wind")
            since = self.run_choice(viewer, "preset silk", "preset silk")
            viewer.wait("preset", since, name="silk")
            self.assertIn('"ks": 1500,', viewer.wait("settings", since)["config"])
            since = viewer.key("ctrl+z", "undo")  # All of it at once.
            self.assertIn('"ks": 5000,', viewer.wait("settings", since)["config"])
            since = self.run_choice(viewer, "pinned4", "scene " + scene("pinned4"))
            self.assertEqual(os.path.basename(viewer.wait("open", since)["scene"]), "pinned4.json")

    def test_everything_can_be_found(self):
        with self.viewer(scene("sphere")) as viewer:
            for file in glob.glob(os.path.join(ROOT, "shaders", "*.frag")):
                name = os.path.basename(file)[:-5]
                if "." in name:  # a part of a shader
                    continue
                viewer.choose("shader: " + name, "shader " + name)
                viewer.xdotool("key", "Escape")
            for file in glob.glob(os.path.join(ROOT, "presets", "*.json")):
                name = os.path.basename(file)[:-5]
                viewer.choose("preset: " + name, "preset " + name)
                viewer.xdotool("key", "Escape")

    def test_arrows_mouse_and_leaving(self):
        with self.viewer(scene("sphere")) as viewer:
            viewer.choose("shader:", "shader Wireframe")
            since = viewer.mark()
            viewer.xdotool("key", "Down")
            viewer.wait("palette", since, selected="shader Normal")
            viewer.xdotool("key", "Up")
            viewer.xdotool("key", "Up")
            last = viewer.wait("palette", since, where=lambda event: not event["selected"].startswith("shader N"))
            viewer.xdotool("sleep", "0.5")  # The list has scrolled: its boxes are told when they stand still.
            viewer.click("palette/shader Phong")
            viewer.wait("shader", since, name="Phong")
            viewer.wait("palette", since, visible=False)
            self.assertTrue(last["count"] >= 9)
            since = viewer.mark()
            viewer.choose("zzz", "")
            viewer.xdotool("key", "Return")  # Nothing to run.
            viewer.point(30, 600)
            viewer.xdotool("click", 1)  # Beside it.
            viewer.wait("palette", since, visible=False)
            self.assertEqual(viewer.count("action", since), 1)
            # The second press of its key closes it as well.
            viewer.xdotool("key", "ctrl+k")
            viewer.wait("palette", since, visible=True, query="")
            since = viewer.mark()
            viewer.xdotool("key", "ctrl+k")
            viewer.wait("palette", since, visible=False)

    def test_recent_ones_come_first(self):
        with self.viewer(scene("sphere")) as viewer:
            self.run_choice(viewer, "shader mirror", "shader Mirror")
            since = viewer.mark()
            viewer.xdotool("key", "ctrl+k")
            viewer.wait("palette", since, query="", selected="shader Mirror")

    def test_quick_typing_is_not_lost(self):
        with self.viewer(scene("sphere")) as viewer:
            since = viewer.mark()
            viewer.xdotool("key", "--delay", "1", "ctrl+k", "k", "s", "space", "9", "0", "0", "Return")
            self.assertEqual(viewer.wait("set", since, path="/cloth/0/ks")["value"], 900)


class Presets(ViewerTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.config = folder.name

    def write(self, name, text):
        os.makedirs(os.path.join(self.config, "presets"))
        with open(os.path.join(self.config, "presets", name + ".json"), "w", encoding="utf-8") as file:
            file.write(text)

    def apply(self, viewer, name):
        since = viewer.mark()
        viewer.choose("preset " + name, "preset " + name)
        viewer.xdotool("key", "Return")
        return since

    def open(self):
        return self.viewer(scene("sphere"), environment={"PERCALE_CONFIG_DIR": self.config})

    def open_panel(self, viewer):
        viewer.click("panel Presets")
        viewer.box("preset")

    def test_saved_and_applied(self):
        with self.open() as viewer:
            since = viewer.mark()
            viewer.choose("save as preset", "action save_preset")
            viewer.xdotool("key", "Return")
            self.assertIn("as the scene file has it", viewer.wait("message", since, source="preset")["text"])
            viewer.type_number("cloth.ks", "4321")
            self.open_panel(viewer)
            viewer.type_into("preset name", "mine")
            since = viewer.mark()
            viewer.click("button save_preset")
            file = viewer.wait("preset_saved", since)["file"]
            self.assertEqual(file, os.path.join(self.config, "presets", "mine.json"))
            with open(file, encoding="utf-8") as saved:
                self.assertEqual(json.load(saved)["set"], {"cloth.ks": 4321})
            viewer.type_number("cloth.ks", "5000")
            since = viewer.mark()
            viewer.click("preset")
            viewer.click("preset/mine")
            self.assertIn('"ks": 4321,', viewer.wait("settings", since)["config"])
            # Without a name it gets one that is free.
            since = viewer.mark()
            viewer.click("button save_preset")
            self.assertEqual(os.path.basename(viewer.wait("preset_saved", since)["file"]), "sphere-1.json")

    def test_one_that_makes_another_cloth_is_taken_back_to_the_bit(self):
        self.write("coarse", '{"set": {"cloth.num_width_points": 20, "cloth.num_height_points": 20, "cloth.ks": 900, '
                             '"look.color": [0, 0, 1]}}')
        with self.open() as viewer:
            for _ in range(3):
                before = viewer.step()
            since = self.apply(viewer, "coarse")
            settings = viewer.wait("settings", since)
            self.assertTrue(settings["undoable"])
            self.assertFalse(viewer.wait("done", since, command=settings["command"])["kept"])
            after = viewer.step()
            self.assertEqual(after["frame"], 1)
            for key, action, state in (("ctrl+z", "undo", before), ("ctrl+y", "redo", after), ("ctrl+z", "undo", before)):
                viewer.key(key, action)
                viewer.settle()
                self.assertEqual((viewer.state()["frame"], viewer.state()["hash"]), (state["frame"], state["hash"]))
            # Settings and all: what is set from here on is set for the cloth that is back.
            viewer.type_number("cloth.damping", "0.5")
            end = viewer.step()
            self.assertEqual(end["frame"], 4)
            self.assertEqual(viewer.count("message", severity="error"), 0, viewer.stderr())
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)
            replayed = subprocess.run([PERCALE, "replay", viewer.log], capture_output=True, text=True, timeout=300)
            self.assertEqual(replayed.returncode, 0, replayed.stderr)
            self.assertIn("state   " + end["hash"], replayed.stdout)

    def test_one_that_is_only_seen_keeps_the_frames_that_follow(self):
        self.write("blue", '{"set": {"look.color": [0, 0, 1]}}')
        with self.open() as viewer:
            for _ in range(2):
                last = viewer.step()
            viewer.key("Home", "first_frame")
            since = self.apply(viewer, "blue")
            self.assertNotIn("command", viewer.wait("settings", since))
            viewer.key("End", "last_frame")
            viewer.wait("state", since, frame=2, hash=last["hash"])

    def test_a_broken_one_is_told_with_its_place(self):
        self.write("bad", '{"set": {\n "cloth.kss": 5}}')
        with self.open() as viewer:
            since = self.apply(viewer, "bad")
            message = viewer.wait("message", since, severity="error")
            self.assertTrue(message["file"].endswith("bad.json"))
            self.assertEqual(message["line"], 2)
            self.assertIn("did you mean `ks`?", message["text"])


class Keyboard(ViewerTest):
    def press(self, viewer, key, control):
        """Presses a key, by which that control gets the keyboard."""
        since = viewer.mark()
        viewer.xdotool("key", key)
        viewer.wait("focus", since, name=control)

    def test_controls_by_arrows_and_enter(self):
        with self.viewer(scene("pinned2")) as viewer:
            self.press(viewer, "F6", "panel Spring types")
            self.press(viewer, "Down", "cloth.enable_structural")
            since = viewer.mark()
            viewer.xdotool("key", "Return")  # a tick box
            self.assertIs(viewer.wait("set", since, path="/cloth/0/enable_structural")["value"], False)
            self.press(viewer, "Down", "panel Parameters")
            self.press(viewer, "Down", "cloth.density")
            self.press(viewer, "Down", "cloth.ks")
            since = viewer.mark()
            viewer.xdotool("key", "Return")  # a slider
            viewer.wait_for_active("cloth.ks")
            viewer.xdotool("key", "Right")
            self.assertGreater(viewer.wait("set", since, path="/cloth/0/ks")["value"], 5000)
            viewer.xdotool("key", "Return")
            viewer.wait_for_active("")
            self.press(viewer, "Right", "cloth.ks box")
            since = viewer.mark()
            viewer.xdotool("key", "Return")  # a number
            viewer.wait_for_active("cloth.ks box")
            viewer.xdotool("type", "--delay", "60", "123")
            viewer.xdotool("key", "Return")
            self.assertEqual(viewer.wait("set", since, path="/cloth/0/ks")["value"], 123)
            # Letters are the keys they always are; so is Space again, once Escape has led back.
            viewer.key("n", "step")
            since = viewer.mark()
            viewer.xdotool("key", "Escape")
            viewer.wait("focus", since, name="")
            viewer.key("space", "reset_camera")
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)

    def test_a_list(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.choose("look.tangents", "set look.tangents")
            since = viewer.mark()
            viewer.xdotool("key", "Return")
            viewer.wait("focus", since, name="look.tangents")
            since = viewer.mark()
            viewer.xdotool("key", "Return")
            viewer.wait("widget", since, name="look.tangents/from_uv", where=lambda box: box["width"] > 0)
            self.press(viewer, "Down", "look.tangents/from_uv")
            viewer.xdotool("key", "Return")
            self.assertEqual(viewer.wait("set", since, path="/look/tangents")["value"], "from_uv")

    def test_round_the_windows(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.key("c", "console")
            self.press(viewer, "ctrl+Tab", "panel Spring types")
            self.press(viewer, "ctrl+Tab", "console errors")
            self.press(viewer, "Right", "console warnings")
            self.press(viewer, "ctrl+Tab", "")
            # A click into the picture leads back as well.
            self.press(viewer, "F6", "panel Spring types")
            since = viewer.mark()
            viewer.point(200, 200)
            viewer.xdotool("click", 1)
            viewer.wait("focus", since, name="")


class Console(ViewerTest):
    def test_what_was_told_is_kept_filtered_and_copied(self):
        with self.viewer(scene("pinned2")) as viewer:
            for text in ("abc", "def", "abc"):
                viewer.type_number("cloth.ks", text)
            viewer.type_number("cloth.ks", "5001")  # All is well again.
            viewer.key("c", "console")
            since = viewer.mark()
            viewer.click("console copy")
            lines = viewer.wait("copied", since)["text"].splitlines()
            self.assertEqual(len(lines), 2)
            self.assertRegex(lines[0], r'^\d+\.\d s  error  input /cloth/ks  Spring constant: .*"def"')
            self.assertRegex(lines[1], r'"abc".*\(2 times\)$')
            viewer.type_into("console filter", "def")
            since = viewer.mark()
            viewer.click("console copy")
            self.assertEqual(len(viewer.wait("copied", since)["text"].splitlines()), 1)
            viewer.click("console errors")
            since = viewer.mark()
            viewer.click("console copy")
            self.assertEqual(viewer.wait("copied", since)["text"], "")


if __name__ == "__main__":
    unittest.main()
