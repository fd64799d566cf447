#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error against time of what is sampled: area lights, reflection in a cone, volumes, indirect light, adaptive pixels.

In: a build folder. Each series is a scene with one number of samples that doubles; its reference is the same scene with at least 30
times as many. Out: one SVG and a Markdown table; error is the root of the mean square over pixels, time that of the phase "render" on
the threads given. Needs python3-matplotlib for the SVG.

    testsuite/plot_errors.py build docs/pictures/errors.svg [--series area,glossy,volume,indirect,adaptive] [--threads 2]
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
sys.path.insert(0, HERE)
from pictures import read_picture  # noqa: E402

SIZE = 48

HEAD = """Display "out.tif" "tiff" "rgb"
Quantize "rgba" 0 0 0 0
Format {size} {size} 1
PixelSamples {pixel} {pixel}
PixelFilter "box" 1 1
Projection "perspective" "fov" 40
{options}
WorldBegin
Attribute "light" "shadows" "on"
"""

FLOOR = """Surface "matte"
Color .8 .8 .8
Polygon "P" [-4 -1 2  -4 -1 9  4 -1 9  4 -1 2]
Translate 0 -.2 5
Sphere .8 -.8 .8 360
WorldEnd
"""

AREA = """Attribute "light" "nsamples" [{n}]
AttributeBegin
Surface "constant"
AreaLightSource "evenarea" 1 "intensity" [9]
Polygon "P" [-1 2 4  -1 2 6  1 2 6  1 2 4]
AttributeEnd
Illuminate 1 1
""" + FLOOR

GLOSSY = """LightSource "pointlight" 1 "from" [2 4 1] "intensity" [20]
Surface "matte"
Color .8 .3 .2
Polygon "P" [-4 -1 8  -4 3 8  4 3 8  4 -1 8]
Surface "blurred" "float samples" [{n}]
Color .8 .8 .8
Polygon "P" [-4 -1 2  -4 -1 9  4 -1 9  4 -1 2]
Surface "matte"
Color .2 .5 .8
Translate 0 -.2 5
Sphere .8 -.8 .8 360
WorldEnd
"""

VOLUME = """LightSource "spotlight" 1 "from" [-3 4 4] "to" [0 -.5 5] "intensity" [60] "coneangle" [.4] "conedeltaangle" [.05]
Atmosphere "smoke" "float density" [.12] "float steps" [{n}]
""" + FLOOR

INDIRECT = """Attribute "indirect" "maxerror" [0] "nsamples" [{n}]
LightSource "indirect" 1
Surface "constant"
Color 4 3.5 3
Polygon "P" [-1 2 4  -1 2 6  1 2 6  1 2 4]
""" + FLOOR

ADAPTIVE = """LightSource "pointlight" 1 "from" [2 4 1] "intensity" [20]
Surface "checks" "float Kr" [0] "float columns" [40] "float rows" [40]
Polygon "P" [-4 -1 2  -4 -1 9  4 -1 9  4 -1 2] "st" [0 0  0 1  1 1  1 0]
Surface "matte"
Translate 0 -.2 5
Sphere .8 -.8 .8 360
WorldEnd
"""

BLURRED = """surface blurred(float samples = 4, cone = .12;)
{
    vector R = reflect(normalize(I), faceforward(normalize(N), I));
    Oi = 1;
    Ci = Cs * color trace(P, R, "samples", samples, "samplecone", cone);
}
"""

# name: (scene, numbers, number of the reference, what the number is, [expected slope of log error by log time])
SERIES = {
    "area": (AREA, (1, 2, 4, 8, 16, 32, 64), 2048, "nsamples of an area light"),
    "glossy": (GLOSSY, (1, 2, 4, 8, 16, 32, 64), 2048, "rays in a cone of reflection"),
    "volume": (VOLUME, (2, 4, 8, 16, 32, 64, 128), 4096, "steps through smoke"),
    "indirect": (INDIRECT, (1, 2, 4, 8, 16, 32, 64), 1024, "rays over a hemisphere"),
    "adaptive": (ADAPTIVE, (1, 2, 3, 4, 6, 8), 24, "PixelSamples, square root"),
}


def write(folder, text):
    path = os.path.join(folder, "scene.rib")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def render(build, folder, text, threads):
    write(folder, text)
    env = dict(os.environ, SHADERS=os.pathsep.join([folder, os.path.join(ROOT, "examples", "paper"), os.path.join(build, "shaders")]))
    subprocess.run([os.path.join(os.path.abspath(build), "tracer", "render"), "-t", str(threads), "--progress=none",
                    "--stats-json", "stats.json", "scene.rib"], cwd=folder, env=env, check=True)
    with open(os.path.join(folder, "stats.json"), encoding="utf-8") as file:
        stats = json.load(file)
    seconds = stats["total"]["seconds"]["render"]
    return read_picture(os.path.join(folder, "out.tif")), seconds


def scene(series, n, options=""):
    text = SERIES[series][0]
    pixel = n if series == "adaptive" else 2
    return HEAD.format(size=SIZE, pixel=pixel, options=options) + text.replace("{n}", str(n))


def rms(a, b):
    count = a.width * a.height * 3
    return math.sqrt(sum((x - y) ** 2 for ra, rb in zip(a.rows, b.rows) for x, y in zip(ra, rb)) / count)


def slope(points):
    """Of log error by log number, least squares."""
    xs, ys = [math.log(p[0]) for p in points], [math.log(max(p[2], 1e-12)) for p in points]
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def measure(build, folder, series, threads):
    _, numbers, many, _ = SERIES[series]
    reference, _ = render(build, folder, scene(series, many), threads)
    points = []
    for n in numbers:
        picture, seconds = render(build, folder, scene(series, n), threads)
        points.append((n, seconds, rms(picture, reference)))
    return points


def adaptive_points(build, folder, threads):
    """The same scene with PixelVariance: what adaptive sampling reaches in the same time."""
    reference, _ = render(build, folder, scene("adaptive", 24), threads)
    points = []
    for variance in (.03, .01, .003, .001):
        options = f"PixelVariance {variance}\nOption \"render\" \"minsamples\" [4] \"maxsamples\" [64]"
        picture, seconds = render(build, folder, scene("adaptive", 8, options), threads)
        points.append((variance, seconds, rms(picture, reference)))
    return points


def plot(curves, path):
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "perigee"
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(7, 4.5))
    for name, points in curves.items():
        axes.loglog([p[1] for p in points], [p[2] for p in points], "o-", label=name, markersize=4)
    axes.set_xlabel("seconds")
    axes.set_ylabel("error (root mean square of radiance)")
    axes.grid(True, which="both", alpha=.25)
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("svg")
    parser.add_argument("--series", default=",".join(SERIES))
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    curves = {}
    print("| series | number | seconds | error | slope |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="perigee_errors_") as folder:
        with open(os.path.join(folder, "blurred.sl"), "w", encoding="utf-8") as file:
            file.write(BLURRED)
        for series in options.series.split(","):
            points = measure(options.build, folder, series, options.threads)
            curves[SERIES[series][3]] = points
            for n, seconds, error in points:
                print(f"| {SERIES[series][3]} | {n} | {seconds:.3f} | {error:.2e} | |")
            print(f"| | | | | {slope(points):+.2f} |", flush=True)
            if series == "adaptive":
                points = adaptive_points(options.build, folder, options.threads)
                curves["PixelVariance"] = points
                for n, seconds, error in points:
                    print(f"| PixelVariance | {n} | {seconds:.3f} | {error:.2e} | |", flush=True)
    plot(curves, options.svg)
    return 0


if __name__ == "__main__":
    sys.exit(main())
