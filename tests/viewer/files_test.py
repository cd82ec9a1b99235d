#!/usr/bin/env python3
"""Shaders and scenes in the viewer: choosing them, and editing their files while it runs."""

import json
import os
import shutil
import tempfile
import unittest

from window import ROOT, ViewerTest, scene, state_hash

SHADERS = ["Wireframe", "Normal", "Diffuse", "Phong", "Texture", "Bump", "Displacement", "Mirror", "Flag", "Fabric"]


def write(path, text):
    """As editors do: beside its place, then renamed."""
    with open(path + ".new", "w", encoding="utf-8") as file:
        file.write(text)
    os.rename(path + ".new", path)


class Shaders(ViewerTest):
    def test_keys_go_round(self):
        with self.viewer(scene("sphere")) as viewer:
            since = viewer.mark()
            for _ in SHADERS:
                viewer.key("bracketright", "next_shader")
            last = viewer.key("bracketleft", "previous_shader")
            viewer.wait("shader", last)
            seen = [event["name"] for event in viewer.events[since:] if event["event"] == "shader"]
            self.assertEqual(seen, SHADERS[1:] + SHADERS[:1] + SHADERS[-1:])
            # Each has drawn at least one picture without complaint.
            self.assertEqual(viewer.count("message"), 0, viewer.stderr())

    def test_escape_closes_an_open_list_first(self):
        with self.viewer(scene("sphere")) as viewer:
            viewer.click("look.shader")
            viewer.box("look.shader/Phong")
            since = viewer.mark()
            viewer.xdotool("key", "Escape")
            viewer.wait("widget", since, name="look.shader/Phong", width=0)
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)

    def test_drop_down(self):
        with self.viewer(scene("sphere")) as viewer:
            viewer.click("look.shader")
            since = viewer.mark()
            viewer.click("look.shader/Phong")
            viewer.wait("shader", since, name="Phong")
            # Its parameters are there, and act.
            since = viewer.mark()
            viewer.click("uniform.u_shininess")
            self.assertGreater(viewer.wait("uniform", since, name="u_shininess")["value"][0], 100)
            since = viewer.mark()
            viewer.click("uniform.u_diffuse_on")
            self.assertEqual(viewer.wait("uniform", since, name="u_diffuse_on")["value"][0], 0)
            since = viewer.mark()
            viewer.type_number("uniform.u_shininess", "much")
            message = viewer.wait("message", since, severity="error")
            self.assertIn('Shininess: expected a number, got "much"', message["text"])


class Editing(ViewerTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name
        for name in ("shaders", "textures", "scene"):
            shutil.copytree(os.path.join(ROOT, name), os.path.join(self.root, name))
        self.scene = os.path.join(self.root, "scene", "pinned2.json")

    def open(self, *arguments):
        return self.viewer("-r", self.root, "-f", self.scene, *arguments)

    def read_scene(self):
        with open(self.scene, encoding="utf-8") as file:
            return json.load(file)

    def test_a_shader_is_read_again_when_it_is_saved(self):
        file = os.path.join(self.root, "shaders", "Normal.frag")
        with open(file, encoding="utf-8") as good:
            text = good.read()
        with self.open("--shader", "Normal") as viewer:
            since = viewer.mark()
            lines = text.split("\n")
            lines.insert(len(lines) - 2, "  this is no GLSL;")
            write(file, "\n".join(lines))
            message = viewer.wait("message", since, source="shader Normal", severity="error")
            self.assertTrue(message["file"].endswith("Normal.frag"), message)
            self.assertEqual(message["line"], len(lines) - 2)
            self.assertIn("Normal.frag:" + str(len(lines) - 2), viewer.stderr())
            # It goes on with the last good one.
            self.assertEqual(viewer.step()["frame"], 1)

            since = viewer.mark()
            write(file, text + "\n")
            viewer.wait("mended", since, source="shader Normal")

    def test_a_new_shader_appears(self):
        with self.open() as viewer:
            since = viewer.mark()
            shutil.copy(os.path.join(self.root, "shaders", "Normal.frag"), os.path.join(self.root, "shaders", "Zzz.frag"))
            viewer.wait("reload", since, what="shaders")
            since = viewer.key("bracketleft", "previous_shader")  # from the first to the last, which is the new one
            viewer.wait("shader", since, name="Zzz")
            since = viewer.mark()
            os.remove(os.path.join(self.root, "shaders", "Zzz.frag"))
            message = viewer.wait("message", since, source="shader Zzz")
            self.assertIn("no shader called", message["text"])
            since = viewer.key("bracketright", "next_shader")
            viewer.wait("shader", since, name="Wireframe")
            self.assertEqual(viewer.step()["frame"], 1)

    def test_a_scene_is_read_again_when_it_is_saved(self):
        with self.open() as viewer:
            viewer.step()
            before = viewer.step()
            # Settings that act at once leave the cloth where it is.
            since = viewer.mark()
            changed = self.read_scene()
            changed["cloth"]["ks"] = 777
            write(self.scene, json.dumps(changed))
            reload = viewer.wait("reload", since, what="scene")
            done = viewer.wait("done", since, command=reload["command"])
            self.assertTrue(done["kept"])
            self.assertEqual((done["frame"], done["hash"]), (2, before["hash"]))

            # Another grid is another cloth.
            since = viewer.mark()
            changed["cloth"].update(num_width_points=20, num_height_points=20, pinned=[[0, 0], [19, 0]])
            write(self.scene, json.dumps(changed))
            reload = viewer.wait("reload", since, what="scene")
            self.assertFalse(viewer.wait("done", since, command=reload["command"])["kept"])
            self.assertEqual(viewer.step()["hash"], state_hash(self.scene, 1))

    def test_a_mesh_is_read_again_when_it_is_saved(self):
        mesh, square = os.path.join(self.root, "scene", "square.obj"), "v 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 0 0\n"
        write(mesh, square + "f 1 2 3\nf 1 3 4\n")
        self.scene = os.path.join(self.root, "scene", "square.json")
        write(self.scene, json.dumps({"simulation": {"engine": "fabric"},
                                      "cloth": {"shape": "mesh", "mesh": "square.obj", "pinned": [0]}}))
        with self.open() as viewer:
            viewer.step()
            since = viewer.mark()
            write(mesh, square + "v 0.5 1.5 0\nf 1 2 3\nf 1 3 4\nf 2 1 5\n")
            reload = viewer.wait("reload", since, what="scene")
            self.assertFalse(viewer.wait("done", since, command=reload["command"])["kept"])
            self.assertEqual(viewer.step()["hash"], state_hash(self.scene, 1))
            # A broken one is told, and the old one stays.
            since = viewer.mark()
            write(mesh, square + "f 1 2 9\n")
            message = viewer.wait("message", since, source="scene", severity="error",
                                  where=lambda event: event["file"].endswith("square.obj"))
            self.assertEqual(message["line"], 5)
            self.assertEqual(viewer.step()["frame"], 2)

    def test_the_mesh_of_a_collider_is_read_again_when_it_is_saved(self):
        mesh, corners = os.path.join(self.root, "scene", "tent.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
        write(mesh, corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        self.scene = os.path.join(self.root, "scene", "tent.json")
        write(self.scene, json.dumps({"simulation": {"engine": "fabric"}, "cloth": {"pinned": [[0, 0]]},
                                      "collider": {"shape": "mesh", "mesh": "tent.obj"}}))
        with self.open() as viewer:
            self.assertEqual(viewer.count("message"), 0)
            viewer.step()
            since = viewer.mark()
            write(mesh, corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\n")
            viewer.wait("reload", since, what="scene")
            message = viewer.wait("message", since, severity="warning")
            self.assertIn("the mesh is open: 3 edges", message["text"])

    def test_a_broken_scene_leaves_the_old_one(self):
        with self.open() as viewer:
            with open(self.scene, encoding="utf-8") as file:
                good = file.read()
            since = viewer.mark()
            write(self.scene, good.replace("5000", '"5k"', 1))
            message = viewer.wait("message", since, source="scene", severity="error")
            self.assertIn("/cloth", message["text"])
            self.assertGreater(message["line"], 0)
            self.assertIn('"5k"', message["text"])
            self.assertEqual(viewer.count("reload", since), 0)
            self.assertEqual(viewer.step()["hash"], state_hash(scene("pinned2"), 1))

            since = viewer.mark()
            write(self.scene, good)
            viewer.wait("mended", since, source="scene")
            viewer.wait("reload", since, what="scene")

    def test_a_warning_about_the_settings_is_told_once_and_goes(self):
        with self.open() as viewer:
            since = viewer.mark()
            changed = self.read_scene()
            changed["cloth"]["ks"] = 300000
            write(self.scene, json.dumps(changed))
            viewer.wait("reload", since, what="scene")
            viewer.type_number("cloth.ks", "5000")
            viewer.wait("mended", since, source="settings")
            told = [event for event in viewer.events[since:] if event["event"] == "message"]
            self.assertEqual([event["source"] for event in told], ["settings"])

    def test_f5_reads_everything_again(self):
        with self.open() as viewer:
            since = viewer.key("F5", "reload")
            viewer.wait("reload", since, what="scene")
            viewer.wait("reload", since, what="shaders")

    def test_a_texture_is_read_again_when_it_is_saved(self):
        texture = os.path.join(self.root, "textures", "texture_1.png")
        with self.open("--shader", "Texture") as viewer:
            since = viewer.key("F5", "reload")
            viewer.wait("reload", since, what="texture", file=texture)
            since = viewer.mark()
            shutil.copy(os.path.join(self.root, "textures", "texture_2.png"), texture)
            viewer.wait("reload", since, what="texture", file=texture)
            self.assertEqual(viewer.count("message"), 0)

            since = viewer.mark()
            write(texture, "no picture")
            message = viewer.wait("message", since, file=texture, severity="warning")
            self.assertIn("the picture before it stays", message["text"])
            since = viewer.mark()
            shutil.copy(os.path.join(ROOT, "textures", "texture_1.png"), texture)
            viewer.wait("mended", since, source="drawing: " + texture)

    def test_settings_of_the_command_line_outlive_a_reload(self):
        with self.open("--set", "cloth.ks=250") as viewer:
            since = viewer.mark()
            changed = self.read_scene()
            changed["cloth"]["density"] = 300
            write(self.scene, json.dumps(changed))
            reload = viewer.wait("reload", since, what="scene")
            viewer.wait("done", since, command=reload["command"])
            self.assertEqual(viewer.step()["hash"], state_hash(self.scene, 1, "--set", "cloth.ks=250"))

    def test_the_scenes_of_the_folder(self):
        names = sorted(name for name in os.listdir(os.path.join(self.root, "scene")) if name.endswith(".json"))
        at = names.index("pinned2.json")
        with self.open() as viewer:
            viewer.step()
            since = viewer.key("braceright", "next_scene")
            opened = viewer.wait("open", since)
            self.assertEqual(os.path.basename(opened["scene"]), names[(at + 1) % len(names)])
            viewer.wait("state", since, frame=0)
            since = viewer.key("braceleft", "previous_scene")
            opened = viewer.wait("open", since)
            self.assertEqual(os.path.basename(opened["scene"]), "pinned2.json")
            # Paused, at its start.
            viewer.wait("state", since, frame=0, running=False, hash=viewer.start["hash"])

    def test_a_scene_of_the_folder_that_is_broken(self):
        names = sorted(name for name in os.listdir(os.path.join(self.root, "scene")) if name.endswith(".json"))
        after = names[(names.index("pinned2.json") + 1) % len(names)]
        broken = os.path.join(self.root, "scene", "pinned2a.json")
        write(broken, "{")
        with self.open() as viewer:
            since = viewer.key("braceright", "next_scene")
            message = viewer.wait("message", since, source="open", severity="error")
            self.assertTrue(message["file"].endswith("pinned2a.json"))
            self.assertEqual(viewer.step()["hash"], state_hash(self.scene, 1))  # the old one is still there
            since = viewer.key("braceright", "next_scene")
            self.assertEqual(os.path.basename(viewer.wait("open", since)["scene"]), after)

    def test_a_pipe_in_the_folder_does_not_stop_the_window(self):
        os.mkfifo(os.path.join(self.root, "scene", "pinned2a.json"))
        with self.open() as viewer:
            since = viewer.key("braceright", "next_scene")
            message = viewer.wait("message", since, source="open", severity="error")
            self.assertIn("device or pipe", message["text"])
            viewer.step()


if __name__ == "__main__":
    unittest.main()
