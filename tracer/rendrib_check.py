#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Programs that call rendrib: their command lines, the preferences file, environment, progress lines.

usage: rendrib_check.py path/to/render
"""

import os
import re

import render_program
from render_program import RenderCase, main


class Rendrib(RenderCase):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path(".cache-bin"))
        self.program = self.path(".cache-bin/rendrib")
        os.symlink(render_program.RENDER, self.program)
        self.write("f.rib", self.scene().replace("Format 40 40 1", ""))

    def picture_size(self, name="a.tif"):
        data = self.bytes_of(name)
        self.assertEqual(data[:4], b"II*\0")
        at = int.from_bytes(data[4:8], "little")
        count = int.from_bytes(data[at:at + 2], "little")
        fields = {}
        for i in range(count):
            entry = data[at + 2 + 12 * i:at + 14 + 12 * i]
            size = 2 if entry[2] == 3 else 4
            fields[int.from_bytes(entry[:2], "little")] = int.from_bytes(entry[8:8 + size], "little")
        return fields[256], fields[257]

    def test_calls_of_known_programs(self):
        self.good("-d", "4", "-Progress", "-res", "32", "24", "f.rib")  # Ayam
        self.good("-d", "8", "-res", "32", "24", "f.rib")  # VMD
        self.good("-silent", "-res", "32", "24", "-d", "16", "f.rib")  # Wings
        self.assertEqual(self.picture_size(), (32, 24))
        self.write("g.rib", self.scene())
        self.good("g.rib")  # K-3D
        self.assertEqual(self.picture_size(), (40, 40))

    def test_every_switch_is_accepted(self):
        for switches in ("-samples 1 1", "-var .01 1 4", "-frames 1 2", "-frames 3", "-silent", "-safe", "-radio 10",
                         "-rsamples 4", "-stats", "-v", "-crop 0 .5 .25 1", "-pos 10 20", "-Progress", "-t 1", "-d",
                         "-shaders .", "-o b.tif"):
            self.good("-res", "16", "12", *switches.split(), "f.rib")

    def test_silent_prints_errors_only(self):
        self.write("w.rib", 'Option "nonsense" "uniform float x" [1]\n' + self.scene(size=8))
        self.assertEqual(self.good("-silent", "-var", ".01", "1", "4", "w.rib"), "")
        self.write("e.rib", self.scene(size=8) + "Sphere 1\n")
        code, _, messages = self.run_render("-silent", "e.rib")
        self.assertEqual(code, 1)
        self.assertIn("error", messages)

    def test_the_rib_wins_over_res_and_samples(self):
        self.write("g.rib", self.scene(size=20))
        self.good("-res", "64", "48", "-samples", "7", "7", "g.rib")
        self.assertEqual(self.picture_size(), (20, 20))
        kept = self.bytes_of("a.tif")
        self.good("g.rib")
        self.assertEqual(self.bytes_of("a.tif"), kept)

    def test_progress_lines(self):
        self.write("g.rib", self.scene(size=64))
        lines = self.good("-Progress", "g.rib").splitlines()
        self.assertTrue(lines)
        percents = []
        for line in lines:
            match = re.fullmatch(r"R90000 +(\d{1,3})%", line)
            self.assertTrue(match, line)
            percents.append(int(match.group(1)))
        self.assertEqual(percents, sorted(percents))
        self.assertEqual(percents[-1], 100)

    def test_progress_arrives_while_it_renders(self):
        self.write("g.rib", self.scene(size=600, samples=4))
        process = self.start("-t", "1", "-Progress", "g.rib")
        self.assertIn("R90000", process.stderr.readline())  # through a pipe: it was flushed
        self.assertNotIn("a.tif", self.files())
        process.communicate(timeout=100)
        self.assertEqual(process.returncode, 0)

    def test_options_may_come_several_times(self):
        self.good("-option", "Format 33 20 1 PixelSamples 1 1", "-option", 'Clipping .1 100 Option "user" "float x" [1]',
                  "f.rib")
        self.assertEqual(self.picture_size(), (33, 20))
        code, _, messages = self.run_render("-option", "Nonsense 1 2", "-res", "8", "8", "f.rib")
        self.assertEqual(code, 1)
        self.assertIn("-option:1", messages)

    def test_preferences(self):
        self.write(".rendribrc", "Format 30 20 1\n")
        os.mkdir(self.path("site"))
        self.write("site/.rendribrc", "Format 50 10 1\n")
        self.environment["BMRTHOME"] = self.path("site")
        self.good("f.rib")
        self.assertEqual(self.picture_size(), (30, 20))
        self.good("-option", "Format 31 20 1", "f.rib")
        self.assertEqual(self.picture_size(), (31, 20), "-option comes after the file")
        os.remove(self.path(".rendribrc"))
        self.good("f.rib")
        self.assertEqual(self.picture_size(), (50, 10), "the site's when the user has none")
        os.rename(self.path("site/.rendribrc"), self.path(".rendribrc"))
        self.environment["HOME"] = self.path("site")
        self.good("f.rib")
        self.assertEqual(self.picture_size(), (640, 480), "the current directory is not searched")

    def test_preferences_with_errors(self):
        self.write(".rendribrc", "Format 1\nNonsense\nFormat 30 20 1\n")
        code, _, messages = self.run_render("f.rib")
        self.assertEqual(code, 1)
        self.assertIn(".rendribrc:2", messages)
        self.assertEqual(self.picture_size(), (30, 20))

    def test_environment(self):
        for folder in ("arch", "old", "old/shaders", "sh"):
            os.mkdir(self.path(folder))
        self.write("arch/ball.rib", "Sphere 1 -1 1 360\n")
        self.write("sh/red.sl", "surface red() { Oi = 1; Ci = color(1, 0, 0); }")
        self.write("old/shaders/blue.sl", "surface blue() { Oi = 1; Ci = color(0, 0, 1); }")
        self.write("s.rib", 'Format 8 8 1 Display "a.tif" "file" "rgb" WorldBegin Translate 0 0 5\n'
                   'Surface "red" Sphere .2 -.2 .2 360 ReadArchive "ball.rib" Surface "blue" Sphere .5 -.5 .5 360 WorldEnd\n')
        code, _, messages = self.run_render("s.rib")
        self.assertEqual(code, 1)
        for name in ("red", "blue", "ball.rib"):
            self.assertIn(name, messages)
        self.environment |= {"SHADERS": "sh", "ARCHIVES": "arch", "BMRTHOME": "old", "PERIGEE_CACHE": self.path("cache")}
        self.good("--strict", "s.rib")
        self.assertTrue(os.listdir(self.path("cache")))

    def test_usage_names_the_program(self):
        code, _, messages = self.run_render("-nonsense")
        self.assertEqual(code, 2)
        self.assertTrue(messages.startswith("rendrib: error: unknown switch -nonsense"), messages)
        self.assertIn("usage: rendrib", messages)
        self.assertIn("usage: rendrib", self.run_render("--help")[1])


if __name__ == "__main__":
    main()
