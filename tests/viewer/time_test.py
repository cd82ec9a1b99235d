#!/usr/bin/env python3
"""Time in the window: the bar with the frames that are kept, and the memory they take."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest

from window import PERCALE, ViewerTest, scene, state_hash


class Time(ViewerTest):
    def run_to(self, viewer, frame):
        viewer.key("p", "pause")
        viewer.wait("state", where=lambda state: state["frame"] >= frame)
        viewer.key("p", "pause")
        viewer.settle()
        return viewer.state()["frame"]

    def at(self, viewer, share):
        """Points at a share of the track between its ends."""
        box = viewer.box("track")
        radius = 0.32 * box["height"]
        viewer.point(box["x"] + radius + share * (box["width"] - 2 * radius), box["y"] + box["height"] / 2)

    def test_the_track_goes_to_any_frame(self):
        with self.viewer("-f", scene("pinned2"), "--set", "cloth.num_width_points=20", "--set",
                         "cloth.num_height_points=20", "--set", "cloth.pinned=[[0,0]]") as viewer:
            last = self.run_to(viewer, 30)
            hashes = {event["frame"]: event["hash"] for event in viewer.events if event["event"] == "state"}
            # A click jumps; with the button down the frame follows the pointer.
            self.at(viewer, 0.5)
            since = viewer.mark()
            viewer.xdotool("mousedown", 1)
            self.assertAlmostEqual(viewer.wait("seek", since)["frame"], last / 2, delta=0.03 * last + 1)
            self.at(viewer, 0.0)
            viewer.wait("seek", since, frame=0)
            self.at(viewer, 1.0)
            viewer.wait("seek", since, frame=last)
            viewer.xdotool("mouseup", 1)
            viewer.settle()
            self.assertEqual(viewer.state()["frame"], last)
            self.assertEqual(viewer.state()["hash"], hashes[last])
            self.assertEqual(viewer.count("camera", since), 0)  # the picture does not turn below the bar

            since = viewer.key("Home", "first_frame")
            viewer.wait("state", since, frame=0, hash=viewer.start["hash"])
            since = viewer.key("End", "last_frame")
            viewer.wait("state", since, frame=last, hash=hashes[last])
            since = viewer.mark()
            viewer.click("button step_back")
            viewer.wait("state", since, frame=last - 1)
            viewer.click("button step_forward")
            viewer.wait("state", since, frame=last)
            viewer.click("button step_forward")
            viewer.wait("state", since, frame=last + 1)
            viewer.click("button first_frame")
            viewer.wait("state", since, frame=0)
            viewer.click("button loop")
            viewer.wait("loop", since)
            viewer.wait("state", since, where=lambda state: state["frame"] == 3)
            viewer.click("button pause")
            viewer.wait("run", since, running=False)
            self.assertEqual(viewer.count("message"), 0, viewer.stderr())

    def test_undo_of_what_is_only_seen_keeps_the_frames_after_it(self):
        with self.viewer("-f", scene("pinned2")) as viewer:
            for _ in range(2):
                viewer.step()
            viewer.type_number("cloth.ks", "1234")
            for _ in range(2):
                last = viewer.step()
            viewer.type_number("look.normal_scaling", "3")
            since = viewer.key("Home", "first_frame")
            viewer.wait("state", since, frame=0, hash=viewer.start["hash"])
            for key, action in (("ctrl+z", "undo"), ("ctrl+y", "redo"), ("ctrl+z", "undo")):
                viewer.key(key, action)
            viewer.settle()
            viewer.key("End", "last_frame")
            viewer.wait("state", since, frame=last["frame"], hash=last["hash"])
            # The settings are still those of the frame, not those of the change.
            viewer.key("Home", "first_frame")
            viewer.key("ctrl+y", "redo")
            viewer.settle()
            viewer.type_number("cloth.damping", "0.5")
            self.assertEqual(viewer.step()["hash"], state_hash(scene("pinned2"), 1, "--set", "cloth.damping=0.5"))
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)
            replayed = subprocess.run([PERCALE, "replay", viewer.log], capture_output=True, text=True, timeout=300)
            self.assertEqual(replayed.returncode, 0, replayed.stderr)

    def test_a_scene_file_that_is_saved_again_keeps_the_frames_after_it(self):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "pinned2.json")
            shutil.copy(scene("pinned2"), name)
            with open(name, encoding="utf-8") as file:
                settings = json.load(file)
            with self.viewer("-f", name) as viewer:
                for _ in range(2):
                    last = viewer.step()
                since = viewer.key("Home", "first_frame")
                viewer.settle()
                settings["look"] = {"color": [0, 0, 1]}
                with open(name, "w", encoding="utf-8") as file:
                    json.dump(settings, file)
                self.assertNotIn("command", viewer.wait("reload", since, what="scene"))
                viewer.key("End", "last_frame")
                viewer.wait("state", since, frame=2, hash=last["hash"])

    def test_the_memory_is_bounded_and_its_end_is_told_once(self):
        with self.viewer("-f", scene("pinned2"), "--history", "1") as viewer:
            self.run_to(viewer, 20)
            note = viewer.wait("message", source="history budget")
            self.assertEqual(note["severity"], "note")
            self.assertIn("oldest frames go", note["text"])
            since = viewer.key("Home", "first_frame")
            first = viewer.wait("seek", since)["frame"]
            self.assertGreater(first, 5)  # 120 kB each
            self.run_to(viewer, 40)
            self.assertEqual(viewer.count("message", source="history budget"), 1)
            # More of it, from the list in the bar.
            viewer.click("history budget")
            since = viewer.mark()
            viewer.click("history budget/64")
            self.assertEqual(viewer.wait("budget", since)["bytes"], 64 << 20)
            viewer.wait("mended", since, source="history budget")
            self.run_to(viewer, 60)
            self.assertEqual(viewer.count("message", source="history budget"), 1)

    def test_hidden_with_the_panels_and_absent_without_history(self):
        with self.viewer("-f", scene("pinned2")) as viewer:
            viewer.box("time bar")
            since = viewer.key("Tab", "panels")
            viewer.wait("widget", since, name="time bar", width=0)
        with self.viewer("-f", scene("pinned2"), "--history", "0") as viewer:
            viewer.step()
            self.assertEqual(viewer.count("widget", name="time bar"), 0)
            since = viewer.key("Home", "first_frame")
            viewer.wait("ignored", since, name="first_frame")


if __name__ == "__main__":
    unittest.main()
