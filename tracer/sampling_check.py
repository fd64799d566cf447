#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Adaptive sampling and shading reuse, from outside: no thread, bucket size or crop window changes a byte of the picture;
both spare what they promise; outputs, mattes and --trace-pixel go on working.

usage: sampling_check.py RENDER
"""

import json
import os
import sys
import unittest

from render_program import RenderCase

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "testsuite"))
from pictures import read_picture  # noqa: E402

SCENE = """Display "{name}" "tiff" "rgba"
Quantize "rgba" 0 0 0 0
Format 70 50 1
PixelSamples 4 4
{options}
Projection "perspective" "fov" [40]
WorldBegin
  Translate 0 0 5
  ShadingRate {rate}
  LightSource "pointlight" 1 "from" [3 4 -5] "intensity" 60
  Color [1 .5 .2] Surface "plastic" Sphere 1 -1 1 360
  Color [.2 .5 1] Torus 1.3 .1 0 360 360
  AttributeBegin Translate .5 .5 -1 Opacity [.5 .5 .5] Sphere .5 -.5 .5 360 AttributeEnd
  AttributeBegin Matte 1 Translate -.8 -.6 -1 Sphere .2 -.2 .2 360 AttributeEnd
  AttributeBegin Color [.5 .8 .5] Polygon "P" [-3 -2 2  3 -2 2  3 1 2  -3 1.4 2] AttributeEnd
WorldEnd
"""
REUSE = 'Option "render" "integer reuse_shading" 1'
ADAPTIVE = 'PixelVariance .002 Option "render" "integer maxsamples" 32'
LENS = " DepthOfField 4 .8 5"
BUCKETS = ((8, 8), (20, 12), (32, 32), (70, 50), (5, 40))
SHADERS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "shaders")


class SamplingCase(RenderCase):
    def setUp(self):
        super().setUp()
        self.environment["SHADERS"] = SHADERS
        self.environment["PERIGEE_CACHE"] = os.environ.get("PERIGEE_CACHE", self.path("cache"))

    def picture(self, name, options, *switches, rate=1):
        self.write("s.rib", SCENE.format(name=name, options=options, rate=rate))
        self.good(*switches, "s.rib")
        with open(self.path(name), "rb") as file:
            return file.read()

    def counters(self, options, rate=1):
        self.picture("counted.tif", options, "--stats-json", "stats.json", rate=rate)
        with open(self.path("stats.json"), encoding="utf-8") as file:
            return json.load(file)["total"]["counters"]


class Determinism(SamplingCase):
    def test_threads_and_buckets_change_nothing(self):
        for options in (REUSE, ADAPTIVE, REUSE + " " + ADAPTIVE, REUSE + LENS, ADAPTIVE + LENS):
            for rate in (1, 9, .2) if options == REUSE else (1,):
                with self.subTest(options=options, rate=rate):
                    expected = self.picture("a.tif", options, "-t", "1", rate=rate)
                    self.assertEqual(expected, self.picture("b.tif", options, "-t", "3", rate=rate))
                    for x, y in BUCKETS:
                        size = f' Option "limits" "bucketsize" [{x} {y}]'
                        self.assertEqual(expected, self.picture("b.tif", options + size, rate=rate), f"buckets of {x} {y}")

    def test_tiles_of_crop_windows_are_the_picture(self):
        for options in (REUSE, ADAPTIVE, REUSE + " " + ADAPTIVE):
            with self.subTest(options=options):
                whole = self.picture("whole.tif", options)
                names = []
                for i, crop in enumerate(("0 .37 0 1", ".37 1 0 .61", ".37 1 .61 1")):
                    names.append(f"tile{i}.tif")
                    self.good("-crop", *crop.split(), "-o", names[-1], "s.rib")
                self.good("--merge", "-o", "merged.tif", *names)
                with open(self.path("merged.tif"), "rb") as file:
                    self.assertEqual(whole, file.read())


class Savings(SamplingCase):
    def test_adaptive_takes_samples_where_they_count(self):
        taken = self.counters(ADAPTIVE)["samples"] / (72 * 52)
        self.assertGreater(taken, 4.1)
        self.assertLess(taken, 16)

    def test_reuse_shades_less_and_shows_the_same(self):
        every = self.counters("")["points_surface"]
        some = self.counters(REUSE)
        self.assertLess(some["points_surface"], every / 3)
        self.assertGreater(some["reuse_spared"], every / 2)
        self.assertLess(self.counters(REUSE, rate=16)["points_surface"], some["points_surface"])
        plain, reused = (read_picture_of(self, options) for options in ("", REUSE))
        # Few pixels here are plain surface; docs/sampling.md has the figures of real pictures.
        differences = sorted(abs(a - b) for a, b in zip(plain, reused))
        self.assertLess(differences[int(.99 * len(differences))], 2 / 255)

    def test_an_attribute_switches_it_off(self):
        off = 'Attribute "render" "integer use_shadingrate" 0'
        self.assertEqual(self.picture("a.tif", off), self.picture("b.tif", REUSE + " " + off))


def read_picture_of(case, options):
    case.picture("read.tif", options)
    return [value for row in read_picture(case.path("read.tif")).rows for value in row]


class Diagnosis(SamplingCase):
    def test_trace_pixel_says_which_sample_was_shaded(self):
        for options in (REUSE, REUSE + " " + ADAPTIVE):
            self.write("s.rib", SCENE.format(name="a.tif", options=options, rate=1))
            code, output, messages = self.run_render("--trace-pixel", "35", "25", "s.rib")
            self.assertEqual(code, 0, messages)
            self.assertIn("shading reused from the sample at raster 35.", output)
            told = [line for line in output.splitlines() if line.strip().startswith("result:")]
            sample = [line for line in output.splitlines() if line.strip().startswith("sample ")]
            self.assertEqual(len(told), len(sample))

    def test_var_is_a_switch(self):
        self.write("s.rib", SCENE.format(name="a.tif", options="", rate=1))
        self.good("-var", ".002", "4", "16", "s.rib")
        code, _, messages = self.run_render("-var", "0", "4", "16", "s.rib")
        self.assertEqual(code, 2)
        self.assertIn("-var", messages)


if __name__ == "__main__":
    unittest.main()
