#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Long work: frames, several files, checkpoints, tiles.

usage: long_render_check.py path/to/render. Processes are killed at random moments; whatever the moment, the picture at
the end has the bytes of an undisturbed run. No test depends on how long anything takes.
"""

import os
import random
import re
import signal
import subprocess

from render_program import RenderCase, main

CHECKPOINT = "a.tif.perigee-checkpoint"
HEADER_BYTES = 76


class Frames(RenderCase):
    def sequence(self, *numbers):
        return "".join(f"FrameBegin {n}\n{self.scene(f'f{n}.tif', size=8)}FrameEnd\n" for n in numbers)

    def test_lists_and_ranges(self):
        self.write("s.rib", self.sequence(1, 2, 3, 7, 8, 9, 10))
        for arguments, expected in ((["1,3,7-9"], [1, 3, 7, 8, 9]), (["2", "7"], [2, 3, 7]), (["10"], [10])):
            self.good("-frames", *arguments, "s.rib")
            self.assertEqual(self.files(), sorted(f"f{n}.tif" for n in expected) + ["s.rib"])
            for n in expected:
                os.remove(self.path(f"f{n}.tif"))

    def test_numbers_in_the_output_name(self):
        self.write("s.rib", self.sequence(3, 12))
        self.good("-o", "out.####.png", "s.rib")
        self.assertEqual(self.files(), ["out.0003.png", "out.0012.png", "s.rib"])

    def test_unwanted_frames_read_no_archives(self):
        self.write("s.rib", "FrameBegin 1\nWorldBegin\nReadArchive \"nowhere.rib\"\nWorldEnd\nFrameEnd\n" +
                   self.sequence(2))
        self.assertNotIn("nowhere", self.good("-frames", "2", "s.rib"))
        self.assertIn("f2.tif", self.files())

    def test_a_bad_frame_does_not_stop_the_next(self):
        self.write("s.rib", f"FrameBegin 1\n{self.scene('no/such/a.tif')}FrameEnd\n" + self.sequence(2))
        code, _, messages = self.run_render("s.rib")
        self.assertEqual(code, 3, messages)
        self.assertIn("no/such", messages)
        self.assertIn("f2.tif", self.files())

    def test_a_bad_file_does_not_stop_the_next(self):
        self.write("wrong.rib", "ErrorHandler \"abort\"\nWorldBegin\nSphere 1\n" + self.scene("never.tif"))
        self.write("open.rib", "WorldBegin\nAttributeBegin\n")
        self.write("good.rib", self.scene("good.tif"))
        code, _, messages = self.run_render("wrong.rib", "open.rib", "good.rib")
        self.assertEqual(code, 1, messages)
        self.assertIn("good.tif", self.files())
        self.assertNotIn("never.tif", self.files())
        code, _, messages = self.run_render("wrong.rib", "nowhere.rib", "good.rib")
        self.assertEqual(code, 3, messages)

    def test_files_share_shaders(self):
        self.write("own.sl", "surface own() { Oi = 1; Ci = color(1, 0, 0); }")
        for name in "ab":
            self.write(f"{name}.rib", self.scene(f"{name}.tif").replace("WorldBegin", 'WorldBegin Surface "own"'))
        self.good("--stats-json", "s.json", "a.rib", "b.rib")
        self.assertEqual(self.bytes_of("a.tif"), self.bytes_of("b.tif"))


class Checkpoints(RenderCase):
    whole = b""  # the undisturbed picture: rendered once

    def setUp(self):
        super().setUp()
        self.write("s.rib", 'PixelFilter "gaussian" 5 5\n' + self.scene(size=400, samples=4, mode="rgbaz"))
        if not self.whole:
            self.good("--no-checkpoint", "s.rib")
            Checkpoints.whole = self.bytes_of("a.tif")
            os.remove(self.path("a.tif"))

    def checkpoint_size(self):
        path = self.path(CHECKPOINT)
        return os.path.getsize(path) if os.path.exists(path) else 0

    def interrupted(self, stop, *arguments):
        """A run that is stopped when some buckets are kept; its code and messages."""
        process = self.start("-t", "1", "--checkpoint", "0", *arguments, "s.rib")
        kept = self.wait_for(lambda: self.checkpoint_size() > HEADER_BYTES, process)
        process.send_signal(stop)
        _, messages = process.communicate(timeout=100)
        self.assertTrue(kept, messages)
        return process.returncode, messages

    def resume(self, *arguments):
        messages = self.good("--resume", *arguments, "s.rib")
        self.assertEqual(self.bytes_of("a.tif"), self.whole)
        self.assertEqual(self.files(), ["a.tif", "s.rib"])
        return messages

    def test_signal_keeps_and_resume_goes_on(self):
        for stop in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            code, messages = self.interrupted(stop)
            self.assertEqual(code, -stop)
            self.assertIn("--resume", messages)
            self.assertEqual(self.files(), [CHECKPOINT, "s.rib"])
            messages = self.resume()
            self.assertGreater(int(re.search(r"(\d+) of \d+ buckets are taken", messages).group(1)), 0)
            os.remove(self.path("a.tif"))

    def test_kill_at_random_moments(self):
        moments = random.Random(3)
        for _ in range(8):
            process = self.start("-t", str(moments.randint(1, 5)), "--resume", "--checkpoint", "0", "s.rib")
            try:
                process.communicate(timeout=moments.uniform(0.02, 0.4))
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
            for name in self.files():
                self.assertIn(name, ("a.tif", CHECKPOINT, "s.rib"))
            if os.path.exists(self.path("a.tif")):
                self.assertEqual(self.bytes_of("a.tif"), self.whole, "a final name, so a whole picture")
        self.resume("-t", "3")

    def test_damaged_checkpoint(self):
        moments = random.Random(4)
        for _ in range(3):
            self.interrupted(signal.SIGTERM)
            data = bytearray(self.bytes_of(CHECKPOINT))
            if moments.random() < .5:
                data = data[:moments.randrange(len(data))]
            else:
                data[moments.randrange(len(data))] ^= 0x40
            with open(self.path(CHECKPOINT), "wb") as file:
                file.write(data)
            self.resume()
            os.remove(self.path("a.tif"))

    def test_another_scene_is_refused(self):
        self.interrupted(signal.SIGTERM)
        with open(self.path("s.rib"), encoding="utf-8") as file:
            scene = file.read()
        for change in (scene.replace("Sphere .5", "Sphere .500001"), 'Exposure 2 1\n' + scene):
            self.write("s.rib", change)
            self.good("--no-checkpoint", "-o", "new.tif", "s.rib")
            code, _, messages = self.run_render("--strict", "--resume", "--checkpoint", "100", "s.rib")
            self.assertEqual(code, 1)
            self.assertIn("does not belong to this frame", messages)
            self.assertEqual(self.bytes_of("a.tif"), self.bytes_of("new.tif"))
            self.write("s.rib", scene)
            self.interrupted(signal.SIGTERM)
        self.write("s.rib", "# a comment changes nothing\n\n" + scene)
        self.assertIn("are taken", self.good("--resume", "s.rib"))

    def test_second_signal_ends_at_once(self):
        process = self.start("-t", "1", "--checkpoint", "0", "s.rib")
        self.wait_for(lambda: self.checkpoint_size() > HEADER_BYTES, process)
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=100)
        self.assertIn(process.returncode, (-signal.SIGTERM, -signal.SIGINT))
        self.resume()

    def test_short_frames_leave_nothing(self):
        self.write("s.rib", self.scene())
        self.good("s.rib")
        self.assertEqual(self.files(), ["a.tif", "s.rib"])

    def test_a_directory_of_its_own(self):
        os.mkdir(self.path("kept"))
        process = self.start("-t", "1", "--checkpoint", "0", "--checkpoint-dir", "kept", "s.rib")
        kept = os.path.join("kept", CHECKPOINT)
        self.wait_for(lambda: os.path.exists(self.path(kept)) and os.path.getsize(self.path(kept)) > HEADER_BYTES,
                      process)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=100)
        self.assertIn("are taken", self.good("--resume", "--checkpoint-dir", "kept", "s.rib"))
        self.assertEqual(self.bytes_of("a.tif"), self.whole)
        self.assertEqual(os.listdir(self.path("kept")), [])

    def test_two_renders_of_one_picture(self):
        first = self.start("-t", "1", "--checkpoint", "0", "s.rib")
        self.wait_for(lambda: self.checkpoint_size() > HEADER_BYTES, first)
        first.send_signal(signal.SIGSTOP)
        messages = self.good("--checkpoint", "0", "s.rib")
        first.send_signal(signal.SIGCONT)
        first.communicate(timeout=100)
        self.assertIn("another render", messages)
        self.assertEqual(self.bytes_of("a.tif"), self.whole)


class Tiles(RenderCase):
    CROPS = ("0 .3 0 .5", ".3 1 0 .5", "0 .6 .5 1", ".6 1 .5 .8", ".6 1 .8 1")

    def render_tiles(self, display, end):
        self.write("s.rib", self.scene(size=90).split("Projection")[0].replace("#", "") + display + "\nProjection" +
                   self.scene().split("Projection")[1])
        self.good("-o", "whole" + end, "s.rib")
        tiles = []
        for i, crop in enumerate(self.CROPS):
            tiles.append(f"t{i}{end}")
            self.good("-crop", *crop.split(), "-o", tiles[-1], "s.rib")
        return tiles

    def test_merged_bytes_are_those_of_the_whole(self):
        for display, end in (('Display "x" "file" "rgba"', ".tif"), ('Display "x" "file" "rgbz"', ".tif"),
                             ('Display "x" "file" "rgba"', ".png"), ('Display "x" "file" "rgba"', ".exr"),
                             ('Display "x" "file" "rgbaz" Quantize "rgba" 65535 0 65535 .5', ".exr"),
                             ('Quantize "rgba" 65535 0 65535 .5 Display "x" "file" "rgb"', ".png"),
                             ('Display "x" "file" "a"', ".png"),
                             ('Display "x" "file" "rgba,varying normal N" "integer multipart" 1', ".exr"),
                             ('Display "x" "file" "rgba,varying normal N" "string compression" "piz"', ".exr")):
            tiles = self.render_tiles(display, end)
            self.good("--merge", "-o", "merged" + end, *reversed(tiles))
            self.assertEqual(self.bytes_of("merged" + end), self.bytes_of("whole" + end), display + end)

    def test_part_of_the_frame(self):
        tiles = self.render_tiles('Display "x" "file" "rgba"', ".png")
        self.good("-crop", "0", "1", "0", ".5", "-o", "part.png", "s.rib")
        self.good("--merge", "-crop", "0", "1", "0", ".5", "-o", "merged.png", *tiles[:2])
        self.assertEqual(self.bytes_of("merged.png"), self.bytes_of("part.png"))

    def test_what_does_not_fit(self):
        tiles = self.render_tiles('Display "x" "file" "rgba"', ".exr")
        self.good("-res", "50", "50", "-crop", "0", ".3", "0", ".5", "-o", "other.exr", "-", text="WorldBegin WorldEnd")
        self.write("moved.rib", "Translate 1 0 0\n")
        self.good("-crop", "0", ".3", "0", ".5", "-option", "Translate 1 0 0", "-o", "moved.exr", "s.rib")
        with open(self.path("broken.exr"), "wb") as file:
            file.write(self.bytes_of(tiles[0])[:300])
        for what, arguments in (("no tile has", tiles[1:]), ("no tile has", tiles[:-1]),
                                ("overlap", [*tiles, tiles[2]]), ("does not belong", [*tiles[1:], "other.exr"]),
                                ("does not belong", [*tiles[1:], "moved.exr"]), ("broken.exr", [*tiles[1:], "broken.exr"]),
                                ("No such file", [*tiles[1:], "nowhere.exr"]), ("s.rib", [*tiles, "s.rib"])):
            code, _, messages = self.run_render("--merge", "-o", "merged.exr", *arguments)
            self.assertEqual(code, 1, messages)
            self.assertIn(what, messages)
            self.assertNotIn("merged.exr", self.files())
        code, _, messages = self.run_render("--merge", "-o", "no/such/merged.exr", *tiles)
        self.assertEqual(code, 3, messages)
        for arguments in (["--merge", *tiles], ["--merge", "-o", "x.exr"]):
            self.assertEqual(self.run_render(*arguments)[0], 2)


if __name__ == "__main__":
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # under nohup it is ignored, and children inherit that
    main()
