#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The program render from outside: exit codes, interruption, the same bytes whatever the threads.

usage: render_check.py path/to/render. Scenes use the built-in default surface, so no shader is needed.
"""

import json
import os
import signal
import subprocess
import time

from render_program import RenderCase, main


class Render(RenderCase):
    def test_exit_codes(self):
        self.write("good.rib", self.scene())
        self.assertEqual(self.run_render("good.rib")[0], 0)
        self.assertEqual(self.files(), ["a.tif", "good.rib"])
        code, _, messages = self.run_render("-", text=self.scene() + "Sphere 1 2")
        self.assertEqual(code, 1, messages)
        code, _, messages = self.run_render("-bogus")
        self.assertEqual(code, 2)
        self.assertIn("-bogus", messages)
        self.assertEqual(self.run_render("nowhere.rib")[0], 3)
        self.write("nodir.rib", self.scene("no/such/place.tif"))
        self.assertEqual(self.run_render("nodir.rib")[0], 3)

    def test_o_leaves_other_displays_alone(self):
        second = 'Display "+second.tif" "file" "rgb"\nProjection'
        self.write("two.rib", self.scene().replace("Projection", second, 1))
        self.assertEqual(self.run_render("-o", "b.png", "two.rib")[0], 0)
        self.assertEqual(self.files(), ["b.png", "second.tif", "two.rib"])

    def test_o_leaves_shadow_maps_alone(self):
        self.write("map.rib", self.scene().replace('"file" "rgba"', '"zfile" "z"'))
        self.run_render("-o", "b.png", "map.rib")
        self.assertNotIn("b.png", self.files())

    def test_openimageio_is_loaded_only_for_its_formats(self):
        for name, loads in (("a.exr", False), ("a.tif", False), ("a.png", False), ("a.jpg", True)):
            self.write("scene.rib", self.scene(name))
            environment = dict(self.environment, LD_DEBUG="files")
            process = subprocess.run([self.program, "scene.rib"], cwd=self.folder.name, env=environment, timeout=100,
                                     capture_output=True, text=True, check=False)
            self.assertEqual(process.returncode, 0)
            if not loads:
                self.assertNotIn("OpenImageIO", process.stderr)
            elif os.path.exists(self.path("a.jpg")):  # else the module is not installed, and it is a TIFF
                self.assertIn("OpenImageIO", process.stderr)

    def test_strict_counts_warnings(self):
        self.write("warn.rib", 'Option "nonsense" "uniform float x" [1]\n' + self.scene())
        self.assertEqual(self.run_render("warn.rib")[0], 0)
        self.assertEqual(self.run_render("--strict", "warn.rib")[0], 1)

    def test_missing_shader_renders_anyway(self):
        code, _, messages = self.run_render("-", text=self.scene().replace("WorldBegin", 'WorldBegin Surface "nosuch"'))
        self.assertEqual(code, 1)
        self.assertIn("nosuch", messages)
        self.assertIn("a.tif", self.files())

    def test_same_bytes_for_any_threads_and_buckets(self):
        pictures = []
        for threads, bucket in (("1", "16 16"), ("2", "16 16"), ("3", "7 9")):
            self.write("s.rib", f'Option "limits" "bucketsize" [{bucket}]\n' + self.scene())
            self.assertEqual(self.run_render("-t", threads, "s.rib")[0], 0)
            pictures.append(self.bytes_of("a.tif"))
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[0], pictures[2])

    def test_interrupt_leaves_no_file(self):
        for stop in (signal.SIGINT, signal.SIGTERM):
            self.write("long.rib", self.scene(size=2000, samples=16))
            process = self.start("--progress=lines", "-t", "1", "long.rib")
            process.stderr.readline()  # the first tenth is done: it renders
            process.send_signal(stop)
            started = time.monotonic()
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, -stop)
            self.assertLess(time.monotonic() - started, 50)
            self.assertEqual(self.files(), ["long.rib"])

    def test_output_switch_and_default_name(self):
        self.write("two.rib", "FrameBegin 3\n" + self.scene() + "FrameEnd\nFrameBegin 4\n" + self.scene() + "FrameEnd\n")
        self.assertEqual(self.run_render("-o", "f.##.png", "-frames", "4", "two.rib")[0], 0)
        self.assertEqual(self.files(), ["f.04.png", "two.rib"])
        self.write("plain.rib", self.scene().replace("Display", "#Display"))
        self.assertEqual(self.run_render("plain.rib")[0], 0)
        self.assertIn("plain.tif", self.files())

    def test_safe_keeps_existing_pictures(self):
        self.write("good.rib", self.scene())
        self.write("a.tif", "mine")
        code, _, messages = self.run_render("-safe", "good.rib")
        self.assertEqual(code, 0)
        self.assertIn("skipped", messages)
        self.assertEqual(self.bytes_of("a.tif"), b"mine")

    def test_rendribrc_and_option_come_first(self):
        self.write(".rendribrc", "Format 24 24 1\nPixelSamples 1 1\n")
        scene = self.scene().replace("Format 40 40 1", "").replace("PixelSamples", "#")
        self.write("s.rib", scene)
        self.assertEqual(self.run_render("-o", "rc.tif", "s.rib")[0], 0)
        self.assertEqual(self.run_render("-o", "option.tif", "-option", "Format 40 40 1", "s.rib")[0], 0)
        self.assertLess(len(self.bytes_of("rc.tif")), len(self.bytes_of("option.tif")))

    def test_statistics(self):
        self.write("good.rib", self.scene())
        code, _, messages = self.run_render("--stats", "--stats-json", "s.json", "good.rib")
        self.assertEqual(code, 0)
        self.assertIn("camera rays", messages)
        statistics = json.loads(self.bytes_of("s.json"))
        self.assertEqual((statistics["schema"], statistics["version"]), ("perigee-statistics", 1))
        self.assertEqual(statistics["files"], ["good.rib"])
        self.check_sums(statistics["total"])

    def check_sums(self, stats):
        """Counts of one thing by several hands agree."""
        counters, shaders = stats["counters"], stats["shaders"]
        self.assertEqual(counters["samples"], stats["amounts"]["sample_pixels"] * 4)
        self.assertEqual(counters["rays_camera"], counters["samples"])
        of_type = {t: [s for s in shaders if s["type"] == t] for t in ("surface", "volume", "imager", "light")}
        self.assertEqual(sum(s["points"] for s in of_type["surface"]), counters["hits"])
        self.assertEqual(counters["points_surface"], counters["hits"])
        self.assertEqual(sum(s["points"] for s in of_type["volume"]), counters["points_volume"])
        self.assertEqual(sum(s["points"] for s in of_type["imager"]), counters["points_imager"])
        shaded = of_type["surface"] + of_type["volume"]
        for key in ("batches", "packets", "lanes_offered", "lanes_live"):
            self.assertEqual(sum(s[key] for s in shaded), counters[key], key)
        self.assertEqual(sum(s["packets"] for s in of_type["light"]), counters["light_packets"])
        self.assertLessEqual(counters["lanes_live"], counters["lanes_offered"])
        self.assertTrue(0 < stats["mean_live_lanes"] <= 8)

    def test_statistics_of_frames_add_up(self):
        frames = "".join(f'FrameBegin {n}\nDisplay "f{n}.tif" "file" "rgba"\n{self.scene(f"f{n}.tif", size)}FrameEnd\n'
                         for n, size in ((3, 20), (7, 50)))
        self.write("two.rib", frames)
        self.assertEqual(self.run_render("--stats-json", "s.json", "two.rib")[0], 0)
        statistics = json.loads(self.bytes_of("s.json"))
        self.assertEqual([f["frame"] for f in statistics["frames"]], [3, 7])
        self.assertEqual([f["options"]["resolution"] for f in statistics["frames"]], [[20, 20], [50, 50]])
        for frame in statistics["frames"]:
            self.check_sums(frame)
        self.check_sums(statistics["total"])
        for group in ("counters", "seconds"):
            for key, value in statistics["total"][group].items():
                sum_of_frames = sum(f[group][key] for f in statistics["frames"])
                if key == "read":  # what follows the last frame belongs to none
                    self.assertGreaterEqual(value, sum_of_frames)
                else:
                    self.assertAlmostEqual(value, sum_of_frames, places=9)

    def test_statistics_gather_messages(self):
        self.write("bad.rib", self.scene().replace("Translate", "Sphere 0 0 0 360 Sphere 0 0 0 360\nNosuch 1\nTranslate", 1))
        self.assertEqual(self.run_render("-silent", "--stats-json", "s.json", "bad.rib")[0], 1)
        messages = json.loads(self.bytes_of("s.json"))["messages"]
        unknown = [m for m in messages if "Nosuch" in m["text"]]
        self.assertEqual([m["count"] for m in unknown], [1])
        self.assertTrue(unknown[0]["places"][0].startswith("bad.rib:"))
        self.assertTrue(unknown[0]["code"].startswith("RIE_"))


if __name__ == "__main__":
    main()
