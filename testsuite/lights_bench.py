#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Benchmarks of lights, for docs/lights.md: what shadow modes cost, error of area lights against samples and time, many lights
against one. Renders small scenes with build/tracer/render and prints JSON lines (docs/benchmarks.md).

    python3 testsuite/lights_bench.py [--build build] [modes | area | many]..."""
import argparse
import json
import math
import pathlib
import random
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import pictures  # noqa: E402

ROOT = pathlib.Path(__file__).parent.parent
HEAD = """Display "{out}" "tiff" "rgb"
Quantize "rgba" 0 0 0 0
Format {size} {size} 1
PixelSamples {samples} {samples}
PixelFilter "box" 1 1
"""


class Bench:
    def __init__(self, build):
        self.render_program = pathlib.Path(build).resolve() / "tracer" / "render"
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lights_bench_"))
        self.shaders = f"{ROOT}/testsuite/shaders:{pathlib.Path(build).resolve()}/shaders:{ROOT}/shaders"

    def render(self, text, size=128, samples=2, repeat=3):
        """The picture and the least processor time the run took, in seconds: other work on the machine does not count."""
        out, rib = self.folder / "out.tif", self.folder / "scene.rib"
        rib.write_text(HEAD.format(out=out, size=size, samples=samples) + text)
        best = math.inf
        for _ in range(repeat):
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            run = subprocess.run([self.render_program, "-t", "1", "-silent", "-shaders", self.shaders, rib],
                                 capture_output=True, text=True)
            if run.returncode != 0:
                sys.exit(run.stderr)
            best = min(best, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)
        return pictures.read_picture(out), best


def rms(a, b):
    total = count = 0
    for ra, rb in zip(a.rows, b.rows):
        for p, q in zip(ra, rb):
            total += (p - q) ** 2
            count += 1
    return math.sqrt(total / count)


def mean(a):
    return math.fsum(p for row in a.rows for p in row) / sum(len(row) for row in a.rows)


FLOOR = """WorldBegin
Attribute "light" "shadows" "on"
{lights}
Surface "matte"
Polygon "P" [-2 -2 5  -2 2 5  2 2 5  2 -2 5]
"""


def modes(bench):
    """Shadow rays through 64 spheres of one mode each; none is the base."""
    spheres = random.Random(3)
    places = [(spheres.uniform(-2, 2), spheres.uniform(-2, 2), spheres.uniform(2, 4)) for _ in range(64)]
    for mode in ("none", "opaque", "Os", "shader"):
        text = FLOOR.format(lights='LightSource "distantlight" 1 "from" [0 0 0] "to" [.2 .1 1]')
        text += f'Attribute "render" "casts_shadows" "{mode}"\nAttribute "render" "visibility" 4\nSurface "glass"\n'
        text += "Opacity [.2 .3 .4]\n" if mode == "Os" else ""
        for x, y, z in places:
            text += f"TransformBegin Translate {x:.3f} {y:.3f} {z:.3f} Sphere .3 -.3 .3 360 TransformEnd\n"
        _, seconds = bench.render(text + "WorldEnd\n", size=256, samples=2)
        print(json.dumps({"benchmark": "shadow modes", "mode": mode, "seconds": round(seconds, 4)}), flush=True)


AREA = {
    "square": 'AreaLightSource "lambertlight" 1 "float area" 1 Polygon "P" [-.5 -.5 3  .5 -.5 3  .5 .5 3  -.5 .5 3]',
    "disk": 'AreaLightSource "lambertlight" 1 "float area" .785398 Translate 0 0 3 Disk 0 .5 360',
    "sphere": 'AreaLightSource "lambertlight" 1 "float area" 3.14159265 Translate 0 0 3 Sphere .5 -.5 .5 360',
    "cylinder": 'AreaLightSource "lambertlight" 1 "float area" 3.14159265 Translate 0 0 3 Rotate 90 1 0 0 Cylinder .5 -.5 .5 360',
}


def area_scene(form, nsamples):
    lights = f'AttributeBegin Attribute "light" "shadows" "off" "nsamples" {nsamples} Attribute "render" "visibility" 0\n{AREA[form]}\nAttributeEnd\nIlluminate 1 1'
    return FLOOR.format(lights=lights) + "WorldEnd\n"


def area(bench):
    """RMS error of pixels of one sample each, against many."""
    for form in AREA:
        reference, _ = bench.render(area_scene(form, 1024), size=32, samples=1, repeat=1)
        level = mean(reference)
        for nsamples in (1, 4, 16, 64, 256):
            picture, seconds = bench.render(area_scene(form, nsamples), size=32, samples=1)
            print(json.dumps({"benchmark": "area light", "form": form, "nsamples": nsamples,
                              "relative_rms": rms(picture, reference) / level, "seconds": round(seconds, 4)}), flush=True)


def many_scene(count, shadows, blocker=True):
    rng = random.Random(count)
    lights = ""
    for i in range(count):
        x, y, z = rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(1, 4)
        lights += f'LightSource "pointlight" {i + 1} "from" [{x:.3f} {y:.3f} {z:.3f}] "intensity" {8 / count * 10 ** rng.uniform(-1, .5):.4g}\n'
    text = FLOOR.format(lights=f'Attribute "light" "shadows" "{shadows}"\n' + lights)
    if blocker:
        for i in range(8):
            x, y, z = rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5), rng.uniform(4, 4.7)
            text += f"TransformBegin Translate {x:.3f} {y:.3f} {z:.3f} Sphere .25 -.25 .25 360 TransformEnd\n"
    return text + "WorldEnd\n"


def many(bench):
    """1,000 lights against one: time at the default choice, error against all lights."""
    _, one = bench.render(many_scene(1, "on"), size=64, samples=4)
    print(json.dumps({"benchmark": "many lights", "lights": 1, "seconds": round(one, 4)}), flush=True)
    text = many_scene(1000, "on")
    reference, everything = bench.render('Option "lights" "samples" 0\n' + text, size=64, samples=4, repeat=1)
    level = mean(reference)
    print(json.dumps({"benchmark": "many lights", "lights": 1000, "chosen": "all", "seconds": round(everything, 4),
                      "ratio": round(everything / one, 1)}), flush=True)
    for chosen in (8, 16, 32, 64):
        picture, seconds = bench.render(f'Option "lights" "samples" {chosen}\n' + text, size=64, samples=4)
        print(json.dumps({"benchmark": "many lights", "lights": 1000, "chosen": chosen, "seconds": round(seconds, 4),
                          "ratio": round(seconds / one, 1), "relative_rms": rms(picture, reference) / level}), flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", default="build")
    parser.add_argument("parts", nargs="*", default=["modes", "area", "many"])
    arguments = parser.parse_args()
    bench = Bench(arguments.build)
    for part in arguments.parts:
        {"modes": modes, "area": area, "many": many}[part](bench)


if __name__ == "__main__":
    main()
