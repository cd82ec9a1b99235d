#!/usr/bin/env python3
"""The simulation in the viewer: its keys, and settings changed by the mouse. Where a state is
known exactly it is held against `percale simulate`."""

import json
import os
import tempfile
import unittest

from window import ViewerTest, scene, state_hash


class Keys(ViewerTest):
    def test_p_runs_and_pauses(self):
        with self.viewer(scene("pinned2")) as viewer:
            start = viewer.step()
            since = viewer.key("p", "pause")
            viewer.wait("run", since, running=True)
            fallen = viewer.wait("state", since, where=lambda state: state["frame"] > 10 and state["running"])
            self.assertLess(fallen["lowest"], start["lowest"])
            self.assertGreater(fallen["energy"], 0)
            since = viewer.key("p", "pause")
            viewer.wait("run", since, running=False)
            paused = viewer.wait("state", since, running=False)
            since = viewer.key("bracketright", "next_shader")
            self.assertEqual(viewer.count("state", since), 0)
            self.assertEqual(viewer.state()["frame"], paused["frame"])

    def test_n_is_one_frame(self):
        with self.viewer(scene("pinned2")) as viewer:
            for frame in (1, 2, 3):
                state = viewer.step()
                self.assertEqual(state["frame"], frame)
                self.assertEqual(state["step"], 30 * frame)
                self.assertFalse(state["running"])
            self.assertEqual(state["hash"], state_hash(scene("pinned2"), 3))

    def test_n_does_nothing_while_running(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.key("p", "pause")
            viewer.wait("state", since, running=True)
            since = viewer.key("n", "step")
            viewer.wait("ignored", since, name="step")
            self.assertEqual(viewer.count("step", since), 0)

    def test_r_is_the_start(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.key("p", "pause")
            viewer.wait("state", since, where=lambda state: state["frame"] > 5)
            viewer.key("p", "pause")
            viewer.settle()
            self.assertNotEqual(viewer.state()["hash"], viewer.start["hash"])
            since = viewer.key("r", "reset")
            state = viewer.wait("state", since, frame=0)
            self.assertEqual(state["hash"], viewer.start["hash"])
            self.assertEqual(state["time"], 0)
            # And from there the same again.
            self.assertEqual(viewer.step()["hash"], state_hash(scene("pinned2"), 1))

    def test_speed_is_that_of_the_scene(self):
        with self.viewer(scene("pinned2"), "--set", "simulation.steps_per_frame=1", "--set", "cloth.ks=100") as viewer:
            since = viewer.key("p", "pause")
            first = viewer.wait("state", since, where=lambda state: state["frame"] > 10)
            last = viewer.wait("state", since, where=lambda state: state["frame"] > 250)
            rate = (last["frame"] - first["frame"]) / (last["t"] - first["t"])
            # Never faster than 90 frames per second, but for what is made up for.
            self.assertLess(rate, 90 * 1.1 + 5)


class Settings(ViewerTest):
    def set_path(self, viewer, since, path):
        return viewer.wait("set", since, path=path)

    def test_a_slider_acts_while_it_is_dragged(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.step()
            viewer.point_at("cloth.ks", 0.5)
            since = viewer.mark()
            viewer.xdotool("mousedown", 1)
            first = self.set_path(viewer, since, "/cloth/0/ks")
            since = viewer.mark()
            viewer.point_at("cloth.ks", 0.4)
            second = self.set_path(viewer, since, "/cloth/0/ks")
            self.assertLess(second["value"], first["value"])
            # The button is still down, and the simulation has it already, its state kept.
            done = viewer.wait("done", since, command=second["command"])
            self.assertTrue(done["kept"])
            self.assertEqual(done["frame"], 1)
            viewer.xdotool("mouseup", 1)

            # What was set is what is simulated.
            viewer.key("r", "reset")
            viewer.settle()
            ks = [event for event in viewer.events if event["event"] == "set"][-1]["value"]
            self.assertEqual(viewer.step()["hash"], state_hash(scene("pinned2"), 1, "--set", f"cloth.ks={ks!r}"))

    def test_damping_and_gravity_sliders(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.mark()
            viewer.click("cloth.damping")
            value = self.set_path(viewer, since, "/cloth/0/damping")["value"]
            self.assertAlmostEqual(value, 0.5, delta=0.1)
            since = viewer.mark()
            viewer.click("simulation.gravity.x")
            viewer.point_at("simulation.gravity.x", 0.8)
            viewer.xdotool("click", 1)
            gravity = viewer.wait("set", since, path="/simulation/gravity", where=lambda event: event["value"][0] > 5)
            self.assertEqual(gravity["value"][1:], [-9.8, 0])

    def test_spring_kinds(self):
        with self.viewer(scene("pinned2")) as viewer:
            for name in ("enable_structural", "enable_bending"):
                since = viewer.mark()
                viewer.click("cloth." + name)
                change = self.set_path(viewer, since, "/cloth/0/" + name)
                self.assertIs(change["value"], False)
                self.assertTrue(viewer.wait("done", since, command=change["command"])["kept"])
            self.assertEqual(viewer.step()["hash"],
                             state_hash(scene("pinned2"), 1, "--set", "cloth.enable_structural=false",
                                        "--set", "cloth.enable_bending=false"))
            since = viewer.mark()
            viewer.click("cloth.enable_structural")
            self.assertIs(self.set_path(viewer, since, "/cloth/0/enable_structural")["value"], True)

    def test_typed_numbers(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.mark()
            viewer.type_number("cloth.ks", "12500")
            self.assertEqual(self.set_path(viewer, since, "/cloth/0/ks")["value"], 12500)
            # The panel shows g/cm^2, the scene has kg/m^2.
            since = viewer.mark()
            viewer.type_number("cloth.density", "5")
            self.assertEqual(self.set_path(viewer, since, "/cloth/0/density")["value"], 50)
            for text, value in ((".5", 0.5), ("+.25", 0.25), ("1.", 1)):
                since = viewer.mark()
                viewer.type_number("cloth.damping", text)
                self.assertEqual(self.set_path(viewer, since, "/cloth/0/damping")["value"], value)
            # Letters that are keys elsewhere are text here.
            self.assertEqual(viewer.count("action"), 0)

    def test_typed_nonsense_is_refused(self):
        with self.viewer(scene("pinned2")) as viewer:
            for text, told in (("abc", '"abc"'), ("-5", "-5"), ("1e999", "1e999"), ("nan", "nan"), ("1e15", "1e15")):
                since = viewer.mark()
                viewer.type_number("cloth.ks", text)
                message = viewer.wait("message", since, severity="error")
                self.assertIn("Spring constant: expected", message["text"])
                self.assertIn(told, message["text"].replace("1000000000000000", "1e15"))
                self.assertIn("old value stays", message["text"])
                self.assertEqual(viewer.count("set"), 0)
            # In the unit in which it was typed.
            since = viewer.mark()
            viewer.type_number("cloth.density", "-5")
            message = viewer.wait("message", since, severity="error")
            self.assertIn("Density: expected a number >= 0 g/cm^2, got -5;", message["text"])
            since = viewer.mark()
            viewer.type_number("cloth.ks", "400")
            self.assertEqual(self.set_path(viewer, since, "/cloth/0/ks")["value"], 400)
            viewer.wait("mended", since)
            viewer.key("r", "reset")
            self.assertEqual(viewer.step()["hash"], state_hash(scene("pinned2"), 1, "--set", "cloth.ks=400"))

    def test_all_cloths_or_one(self):
        with self.viewer(scene("layers"), "--shader", "Phong") as viewer:  # Shadows take the processor long.
            with open(scene("layers"), encoding="utf-8") as file:
                cloths = len(json.load(file)["cloth"])
            self.assertGreater(cloths, 1)
            since = viewer.mark()
            viewer.type_number("cloth.ks", "1234")
            for cloth in range(cloths):
                self.assertEqual(self.set_path(viewer, since, f"/cloth/{cloth}/ks")["value"], 1234)
            viewer.click("cloth choice")
            viewer.click("cloth choice/1")
            since = viewer.mark()
            viewer.type_number("cloth.1.ks", "2345")
            self.assertEqual(self.set_path(viewer, since, "/cloth/1/ks")["value"], 2345)
            self.assertEqual(viewer.count("set", since), 1)

    def test_warnings_come_beforehand_and_go(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.mark()
            viewer.type_number("cloth.ks", "300000")
            warning = viewer.wait("message", since, source="settings")
            self.assertEqual(warning["severity"], "warning")
            self.assertRegex(warning["text"], r"stable limit of 2\d+ N/m")
            since = viewer.mark()
            viewer.type_number("cloth.ks", "5000")
            viewer.wait("mended", since, source="settings")

    def test_blowing_up(self):
        with self.viewer(scene("pinned2"), "--set", "simulation.steps_per_frame=1") as viewer:
            since = viewer.key("p", "pause")
            message = viewer.wait("message", since, source="divergence")
            self.assertRegex(message["text"], r"blew up at step \d+, vertex \d+: .*ks.*steps_per_frame.*press R")
            state = viewer.wait("state", since, running=False)
            self.assertLess(abs(state["lowest"]), 1e6)  # the last good frame
            # The window lives on; a step does nothing, a reset mends it.
            self.assertEqual(viewer.step()["frame"], state["frame"])
            since = viewer.key("r", "reset")
            viewer.wait("mended", since, source="divergence")
            self.assertEqual(viewer.step()["frame"], 1)

    def test_a_large_cloth_leaves_the_window_answering(self):
        with open(scene("pinned2"), encoding="utf-8") as file:
            large = json.load(file)
        large["cloth"].update(num_width_points=200, num_height_points=200, pinned=[[0, 0], [199, 0]], thickness=0.002)
        large["simulation"] = {"steps_per_frame": 2000}  # seconds
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "large.json")
            with open(name, "w", encoding="utf-8") as file:
                json.dump(large, file)
            with self.viewer(name) as viewer:
                viewer.key("p", "pause")
                since = viewer.mark()
                for _ in range(6):
                    last = viewer.key("bracketright", "next_shader")
                viewer.wait("shader", last)
                taken = [event for event in viewer.events[since:] if event["event"] == "shader"]
                self.assertEqual(len(taken), 6)
                # A window that waits for the simulation would have taken one key in a frame of it.
                frames = [event["frame"] for event in viewer.events[since:] if event["event"] == "state"]
                self.assertLess(max(frames, default=0), 5)


if __name__ == "__main__":
    unittest.main()
