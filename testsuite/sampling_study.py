#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures docs/sampling.md: error, time, camera rays and shading points of the scenes of sampling_scenes.py.

    testsuite/sampling_study.py BUILD                    both tables
    testsuite/sampling_study.py BUILD --plot FILE.svg    error against processor time too (needs python3-matplotlib)
    testsuite/sampling_study.py BUILD --scenes room,edges --keep FOLDER
    testsuite/sampling_study.py BUILD --bench            JSON lines (docs/benchmarks.md)

BUILD is a build folder. Errors are those of clamped pictures, in 1/255: against a reference of 32x32 samples (root of
the mean square), and, for reuse, against the same samples shaded one by one (99.9th percentile of all values).
Times are processor seconds of whole runs with one thread, the least of three.
"""
import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

from pictures import read_picture
from sampling_scenes import SCENES, rib

HERE = os.path.dirname(os.path.abspath(__file__))
REUSE = 'Option "render" "integer reuse_shading" 1\n'
RUNS = 3


def samples(n):
    return f"PixelSamples {n} {n}\n"


def adaptive(variance, least, most):
    return f'PixelVariance {variance:g}\nOption "render" "integer minsamples" {least} "integer maxsamples" {most}\n'


METHODS = {
    "plain": [samples(n) for n in (2, 3, 4, 6, 8)],
    "reuse": [samples(n) + REUSE for n in (2, 3, 4, 6, 8)],
    "adaptive": [adaptive(v, 4, 64) for v in (.02, .008, .003, .001, .0003)],
    "adaptive, reuse": [adaptive(v, 4, 64) + REUSE for v in (.02, .008, .003, .001, .0003)],
}


class Renderer:
    def __init__(self, build, folder):
        self.render = os.path.join(build, "tracer", "render")
        self.folder = folder
        self.environment = dict(os.environ, SHADERS=os.pathsep.join(
            [os.path.join(build, "shaders"), os.path.join(HERE, "sampling"), os.path.join(HERE, "..", "shaders")]))

    def run(self, scene, options, name, runs=1, threads=1):
        file = f"{name}.tif"
        path = os.path.join(self.folder, name + ".rib")
        with open(path, "w", encoding="ascii") as out:
            out.write(rib(scene, options, file))
        best = math.inf
        for _ in range(runs):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run([self.render, "-t", str(threads), "--progress=none", "--no-checkpoint", "--stats-json",
                            "stats.json", path], cwd=self.folder, env=self.environment, check=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        with open(os.path.join(self.folder, "stats.json"), encoding="utf-8") as stats:
            counters = json.load(stats)["total"]["counters"]
        return Picture(os.path.join(self.folder, file)), best, counters


class Picture:
    def __init__(self, path):
        self.values = [min(max(row[i], 0.0), 1.0) for row in read_picture(path).rows for i in range(len(row))
                       if i % 4 != 3]  # colours; alpha would dilute the percentiles

    def differences(self, other):
        return [abs(a - b) * 255 for a, b in zip(self.values, other.values)]

    def rms(self, other):
        d = self.differences(other)
        return math.sqrt(sum(x * x for x in d) / len(d))

    def percentile(self, other, share):
        d = sorted(self.differences(other))
        return d[min(len(d) - 1, int(share * len(d)))]


def reuse_table(renderer, scenes):
    print("| scene | points shaded, every sample | with reuse | fewer | 99.9 % of differences, of 255 | time |")
    print("|---|---|---|---|---|---|")
    for scene in scenes:
        every, slow, all_points = renderer.run(scene, samples(4), f"{scene}_every", RUNS)
        reused, fast, points = renderer.run(scene, samples(4) + REUSE, f"{scene}_reused", RUNS)
        n, m = all_points["points_surface"], points["points_surface"]
        print(f"| {scene} | {n} | {m} | {n / m:.1f}x | {every.percentile(reused, .999):.2f} | {slow:.2f} -> {fast:.2f} s |",
              flush=True)


def methods_table(renderer, scenes):
    print("| scene | method | camera rays | points | error, of 255 | time |")
    print("|---|---|---|---|---|---|")
    curves = {}
    for scene in scenes:
        reference, _, _ = renderer.run(scene, samples(32), f"{scene}_reference")
        for method, settings in METHODS.items():
            for i, options in enumerate(settings):
                picture, seconds, counters = renderer.run(scene, options, f"{scene}_{method.replace(', ', '_')}_{i}", RUNS)
                error = picture.rms(reference)
                curves.setdefault(scene, {}).setdefault(method, []).append((seconds, error))
                print(f"| {scene} | {method}: {' '.join(options.split()[:2])} | {counters['rays_camera']} | "
                      f"{counters['points_surface']} | {error:.2f} | {seconds:.2f} s |", flush=True)
    return curves


def at_error(curve, error):
    """What a curve of (cost, error) costs at an error: a straight line on logarithmic scales, through its ends beyond them."""
    points = sorted((math.log(e), math.log(cost)) for cost, e in curve)
    x = math.log(error)
    k = next((i for i in range(1, len(points) - 1) if x < points[i][0]), len(points) - 1)
    (x0, y0), (x1, y1) = points[k - 1], points[k]
    return math.exp(y0 + (y1 - y0) * (x - x0) / (x1 - x0))


def bench(renderer):
    for scene in ("room", "patches", "glass"):
        every, slow, all_points = renderer.run(scene, samples(4), f"{scene}_every")
        reused, fast, points = renderer.run(scene, samples(4) + REUSE, f"{scene}_reused")
        ratio = all_points["points_surface"] / points["points_surface"]
        print(json.dumps({"name": f"shades shared, {scene}", "value": round(ratio, 1), "unit": "times fewer points", "limit": 8,
                          "error": f"99.9 % of differences below {every.percentile(reused, .999):.1f} of 255",
                          "note": f"320x240, 4x4 samples, one thread: {slow:.2f} s, shared {fast:.2f} s"}))
    for scene in ("room", "edges"):
        reference, _, _ = renderer.run(scene, samples(24), f"{scene}_reference")
        curve = []
        for options in METHODS["plain"]:
            picture, _, counters = renderer.run(scene, options, f"{scene}_plain")
            curve.append((counters["rays_camera"], picture.rms(reference)))
        picture, seconds, counters = renderer.run(scene, adaptive(.001, 4, 64), f"{scene}_adaptive")
        error = picture.rms(reference)
        print(json.dumps({"name": f"adaptive sampling, {scene}", "unit": "times fewer rays",
                          "value": round(at_error(curve, error) / counters["rays_camera"], 1),
                          "error": f"equal: {error:.2f} of 255", "note": f"{seconds:.2f} s, one thread"}))


def plot(curves, path):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "perigee"
    from matplotlib import pyplot
    columns = 4
    rows = (len(curves) + columns - 1) // columns
    figure, axes = pyplot.subplots(rows, columns, figsize=(3.2 * columns, 2.8 * rows), squeeze=False)
    for axis in axes.flat[len(curves):]:
        axis.remove()
    for axis, (scene, methods) in zip(axes.flat, curves.items()):
        for method, points in methods.items():
            axis.loglog(*zip(*points), "o-", markersize=3, linewidth=1, label=method)
        axis.set_title(scene, fontsize=9)
        axis.set_xlabel("processor seconds", fontsize=7)
        axis.set_ylabel("error, of 255", fontsize=7)
        axis.tick_params(labelsize=6, which="both")
    axes.flat[0].legend(fontsize=6)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--plot")
    parser.add_argument("--keep")
    parser.add_argument("--bench", action="store_true")
    parser.add_argument("--only", choices=["reuse", "methods"])
    arguments = parser.parse_args()
    scenes = arguments.scenes.split(",")
    with tempfile.TemporaryDirectory() as temporary:
        folder = os.path.abspath(arguments.keep or temporary)
        os.makedirs(folder, exist_ok=True)
        renderer = Renderer(os.path.abspath(arguments.build), folder)
        if arguments.bench:
            bench(renderer)
            return
        if arguments.only != "methods":
            reuse_table(renderer, scenes)
        if arguments.only != "reuse":
            curves = methods_table(renderer, scenes)
            if arguments.plot:
                plot(curves, arguments.plot)


if __name__ == "__main__":
    sys.exit(main())
