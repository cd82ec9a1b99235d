#!/usr/bin/env python3
"""The viewer's window: opening, keys of the view, resizing, closing."""

import os
import signal
import subprocess
import tempfile
import unittest

from window import PERCALE, ROOT, Display, Viewer, ViewerTest, scene, wait_for


class Opening(ViewerTest):
    def test_opens_paused_in_wireframe(self):
        with self.viewer(scene("pinned2")) as viewer:
            self.assertEqual((viewer.start["width"], viewer.start["height"]), (1024, 800))
            self.assertEqual(viewer.start["shader"], "Wireframe")
            self.assertEqual(viewer.start["frame"], 0)
            if viewer.start["software"]:
                self.assertEqual(viewer.start["samples"], 1)
            wait_for("the title", lambda: viewer.title() == "pinned2.json - Percale (paused)")
            # Pausing means that no frame is simulated, however often the window is drawn.
            since = viewer.mark()
            for _ in range(3):
                viewer.key("bracketright", "next_shader")
            self.assertEqual(viewer.count("state", since), 0)
            self.assertEqual(viewer.stderr(), "")

    def test_a_shader_and_samples_that_are_asked_for(self):
        with self.viewer(scene("sphere"), "--shader", "Normal", "--samples", "2", "--size", "700x500") as viewer:
            self.assertEqual(viewer.start["shader"], "Normal")
            self.assertEqual(viewer.start["samples"], 2)
            self.assertEqual((viewer.start["width"], viewer.start["height"]), (700, 500))

    def fails(self, code, *arguments, **environment):
        root = [] if "-r" in arguments else ["-r", ROOT]
        done = subprocess.run([PERCALE, "view", scene("pinned2"), *root, *arguments], capture_output=True, text=True,
                              env={**os.environ, "DISPLAY": self.display.name, **environment}, timeout=60)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_uniforms_that_are_asked_for(self):
        with self.viewer(scene("pinned2"), "--shader", "Phong", "--uniform", "diffuse_on=0") as viewer:
            since = viewer.mark()
            viewer.click("uniform.u_diffuse_on")  # It was off, so this switches it on.
            self.assertEqual(viewer.wait("uniform", since, name="u_diffuse_on")["value"][0], 1)
        self.assertIn("did you mean `u_diffuse_on`?",
                      self.fails(2, "--shader", "Phong", "--uniform", "diffuse_no=0"))

    def test_a_display_that_does_not_answer(self):
        errors = self.fails(5, DISPLAY=":6543")
        self.assertIn("no display", errors)
        self.assertIn("percale render", errors)

    def test_a_display_without_opengl_3_3(self):
        errors = self.fails(5, MESA_GL_VERSION_OVERRIDE="2.1", LIBGL_ALWAYS_SOFTWARE="1")
        self.assertIn("OpenGL 3.3", errors)
        self.assertIn("libgl1-mesa-dri", errors)

    def test_a_folder_without_shaders(self):
        with tempfile.TemporaryDirectory() as root:
            os.mkdir(os.path.join(root, "shaders"))
            os.mkdir(os.path.join(root, "scene"))
            self.assertIn("shaders", self.fails(3, "-r", root))

    def test_a_log_that_cannot_be_written(self):
        self.assertIn("/no/such/folder/a.log", self.fails(1, "--log", "/no/such/folder/a.log"))


class Closing(ViewerTest):
    def test_escape(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0, viewer.stderr())
            self.assertEqual(viewer.events[-1]["event"], "exit")
            self.assertEqual(viewer.events[-1]["code"], 0)
            self.assertEqual(viewer.stderr(), "")

    def test_escape_while_running(self):
        with self.viewer(scene("selfCollision")) as viewer:
            viewer.key("p", "pause")
            viewer.wait("state", where=lambda state: state["frame"] > 3)
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0, viewer.stderr())

    def test_the_window_manager(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.close_window()
            self.assertEqual(viewer.ended(), 0, viewer.stderr())
            self.assertEqual(viewer.events[-1]["event"], "exit")

    def test_an_interrupt_from_the_terminal(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.process.send_signal(signal.SIGINT)
            self.assertEqual(viewer.ended(), 130, viewer.stderr())
            self.assertEqual(viewer.events[-1]["code"], 130)


class View(ViewerTest):
    def drag(self, viewer, button, way, *held):
        """Drags by `way` pixels in the picture; returns the camera before the last movement and after."""
        viewer.point(300, 400)
        for key in held:
            viewer.xdotool("keydown", key)
        viewer.xdotool("mousedown", button)
        since = viewer.mark()
        viewer.point(300 + way[0], 400 + way[1])
        camera = viewer.wait("camera", since)
        viewer.xdotool("mouseup", button)
        for key in held:
            viewer.xdotool("keyup", key)
        return camera

    def test_mouse_and_space(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.key("space", "reset_camera")
            start = viewer.wait("camera", since)
            self.assertEqual(start["azimuth"], 0)
            self.assertAlmostEqual(start["distance"], 1.8)

            turned = self.drag(viewer, 1, (120, 60))
            self.assertNotEqual(turned["azimuth"], start["azimuth"])
            self.assertNotEqual(turned["elevation"], start["elevation"])
            self.assertEqual(turned["target"], start["target"])
            self.assertEqual(turned["distance"], start["distance"])

            shifted = self.drag(viewer, 3, (50, 0))
            self.assertEqual(shifted["azimuth"], turned["azimuth"])
            self.assertNotEqual(shifted["target"], turned["target"])
            again = self.drag(viewer, 1, (50, 0), "ctrl")
            self.assertEqual(again["azimuth"], turned["azimuth"])
            # The same way by either gesture.
            for a, b, c in zip(turned["target"], shifted["target"], again["target"]):
                self.assertAlmostEqual(b - a, c - b)

            since = viewer.mark()
            viewer.xdotool("click", 4)  # one step of the wheel, away from the user
            nearer = viewer.wait("camera", since)
            self.assertAlmostEqual(nearer["distance"], start["distance"] - 0.09)

            since = viewer.key("space", "reset_camera")
            back = viewer.wait("camera", since)
            for key in ("azimuth", "elevation", "distance", "target"):
                self.assertEqual(back[key], start[key])

    def test_panels_do_not_let_the_mouse_through(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.point_at("panel Statistics")
            since = viewer.mark()
            viewer.xdotool("click", 4)
            viewer.point_at("panel Simulation", 0.9)
            viewer.xdotool("mousedown", 1)
            viewer.point(20, 500)
            viewer.xdotool("mouseup", 1)
            viewer.key("bracketright", "next_shader")  # all that came before has been taken
            self.assertEqual(viewer.count("camera", since), 0)

    def test_tab_hides_the_panels_and_f1_helps(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.key("Tab", "panels")
            viewer.wait("panels", since, visible=False)
            viewer.wait("widget", since, name="cloth.ks", width=0)
            since = viewer.key("Tab", "panels")
            viewer.wait("widget", since, name="cloth.ks", where=lambda box: box["width"] > 0)
            since = viewer.key("F1", "help")
            viewer.wait("help", since, visible=True)
            viewer.wait("widget", since, name="help", where=lambda box: box["width"] > 100)
            since = viewer.key("F1", "help")
            viewer.wait("help", since, visible=False)

    def test_w_draws_the_springs_over_any_shader(self):
        with self.viewer(scene("sphere"), "--shader", "Phong") as viewer:
            since = viewer.key("w", "wireframe")
            viewer.wait("wireframe", since, visible=True)
            viewer.step()
            since = viewer.key("w", "wireframe")
            viewer.wait("wireframe", since, visible=False)
            self.assertEqual(viewer.count("message"), 0, viewer.stderr())

    def test_resizing(self):
        with self.viewer(scene("pinned2")) as viewer:
            for size in ((800, 600), (400, 300), (1200, 900)):
                since = viewer.mark()
                viewer.xdotool("windowsize", viewer.window, *size)
                viewer.wait("window", since, width=size[0], height=size[1])
                # The panels are at the right edge, wherever that is now.
                viewer.wait("widget", since, name="panel Simulation",
                            where=lambda box: abs(box["x"] + box["width"] - size[0]) < 30)
            self.assertEqual(viewer.step()["frame"], 1)

    def test_text_scales_with_the_display(self):
        with self.viewer(scene("pinned2")) as viewer:
            ordinary = viewer.box("cloth.ks box")
        dense = Display("2100x1700")
        try:
            dense.set_resources("Xft.dpi:\t192\n")
            with Viewer(dense, scene("pinned2")) as viewer:
                self.assertEqual((viewer.start["width"], viewer.start["height"]), (2048, 1600))
                box = viewer.box("cloth.ks box")
                self.assertAlmostEqual(box["width"] / ordinary["width"], 2, delta=0.05)
                self.assertAlmostEqual(box["height"] / ordinary["height"], 2, delta=0.15)
        finally:
            dense.close()


if __name__ == "__main__":
    unittest.main()
