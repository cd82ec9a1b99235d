#!/usr/bin/env python3
"""Writing shaders beside the viewer: their values are kept, a new one is a moment away, and what is saved shows at
once."""

import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest

from window import PERCALE, ROOT, ViewerTest, wait_for


class Authoring(ViewerTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name
        for name in ("shaders", "textures", "scene"):
            shutil.copytree(os.path.join(ROOT, name), os.path.join(self.root, name),
                            ignore=shutil.ignore_patterns("[A-Z]*.json"))
        self.shaders = os.path.join(self.root, "shaders")

    def open(self, *arguments):
        return self.viewer("-r", self.root, "-f", os.path.join(self.root, "scene", "pinned2.json"), *arguments)

    def write(self, name, text):
        """As editors do: beside its place, then renamed."""
        path = os.path.join(self.shaders, name)
        with open(path + ".new", "w", encoding="utf-8") as file:
            file.write(text)
        os.rename(path + ".new", path)

    def read(self, name):
        with open(os.path.join(self.shaders, name), encoding="utf-8") as file:
            return file.read()

    def shot(self, *arguments):
        file = os.path.join(self.root, "shot.png")
        subprocess.run([PERCALE, "shot", os.path.join(self.root, "scene", "pinned2.json"), "-r", self.root, "--shader",
                        "Phong", "--frame", "5", "--size", "120x90", "-o", file, *arguments], check=True,
                       capture_output=True)
        with open(file, "rb") as picture:
            return picture.read()

    def test_values_are_kept_beside_the_shader(self):
        kept = os.path.join(self.shaders, "Phong.json")
        plain = self.shot()
        with self.open("--shader", "Phong") as viewer:
            since = viewer.mark()
            viewer.click("uniform.u_diffuse_on")
            viewer.wait("uniform", since, name="u_diffuse_on")
            self.assertEqual(json.loads(wait_for("the file", lambda: os.path.exists(kept) and self.read("Phong.json"))),
                             {"u_diffuse_on": False})
            # Each shader has its own.
            since = viewer.key("bracketleft", "previous_shader")
            since = viewer.key("bracketright", "next_shader")
            viewer.wait("shader", since, name="Phong")
            # Edited by hand, they are read again, and what is wrong has its place.
            since = viewer.mark()
            self.write("Phong.json", '{\n  "u_diffuse_on": false,\n  "u_shininess": "much"\n}\n')
            viewer.wait("reload", since, what="uniforms")
            message = viewer.wait("message", since, source="values of Phong")
            self.assertEqual((message["line"], message["severity"]), (3, "warning"))
            self.assertIn("u_shininess: expected a number 1..256", message["text"])
        other = self.shot()
        self.assertNotEqual(plain, other)
        self.assertEqual(plain, self.shot("--shader-defaults"))
        self.write("Phong.json", '{ "u_diffuse_on": false }\n')
        self.assertNotEqual(other, self.shot("--uniform", "diffuse_on=1"))
        with self.open("--shader", "Phong") as viewer:
            since = viewer.mark()
            viewer.click("button reset_uniforms")
            viewer.wait("uniforms", since, shader="Phong")
            wait_for("the file to go", lambda: not os.path.exists(kept))
            # That can be undone, and done again.
            since = viewer.key("ctrl+z", "undo")
            viewer.wait("uniform", since, name="u_diffuse_on", value=[0, 0, 0])
            wait_for("the file", lambda: os.path.exists(kept))
            since = viewer.key("ctrl+y", "redo")
            viewer.wait("uniform", since, name="u_diffuse_on")
            wait_for("the file to go again", lambda: not os.path.exists(kept))
        self.assertEqual(plain, self.shot())
        # A file that is broken is told and not overwritten.
        self.write("Phong.json", "{ broken")
        with self.open("--shader", "Phong") as viewer:
            self.assertEqual(viewer.wait("message", source="values of Phong", severity="error")["line"], 1)
            since = viewer.mark()
            viewer.click("uniform.u_diffuse_on")
            viewer.wait("uniform", since)
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)
        self.assertEqual(self.read("Phong.json"), "{ broken")

    def test_a_new_shader(self):
        with self.open() as viewer:
            viewer.click("button new_shader")
            viewer.wait_for_active("new shader name")
            viewer.xdotool("type", "--delay", "60", "Phong")
            viewer.click("new shader create")
            viewer.box("new shader problem")  # There is one: another name is asked for.
            viewer.wait_for_active("new shader name")
            viewer.xdotool("type", "--delay", "60", "Mine")
            since = viewer.mark()
            viewer.click("new shader create")
            viewer.wait("shader", since, name="PhongMine")
            file = os.path.join(self.shaders, "PhongMine.frag")
            self.assertEqual(viewer.wait("message", since, source="new shader")["file"], file)
            viewer.wait("widget", since, name="new shader name", width=0)
            self.assertEqual(viewer.count("message", severity="error"), 0, viewer.stderr())
            # Escape closes the window alone.
            viewer.click("button new_shader")
            since = viewer.mark()
            viewer.box("new shader name")
            viewer.xdotool("keydown", "Escape")
            try:
                viewer.wait("widget", since, name="new shader name", width=0)
            finally:
                viewer.xdotool("keyup", "Escape")
            viewer.step()

    def test_what_is_saved_shows_at_once_also_in_included_files(self):
        self.write("shade.glsl", "vec4 Shade() { return vec4(1); }\n")
        self.write("Mine.frag", '#version 330\n#include "shade.glsl"\nout vec4 out_color;\n'
                                "void main() { out_color = Shade(); }\n")
        with self.open("--shader", "Mine") as viewer:
            def seconds(name, text, event, **facts):
                since = viewer.mark()
                begin = time.monotonic()
                self.write(name, text)
                viewer.wait(event, since, **facts)
                return time.monotonic() - begin
            times = [seconds("shade.glsl", f"vec4 Shade() {{ return vec4(0.{i}); }}\n", "reload", what="shaders")
                     for i in range(1, 7)]
            self.assertLess(min(times), 0.3, times)
            times = [seconds("Mine.frag", self.read("Mine.frag") + "\n", "reload", what="shaders") for _ in range(6)]
            self.assertLess(min(times), 0.3, times)
            # An error names the included file, its line and the line's text.
            since = viewer.mark()
            self.write("shade.glsl", "\nvec4 Shade() { return vec4(missing); }\n")
            message = viewer.wait("message", since, source="shader Mine", severity="error")
            self.assertTrue(message["file"].endswith("shade.glsl"), message)
            self.assertEqual(message["line"], 2)
            self.assertIn("2 | vec4 Shade() { return vec4(missing); }", viewer.stderr())
            viewer.box("messages")
            since = viewer.mark()
            self.write("shade.glsl", "vec4 Shade() { return vec4(1); }\n")
            viewer.wait("mended", since, source="shader Mine")


if __name__ == "__main__":
    unittest.main()
