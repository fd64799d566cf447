#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""--trace-pixel and the statistics from outside: what they say is what the picture shows and what was counted.

usage: diagnosis_check.py path/to/render path/to/compiled/shaders
"""

import base64
import collections
import html.parser
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest

import pictures

RENDER, SHADERS = os.path.abspath(sys.argv.pop(1)), os.path.abspath(sys.argv.pop(1))

SCENE = """
Display "a.tif" "tiff" "rgba"
Quantize "rgba" 0 0 0 0
Exposure 1.5 2.2
Format 40 30 1
PixelSamples 2 2
DepthOfField 4 1 5
Projection "perspective" "fov" 40
WorldBegin
Attribute "light" "shadows" "on"
LightSource "ambientlight" 1 "intensity" .1
LightSource "pointlight" "key" "from" [3 4 -2] "intensity" 20
Atmosphere "fog" "distance" 50
AttributeBegin
Attribute "identifier" "name" "the ball"
Surface "plastic" "Ks" .3
Translate 0 0 5 Color .8 .2 .1 Opacity .5 .5 .5
Sphere 1 -1 1 360
AttributeEnd
ObjectBegin "floor" Polygon "P" [-4 0 -4  4 0 -4  4 0 8  -4 0 8] ObjectEnd
AttributeBegin Surface "matte" Translate 0 -1 6 ObjectInstance "floor" AttributeEnd
WorldEnd
"""


def as_float(text):
    """The 32-bit number a text stands for."""
    return struct.unpack("f", struct.pack("f", float(text)))[0]


class PageParser(html.parser.HTMLParser):
    """Checks that tags nest; gathers text, tag counts and what the page loads."""

    VOID = {"meta", "img", "br", "rect", "link", "input"}

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.problems, self.text, self.sources = [], [], [], []
        self.count = collections.Counter()

    def handle_starttag(self, tag, attrs):
        self.count[tag] += 1
        self.sources += [value for name, value in attrs if name in ("src", "href") and not value.startswith("#")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.count[tag] += 1

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.problems.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data):
        self.text.append(data)


class Diagnosis(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.environment = dict(os.environ, HOME=self.folder.name, SHADERS=SHADERS)
        with open(self.path("s.rib"), "w", encoding="utf-8") as file:
            file.write(SCENE)

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def render(self, *arguments):
        done = subprocess.run([RENDER, *arguments], cwd=self.folder.name, env=self.environment, timeout=100,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    def trace(self, x, y, *arguments):
        code, text, messages = self.render("--trace-pixel", str(x), str(y), *arguments, "s.rib")
        self.assertEqual(code, 0, messages)
        return text

    def test_traced_values_are_those_of_the_picture(self):
        self.assertEqual(self.render("s.rib")[0], 0)
        picture = pictures.read_picture(self.path("a.tif"))
        for x, y in ((20, 15), (0, 0), (39, 29), (14, 13), (25, 22)):
            text = self.trace(x, y)
            line = re.search(r"exposed, gain 1.5, gamma 2.2: color (\S+) (\S+) (\S+), .* alpha (\S+),", text)
            self.assertEqual([as_float(v) for v in line.groups()], list(picture.at(x, y)))

    def test_levels_and_printed_text(self):
        with open(self.path("talk.sl"), "w", encoding="utf-8") as file:
            file.write('surface talk(output varying float depth = 0;) { depth = length(I); printf("at %f\\n", s); printf("once\\n"); Ci = Cs; Oi = Os; }')
        with open(self.path("s.rib"), "w", encoding="utf-8") as file:
            file.write(SCENE.replace('Quantize "rgba" 0 0 0 0', 'Display "+d.tif" "tiff" "varying float depth"')
                       .replace('Surface "plastic" "Ks" .3', 'Surface "talk"'))
        self.assertEqual(self.render("s.rib")[0], 0)
        text = self.trace(20, 12)
        picture = pictures.read_picture(self.path("a.tif"))
        levels = [int(v) for v in re.findall(r'channel "[RGBA]" = \S+, level (\d+)', text)]
        self.assertEqual(levels, [round(v * picture.levels) for v in picture.at(20, 12)])
        self.assertRegex(text, r'channel "depth" = \S+')
        # Two surfaces of the ball lie behind each other; each sample meets both.
        self.assertEqual(len(re.findall(r'prints "at \S+\\012"', text)), 8)
        self.assertEqual(len(re.findall(r'prints "once\\012"', text)), 8)

    def test_no_picture_is_written(self):
        self.trace(20, 15)
        self.assertEqual([n for n in os.listdir(self.folder.name) if n.endswith(".tif")], [])

    def test_what_is_told(self):
        text = self.trace(20, 12)
        for expected in (r"^pixel 20 12, 40 by 30 pixels", r"^  sample 3: raster 20\.\S+ 12\.\S+, time 0, lens \S+ \S+$",
                         r"^    camera ray from .* along .*, t 1e-10 to inf$", r'hit 1: Sphere \(s\.rib:18\) "the ball"$',
                         r'surface shader "plastic" \(s\.rib:16\)', r"parameter float Ks = 0\.3$", r"variable color Cs = 0\.8 0\.2 0\.1$",
                         r'light "key", shader "pointlight" \(s\.rib:12\): L .*, Cl .*, Ol 1 1 1, (not )?in shadow$',
                         r"shadow ray from .*: (open|blocked)$", r'volume shader "fog"', r"what lies behind shows by 0\.4\S+ 0\.4\S+ 0\.4\S+$",
                         r"^  filtered: color ", r'^  display "a.tif", mode "rgba"$'):
            self.assertTrue(re.search(expected, text, re.MULTILINE), expected)
        floor = self.trace(20, 28)
        self.assertRegex(floor, r'hit 1: polygon \(s\.rib:20\), member of object "floor" \(s\.rib:21\)')

    def test_filter_sums_to_the_pixel(self):
        text = self.trace(14, 13)
        rows = re.findall(r"^    (\S+), sample \d+ of pixel -?\d+ -?\d+, (\S+) (\S+) (\S+), ", text, re.MULTILINE)
        weights = [float(r[0]) for r in rows]
        total = float(re.search(r"sum of weights (\S+)", text)[1])
        self.assertAlmostEqual(sum(weights), total, places=5)
        filtered = re.search(r"filtered: color (\S+) (\S+) (\S+),", text)
        for k in range(3):
            # Two dozen float additions: a few parts in a million.
            mean = sum(w * float(r[k + 1]) for w, r in zip(weights, rows)) / total
            self.assertAlmostEqual(mean, float(filtered[k + 1]), delta=1e-5 * abs(mean) + 1e-9)

    def test_report_is_one_well_formed_page(self):
        name = "</td><script>alert(1)</script>'&"
        with open(self.path("s.rib"), "w", encoding="utf-8") as file:
            file.write(SCENE.replace('"the ball"', f'"{name}"').replace('Surface "plastic"', f'Surface "{name}"'))
        self.assertEqual(self.render("--report", "r.html", "s.rib")[0], 1)  # there is no such shader
        with open(self.path("r.html"), encoding="utf-8") as file:
            page = file.read()
        parser = PageParser()
        parser.feed(page)
        parser.close()
        self.assertEqual((parser.open, parser.problems), ([], []))
        self.assertEqual(parser.count["script"], 1)
        self.assertEqual([u[:22] for u in parser.sources], ["data:image/png;base64,"])
        png = base64.b64decode(parser.sources[0].split(",", 1)[1])
        with open(self.path("preview.png"), "wb") as file:
            file.write(png)
        preview = pictures.read_picture(self.path("preview.png"))
        self.assertEqual((preview.width, preview.height), (40, 30))
        shown = " ".join(parser.text)
        for expected in ("matte", "pointlight", "fog", "RIE_NOSHADER", "s.rib:16:1", f'no shader "{name}"', "gaussian 2 2"):
            self.assertIn(expected, shown)

    def test_reports_that_cannot_be_written(self):
        for switch in ("--report", "--stats-json"):
            code, _, messages = self.render(switch, "no/such/place", "s.rib")
            self.assertEqual(code, 3)
            self.assertIn(switch, messages)

    def test_several_pixels_and_errors(self):
        code, text, _ = self.render("--trace-pixel", "3", "4", "--trace-pixel", "5", "6", "s.rib")
        self.assertEqual((code, re.findall(r"^pixel (\d+ \d+)", text, re.MULTILINE)), (0, ["3 4", "5 6"]))
        code, text, messages = self.render("--trace-pixel", "40", "4", "s.rib")
        self.assertEqual((code, text), (1, ""))
        self.assertIn("pixel 40 4 is not in the picture, which spans 0 to 39 and 0 to 29", messages)
        code, _, messages = self.render("--trace-pixel", "3", "4", "-crop", ".5", "1", "0", "1", "s.rib")
        self.assertEqual(code, 1)
        self.assertIn("which spans 20 to 39", messages)
        self.assertEqual(self.render("--trace-pixel", "3", "s.rib")[0], 2)

    def test_many_samples_are_capped(self):
        with open(self.path("s.rib"), "w", encoding="utf-8") as file:
            file.write(SCENE.replace("PixelSamples 2 2", "PixelSamples 12 12"))
        text = self.trace(20, 15)
        self.assertEqual(len(re.findall(r"^  sample \d+:", text, re.MULTILINE)), 64)
        self.assertIn("80 more samples are not told", text)


if __name__ == "__main__":
    unittest.main(verbosity=0)
