#!/usr/bin/env python3
"""Every action of the table: by its keys and by the palette. Which actions there are comes from the
program, so that one that is added here has no check yet makes the test fail."""

import subprocess
import unittest

from window import ViewerTest, scene

# What the log says when an action has acted: an event, and facts of it.
CHECKS = {
    "pause": ("run", {}),
    "step": ("step", {"frames": 1}),
    "reset": ("reset", {}),
    "step_back": ("seek", {}),
    "step_forward": ("seek", {}),
    "first_frame": ("seek", {}),
    "last_frame": ("seek", {}),
    "loop": ("loop", {}),
    "more_history": ("budget", {}),
    "less_history": ("budget", {}),
    "ball": ("ball", {}),
    "gust": ("gust", {}),
    "undo": ("undo", {}),
    "redo": ("redo", {}),
    "reset_camera": ("camera", {}),
    "previous_shader": ("shader", {}),
    "next_shader": ("shader", {}),
    "wireframe": ("wireframe", {}),
    "heat_map": ("heat_map", {}),
    "normals": ("overlays", {}),
    "pins": ("overlays", {}),
    "contacts": ("overlays", {}),
    "cones": ("overlays", {"cones": True}),
    "boxes": ("overlays", {}),
    "inspector": ("inspector", {}),
    "hold_vertex": ("inspector", {"held": True}),
    "new_shader": ("widget", {"name": "new shader name"}),
    "reset_uniforms": ("uniforms", {}),
    "save_state": ("saved", {"what": "checkpoint"}),
    "load_state": ("load", {}),
    "picture": ("saved", {"what": "picture"}),
    "record": ("record", {"recording": True}),
    "previous_scene": ("open", {}),
    "next_scene": ("open", {}),
    "reload": ("reload", {"what": "scene"}),
    "save_preset": ("message", {"source": "preset"}),
    "palette": ("palette", {}),
    "focus": ("focus", {}),
    "console": ("console", {}),
    "panels": ("panels", {}),
    "plots": ("plots", {}),
    "export_plots": ("export", {}),
    "help": ("help", {}),
    "quit": ("exit", {"code": 0}),
}

KEYSYMS = {"Space": "space", "[": "bracketleft", "]": "bracketright", "{": "braceleft", "}": "braceright",
           ",": "comma", ".": "period", "Esc": "Escape", "Enter": "Return"}


def keysym(text):
    """"Ctrl+K" as xdotool has it."""
    *modifiers, key = text.split("+")
    key = KEYSYMS.get(key, key.lower() if len(key) == 1 else key)
    return "+".join([modifier.lower() for modifier in modifiers] + [key])


class Actions(ViewerTest):
    def rows(self, viewer):
        viewer.wait("key", name="quit")
        return [event for event in viewer.events if event["event"] == "key"]

    def open(self):
        return self.viewer(scene("selfCollision"), "--shader", "Phong")

    def acted(self, viewer, since, name):
        viewer.wait("action", since, name=name)
        kind, facts = CHECKS[name]
        viewer.wait(kind, since, **facts)
        # What runs is stopped, so that the next action meets the viewer as it was.
        if name in ("pause", "loop"):
            again = viewer.mark()
            viewer.xdotool("key", {"pause": "p", "loop": "l"}[name])
            viewer.wait("run", again, running=False)
        if name == "record":
            again = viewer.mark()
            viewer.xdotool("key", "F9")
            viewer.wait("saved", again, what="film")
        if name == "new_shader":
            again = viewer.mark()
            viewer.xdotool("key", "Escape")
            viewer.wait("widget", again, name="new shader name", width=0)
        viewer.settle()

    def prepare(self, viewer, name):
        if name == "quit":  # Esc closes the help first.
            since = viewer.mark()
            viewer.xdotool("key", "Escape")
            viewer.wait("help", since, visible=False)
        if name == "step_back":  # There is a past to go back to.
            viewer.step()
            viewer.step()
        if name == "reset_uniforms":  # There is something to reset.
            since = viewer.mark()
            viewer.click("uniform.u_diffuse_on")
            viewer.wait("uniform", since)
        if name == "redo":
            viewer.key("ctrl+z", "undo")
            viewer.settle()
        if name == "export_plots":  # There is something to be plotted.
            viewer.step()
        if name == "hold_vertex":  # One of the sheet as it stands at its start.
            viewer.key("r", "reset")
            viewer.settle()
            viewer.point(320, 400)
            viewer.wait("inspect")

    def test_each_has_a_check(self):
        with self.open() as viewer:
            names = [row["name"] for row in self.rows(viewer)]
            self.assertEqual(sorted(names), sorted(CHECKS), "remedy: add what the new action logs to CHECKS")
            keys = [key for row in self.rows(viewer) for key in row["keys"].split(", ") if row["keys"]]
            self.assertEqual(len(keys), len(set(keys)), "two actions have the same key")

    def test_each_by_its_keys(self):
        with self.open() as viewer:
            for row in self.rows(viewer):
                for key in filter(None, row["keys"].split(", ")):
                    with self.subTest(action=row["name"], key=key):
                        self.prepare(viewer, row["name"])
                        since = viewer.mark()
                        viewer.xdotool("key", keysym(key))
                        self.acted(viewer, since, row["name"])
                        if row["name"] == "palette":
                            viewer.xdotool("key", "Escape")
                            viewer.wait("palette", since, visible=False)
            self.assertEqual(viewer.ended(), 0, viewer.stderr())

    def test_each_by_the_palette(self):
        with self.open() as viewer:
            for row in self.rows(viewer):
                if row["name"] == "palette":
                    continue
                with self.subTest(action=row["name"]):
                    self.prepare(viewer, row["name"])
                    viewer.choose(row["title"], "action " + row["name"])
                    since = viewer.mark()
                    viewer.xdotool("key", "Return")
                    self.acted(viewer, since, row["name"])
            self.assertEqual(viewer.ended(), 0, viewer.stderr())


class Layouts(ViewerTest):
    K, V = 45, 55  # the keys of K and V on an American keyboard

    def setUp(self):
        self.addCleanup(self.layout, "us")

    def layout(self, *names):
        subprocess.run(["setxkbmap", "-display", self.display.name, *names], check=True)

    def test_control_with_a_letter_is_what_the_key_types(self):
        with self.viewer(scene("pinned2")) as viewer:
            self.layout("us", "-variant", "dvorak")
            since = viewer.mark()
            viewer.xdotool("key", "ctrl+%d" % self.K)  # types T
            viewer.xdotool("key", "ctrl+%d" % self.V)  # types K
            viewer.wait("palette", since, visible=True)
            self.assertEqual(viewer.count("palette", since, visible=False), 0)
            viewer.xdotool("key", "Escape")
            viewer.wait("palette", since, visible=False)
            # Where no key types a K, the one in its place does it.
            self.layout("ru")
            since = viewer.mark()
            viewer.xdotool("key", "ctrl+%d" % self.K)
            viewer.wait("palette", since, visible=True)


class OwnKeys(ViewerTest):
    def test_keys_of_a_text_box_run_no_actions(self):
        with self.viewer(scene("pinned2")) as viewer:
            since = viewer.mark()
            viewer.type_into("cloth.ks box", "pnrc")
            for key in ("ctrl+a", "ctrl+c", "Left", "Home", "Delete"):
                viewer.xdotool("key", key)
            # What means nothing to the box is an action all the same.
            viewer.key("F1", "help")
            self.assertEqual(viewer.count("action", since), 1)

    def test_keys_of_an_open_list_run_no_actions(self):
        with self.viewer(scene("pinned2")) as viewer:
            viewer.click("look.shader")
            viewer.box("look.shader/Phong")
            since = viewer.mark()
            for key in ("p", "space", "Tab", "Return"):
                viewer.xdotool("key", key)
            viewer.key("F1", "help")
            self.assertEqual(viewer.count("action", since), 1)


if __name__ == "__main__":
    unittest.main()
