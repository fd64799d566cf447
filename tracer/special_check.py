# SPDX-License-Identifier: Apache-2.0
"""Test of --specialise and --profile-shaders from outside: the picture never changes, the reports say what happened.

usage: special_check.py RENDER
"""

import json
import unittest

from render_program import RenderCase

# Branches on parameters, varying parameters, outputs, lights with branches, a volume, messages; values a
# primitive supplies must not become constants.
PAINT = """
float layers(point p; uniform float n) {
    float sum = 0; uniform float i;
    for (i = 0; i < n; i += 1) sum += noise(p * (i + 1)) / (i + 1);
    return sum;
}
surface paint(string map = ""; float Kd = .7, Ks = 0, bumps = 0; varying float tint = .5;
              float weights[3] = {.2, .3, .5}; output varying float depth = 0;) {
    normal Nf = faceforward(normalize(N), I);
    color base = Cs;
    if (map != "") base *= color texture(map);
    if (bumps > 0) Nf = normalize(Nf + bumps * (vector noise(P * 4) - .5));
    if (weights[1] > .2) base = mix(base, color(tint, .2, .9), layers(P, 3 * weights[2] + 2));
    Oi = Os;
    Ci = Kd * base * diffuse(Nf);
    if (Ks * Kd > 0) Ci += Ks * specular(Nf, -normalize(I), .1);
    depth = length(I);
}
"""
LAMP = """
light lamp(float intensity = 1; string shape = "plain"; float falloff = 0; point from = point "shader" (0, 0, 0);) {
    illuminate(from) {
        Cl = intensity;
        if (shape == "spots") Cl *= step(.5, noise(Ps * 5));
        if (falloff != 0) Cl /= pow(length(L), falloff);
        Cl *= 1 - .2 * abs(zcomp(normalize(Ns)));
    }
}
"""
HAZE = """
volume haze(float density = 0; color background = .5;) {
    if (density > 0) { float d = 1 - exp(-length(I) * density); Ci = mix(Ci, background, d); Oi = mix(Oi, color 1, d); }
}
"""
SCENE = """
Format 96 72 1
PixelSamples 3 3
Display "{name}.tif" "tiff" "rgba"
Display "+{name}_depth.tif" "tiff" "depth"
Declare "tint" "varying float" Declare "bumps" "uniform float"
Projection "perspective" "fov" 40
WorldBegin
LightSource "lamp" 1 "from" [3 4 -2] "intensity" 12 "falloff" 2
LightSource "lamp" 2 "from" [-4 2 -3] "shape" ["spots"]
Atmosphere "haze" "density" .05
Translate 0 0 6
Surface "paint" "Ks" .4
Sphere 1 -1 1 360 "tint" [0 .3 .6 1]
AttributeBegin Translate 1.5 .4 1 Surface "paint" "bumps" .5 Sphere 1 -1 1 360 AttributeEnd
AttributeBegin Translate -1.5 .4 1 Surface "paint" "Kd" .9 "weights" [0 0 1] Sphere 1 -1 1 360
  Translate 0 -1 0 Sphere .4 -.4 .4 360 "bumps" .3 AttributeEnd
AttributeBegin Surface "matte" Translate 0 -1 0 Rotate 90 1 0 0 Disk 0 5 360 AttributeEnd
WorldEnd
"""


class Specialisation(RenderCase):
    def setUp(self):
        super().setUp()
        for name, text in (("paint", PAINT), ("lamp", LAMP), ("haze", HAZE)):
            self.write(name + ".sl", text)

    def picture(self, name, *arguments):
        self.write(name + ".rib", SCENE.format(name=name))
        code, output, messages = self.run_render(*arguments, name + ".rib")
        self.assertEqual(code, 0, messages)
        with open(self.path(name + ".tif"), "rb") as a, open(self.path(name + "_depth.tif"), "rb") as b:
            return a.read().replace(name.encode(), b"x"), b.read().replace(name.encode(), b"x"), output, messages

    def counters(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return json.load(file)["total"]["counters"]

    def test_the_picture_is_the_same(self):
        wanted = self.picture("off", "--specialise=off", "--stats-json", "off.json", "-t", "1")
        self.assertEqual(self.counters("off.json")["points_special"], 0)
        always = self.picture("alw", "--specialise=always", "--stats-json", "always.json", "-t", "2", "-v")
        self.assertEqual(always[:2], wanted[:2])
        self.assertIn('shader "paint" now runs specialised', always[3])
        counters = self.counters("always.json")
        self.assertGreaterEqual(counters["special_used"], 6)
        self.assertEqual(counters["points_special"], counters["points_surface"] + counters["points_volume"])
        # From the cache: nothing is compiled again.
        again = self.picture("agn", "--specialise=always", "--stats-json", "again.json", "-t", "1")
        self.assertEqual(again[:2], wanted[:2])
        self.assertEqual(self.counters("again.json")["special_compiles"], 0)
        self.assertEqual(self.picture("aut", "--specialise=auto", "-t", "2")[:2], wanted[:2])

    def test_without_a_compiler_nothing_is_said(self):
        self.environment["PATH"] = self.path("nowhere")
        self.write("plain.rib", 'Display "p.tif" "tiff" "rgb"\nFormat 8 8 1\nWorldBegin\nTranslate 0 0 3\n'
                                'Sphere 1 -1 1 360\nWorldEnd\n')
        code, _, messages = self.run_render("--specialise=always", "plain.rib")
        self.assertEqual((code, messages), (0, ""))

    def test_wrong_switch(self):
        code, _, messages = self.run_render("--specialise=sometimes", "x.rib")
        self.assertEqual(code, 2)
        self.assertIn("auto|off|always", messages)

    def test_profile(self):
        wanted = self.picture("pla", "--specialise=off")
        listed = self.picture("lis", "--profile-shaders", "-")
        self.assertEqual(listed[:2], wanted[:2])
        self.assertIn("surface paint: ", listed[2])
        line = next(line for line in listed[2].splitlines() if "bumps > 0" in line)
        self.assertRegex(line, r"^ +[\d.]+ % +[\d.]+ +\d+ +[\d.]+ +\d+  ")
        self.picture("jsn", "--profile-shaders", "lines.json", "-t", "2")
        with open(self.path("lines.json"), encoding="utf-8") as file:
            profile = json.load(file)
        self.assertEqual(profile["schema"], "perigee-shader-profile")
        shaders = {shader["name"]: shader for shader in profile["shaders"]}
        self.assertTrue({"paint", "lamp", "haze", "matte"} <= set(shaders))
        for shader in shaders.values():
            self.assertAlmostEqual(sum(line["share"] for line in shader["lines"]), 1, places=6)
        loop = next(line for line in shaders["paint"]["lines"] if "sum += noise" in line["text"])
        self.assertGreater(loop["packets"], 2 * 0.2 * shaders["paint"]["executions"])
        self.assertTrue(0 < loop["mean_live_lanes"] <= 8)


if __name__ == "__main__":
    unittest.main()
