#!/usr/bin/env python3
"""What the viewer writes: checkpoints, pictures that bring back what they show, and films."""

import glob
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest

from window import PERCALE, ROOT, ViewerTest, scene, state_hash, wait_for


def percale(*arguments, code=0):
    done = subprocess.run([PERCALE, *map(str, arguments)], capture_output=True, text=True, timeout=120)
    if done.returncode != code:
        raise AssertionError(f"percale {arguments}: {done.returncode}, {done.stdout} {done.stderr}")
    return done


def facts(file):
    """What `percale info` tells of where a file stands."""
    text = percale("info", file).stdout
    return (int(re.search(r"^stands at +frame (\d+),", text, re.MULTILINE).group(1)),
            re.search(r"^state +([0-9a-f]{16})$", text, re.MULTILINE).group(1))


class Keeping(ViewerTest):
    def saved(self, viewer, key, action, what):
        since = viewer.key(key, action)
        return viewer.wait("saved", since, what=what)["file"]

    def drag(self, viewer):
        """Takes hold of the cloth, so that no run from the start leads here."""
        viewer.point(320, 250)
        viewer.xdotool("keydown", "shift", "mousedown", 1)
        since = viewer.mark()
        for i in range(6):
            viewer.point(320, 250 - 6 * i)
            viewer.xdotool("sleep", "0.03")
        viewer.xdotool("mouseup", 1, "keyup", "shift")
        viewer.wait("place", since)
        viewer.settle()

    def test_a_checkpoint_goes_on_to_the_same_bits(self):
        with self.viewer("-f", scene("pinned2"), "--shader", "Phong") as viewer:
            for _ in range(3):
                viewer.step()
            since = viewer.mark()
            viewer.xdotool("click", 4)
            camera = viewer.wait("camera", since) if viewer.count("camera", since) else None
            self.drag(viewer)
            viewer.key("bracketleft", "previous_shader")
            first = self.saved(viewer, "ctrl+s", "save_state", "checkpoint")
            self.assertEqual(first, os.path.join(viewer.folder, "pinned2-frame3.percale"))
            self.assertIn(first + ": note:", viewer.stderr())
            second = self.saved(viewer, "ctrl+s", "save_state", "checkpoint")
            self.assertEqual(os.path.basename(second), "pinned2-frame3-1.percale")
            with open(first, "rb") as a, open(second, "rb") as b:
                self.assertEqual(a.read(), b.read())
            saved = viewer.state()["hash"]
            self.assertEqual(facts(first), (3, saved))
            for _ in range(2):
                viewer.step()
            went_on = viewer.state()["hash"]
            self.assertEqual(state_hash(first, 2), went_on)

            # Back to the newest, and back from there.
            since = viewer.key("ctrl+l", "load_state")
            self.assertEqual(viewer.wait("load", since)["file"], second)
            viewer.settle()
            self.assertEqual((viewer.state()["frame"], viewer.state()["hash"]), (3, saved))
            viewer.key("ctrl+z", "undo")
            viewer.settle()
            self.assertEqual(viewer.state()["hash"], went_on)
            viewer.key("ctrl+y", "redo")
            viewer.settle()
            self.assertEqual(viewer.state()["hash"], saved)
            viewer.step()
            end = viewer.step()["hash"]
            self.assertEqual(end, went_on)
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)
            replayed = percale("replay", viewer.log)
            self.assertIn(f"state   {end}", replayed.stdout)

            # The replay needs the file, and tells when it is another.
            shutil.copy(second, second + ".good")
            os.remove(second)
            self.assertIn("there is no such file", percale("replay", viewer.log, code=3).stderr)
            percale("simulate", scene("pinned2"), "--frames", 1)
            with self.viewer(first) as again:
                other = self.saved(again, "ctrl+s", "save_state", "checkpoint")  # Not the World it was in: look and all
                again.wait("state", frame=3, hash=saved)
                self.assertEqual(again.start["shader"], "Diffuse")
                self.assertEqual(os.path.basename(other), "pinned2-frame3.percale")
                self.assertEqual(again.step()["frame"], 4)
                self.assertEqual(again.step()["hash"], went_on)
                later = self.saved(again, "ctrl+s", "save_state", "checkpoint")
                shutil.copy(later, second)
            result = percale("replay", viewer.log, code=3)
            self.assertIn("holds another state than when the session loaded it", result.stderr)
            del camera

    def test_a_checkpoint_that_is_dropped(self):
        with self.viewer("-f", scene("pinned4")) as viewer:
            viewer.step()
            file = self.saved(viewer, "ctrl+s", "save_state", "checkpoint")
            saved = viewer.state()["hash"]
            since = viewer.key("braceright", "next_scene")
            viewer.wait("open", since)
            since = viewer.mark()
            viewer.drop(file)
            viewer.wait("load", since)
            viewer.wait("state", since, frame=1, hash=saved)
            wait_for("the title", lambda: "pinned4-frame1.percale" in viewer.title())
            # One that is cut is told, and all stays.
            with open(file, "rb") as whole, open(os.path.join(viewer.folder, "cut.percale"), "wb") as cut:
                cut.write(whole.read()[:1000])
            since = viewer.mark()
            viewer.drop(os.path.join(viewer.folder, "cut.percale"))
            self.assertIn("cut short", viewer.wait("message", since, source="open", severity="error")["text"])
            since = viewer.key("r", "reset")
            viewer.wait("state", since, frame=0)

    def test_a_picture_brings_back_what_it_shows(self):
        with self.viewer("-f", scene("pinned2"), "--shader", "Phong", "--uniform", "shininess=7") as viewer:
            viewer.type_number("cloth.ks", "4000")
            viewer.step()
            self.drag(viewer)
            viewer.step()
            shown = viewer.state()
            file = self.saved(viewer, "F12", "picture", "picture")
            self.assertEqual(file, os.path.join(viewer.folder, "pinned2-1.png"))
            self.assertEqual(facts(file), (shown["frame"], shown["hash"]))
            self.assertEqual(os.path.basename(self.saved(viewer, "F12", "picture", "picture")), "pinned2-2.png")
            kept = viewer.folder + ".png"
            shutil.copy(file, kept)
            self.addCleanup(os.remove, kept)
            # Dropped: settings, shader and state come back.
            viewer.key("bracketright", "next_shader")
            viewer.key("r", "reset")
            since = viewer.mark()
            viewer.drop(file)
            viewer.wait("state", since, frame=shown["frame"], hash=shown["hash"])
            viewer.wait("shader", since, name="Phong")
            self.assertEqual(json.loads(viewer.wait("load", since)["config"])["cloth"]["ks"], 4000)
            # The next pictures are called after the scene still.
            self.assertEqual(os.path.basename(self.saved(viewer, "F12", "picture", "picture")), "pinned2-3.png")
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)
            self.assertIn("equal to the last bit", percale("replay", viewer.log).stdout)
        with self.viewer(kept) as viewer:
            self.assertEqual(viewer.start["shader"], "Phong")
            viewer.wait("state", frame=shown["frame"], hash=shown["hash"])
            again = self.saved(viewer, "F12", "picture", "picture")
            with open(again, "rb") as a, open(kept, "rb") as b:
                self.assertEqual(a.read(), b.read())  # pixels, settings, state: all of it

    def test_a_picture_of_shot_runs_to_its_frame(self):
        with self.viewer("-f", scene("pinned2")) as viewer:
            file = os.path.join(viewer.folder, "shot.png")
            percale("shot", scene("sphere"), "--frame", 12, "--camera", "30,20", "--shader", "Normal", "--size", "200x150",
                    "-o", file)
            since = viewer.mark()
            viewer.drop(file)
            viewer.wait("shader", since, name="Normal")
            viewer.wait("state", since, frame=12, hash=state_hash(scene("sphere"), 12))
            self.assertAlmostEqual(viewer.wait("camera", since)["azimuth"], 30)
            self.assertEqual(state_hash(file, 3), state_hash(scene("sphere"), 15))

    def test_another_picture_becomes_a_texture(self):
        with self.viewer("-f", scene("pinned2"), "--shader", "Texture") as viewer:
            texture = os.path.join(viewer.folder, "other.png")
            shutil.copy(os.path.join(ROOT, "textures", "texture_2.png"), texture)
            since = viewer.mark()
            viewer.drop(texture)
            self.assertEqual(viewer.wait("texture", since)["file"], texture)
            self.assertIn("texture 1", viewer.wait("message", since, source="texture")["text"])
            picture = self.saved(viewer, "F12", "picture", "picture")
            since = viewer.key("ctrl+z", "undo")
            self.assertEqual(viewer.wait("texture", since)["file"], "")
            since = viewer.key("ctrl+y", "redo")
            self.assertEqual(viewer.wait("texture", since)["file"], texture)
            with open(picture, "rb") as file:
                self.assertIn(json.dumps(texture).encode(), file.read())
            # What is damaged is told.
            with open(texture, "rb") as whole, open(os.path.join(viewer.folder, "cut.png"), "wb") as cut:
                cut.write(whole.read()[:2000])
            since = viewer.mark()
            viewer.drop(os.path.join(viewer.folder, "cut.png"))
            self.assertIn("damaged", viewer.wait("message", since, source="open")["text"])

    def test_a_film_of_the_window(self):
        with self.viewer("-f", scene("pinned2"), "--shader", "Normal", "--size", "700x500") as viewer:
            since = viewer.key("F9", "record")
            viewer.wait("record", since, recording=True)
            viewer.key("p", "pause")
            viewer.wait("state", where=lambda state: state["frame"] > 30)
            viewer.key("Tab", "panels")  # the picture is wider now, the film is not
            viewer.xdotool("sleep", "0.5")
            begin = viewer.find("record", since)["t"]
            since = viewer.key("F9", "record")
            end = viewer.wait("record", since, recording=False)["t"]
            film = viewer.wait("saved", since, what="film")["file"]
            self.assertEqual(film, os.path.join(viewer.folder, "pinned2-1.mp4"))
            probed = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                                     "stream=width,height,nb_read_frames,avg_frame_rate", "-of", "json", film],
                                    capture_output=True, text=True, check=True)
            stream = json.loads(probed.stdout)["streams"][0]
            self.assertEqual((stream["height"], stream["avg_frame_rate"]), (500, "30/1"))
            self.assertLess(stream["width"], 400)  # without the panels
            # It lasts as long as it took.
            self.assertAlmostEqual(int(stream["nb_read_frames"]) / 30, end - begin, delta=0.5)

            # Quitting ends the film.
            viewer.key("F9", "record")
            viewer.xdotool("sleep", "0.3")
            viewer.xdotool("key", "Escape")
            self.assertEqual(viewer.ended(), 0)
            self.assertTrue(os.path.getsize(os.path.join(viewer.folder, "pinned2-2.mp4")) > 0)
            self.assertIn("pinned2-2.mp4: ", viewer.stderr())
            self.assertEqual(viewer.events[-1]["event"], "exit")

    def test_a_film_without_ffmpeg_and_where_nothing_can_be_written(self):
        tools = tempfile.TemporaryDirectory()
        self.addCleanup(tools.cleanup)
        os.symlink(shutil.which("xdotool"), os.path.join(tools.name, "xdotool"))
        place = os.path.join(tools.name, "place")
        os.mkdir(place)
        with self.viewer("-f", scene("pinned2"), "--size", "600x400", environment={"PATH": tools.name},
                         cwd=place) as viewer:
            since = viewer.key("F9", "record")
            self.assertIn("ffmpeg was not found", viewer.wait("message", since, source="saving a film")["text"])
            viewer.xdotool("sleep", "0.3")
            since = viewer.key("F9", "record")
            folder = viewer.wait("saved", since, what="film")["file"]
            self.assertEqual(folder, os.path.join(place, "pinned2-1"))
            self.assertGreater(len(glob.glob(os.path.join(folder, "*.png"))), 5)
            shutil.rmtree(place)
            for key, action, what in (("F9", "record", "film"), ("F12", "picture", "picture"),
                                      ("ctrl+s", "save_state", "checkpoint")):
                since = viewer.key(key, action)
                viewer.wait("message", since, source="saving a " + what, severity="error")
            self.assertEqual(viewer.step()["frame"], 1)


if __name__ == "__main__":
    unittest.main()
