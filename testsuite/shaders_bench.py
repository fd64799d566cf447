#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A scene with 20 shaders that nobody has compiled yet: wall time of render with 1 and 2 threads, then from the cache.

usage: shaders_bench.py RENDER
With one thread the shaders are compiled one after the other; the picture is so small that nearly all time is compiling.
Prints JSON lines (docs/benchmarks.md). The cache starts empty in every cold run.
"""
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

NUM_SHADERS = 20
RUNS = 3
SHADER = """surface s{0}(float Ka = 1, Kd = .7, Ks = .{0}, roughness = .1, freq = {0}; color veins = color(1, .9, .{0});)
{{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    point PP = transform("shader", P) * freq;
    float turbulence = 0, size = 1, i;
    for (i = 0; i < 6; i += 1) {{
        turbulence += abs(.5 - noise(PP * size)) / size;
        size *= 2;
    }}
    color Ct = mix(Cs, veins, smoothstep(.2, .6, turbulence + .{0} * cellnoise(PP)));
    if (turbulence > .5)
        Ct *= 1 - .1 * noise(s * freq, t * freq);
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, V, roughness));
}}
"""


def scene():
    spheres = "".join(f'AttributeBegin Surface "s{i}" Translate {i % 5 - 2} {i // 5 - 1.5} 0 Sphere .4 -.4 .4 360 AttributeEnd\n'
                      for i in range(NUM_SHADERS))
    return ('Display "twenty.png" "png" "rgb"\nFormat 64 64 1\nPixelSamples 1 1\nWorldBegin\n'
            f'LightSource "distantlight" 1 "to" [0 0 1]\nTranslate 0 0 5\n{spheres}WorldEnd\n')


def seconds(render, folder, threads, cold):
    times = []
    for _ in range(RUNS):
        cache = os.path.join(folder, "cache")
        if cold:
            shutil.rmtree(cache, ignore_errors=True)
        begin = time.perf_counter()
        subprocess.run([render, "--progress=none", "-t", str(threads), "twenty.rib"], cwd=folder, check=True,
                       env=dict(os.environ, PERIGEE_CACHE=cache, SHADERS=""))
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def result(name, value, unit, note, **more):
    print(json.dumps({"name": name, "value": round(value, 3), "unit": unit, "error": "exact", "note": note, **more}))


def main():
    render = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        for i in range(NUM_SHADERS):
            with open(os.path.join(folder, f"s{i}.sl"), "w", encoding="ascii") as file:
                file.write(SHADER.format(i))
        with open(os.path.join(folder, "twenty.rib"), "w", encoding="ascii") as file:
            file.write(scene())
        serial = seconds(render, folder, 1, cold=True)
        parallel = seconds(render, folder, 2, cold=True)
        warm = seconds(render, folder, 2, cold=False)
    result("20 shaders, cold, one at a time", serial, "s", f"whole process, -t 1; median of {RUNS}", better="lower")
    result("20 shaders, cold, 2 threads", parallel, "s", f"whole process, -t 2; median of {RUNS}", better="lower")
    result("20 shaders, one at a time / 2 threads", serial / parallel, "ratio", "best possible: 2 on two free cores")
    result("20 shaders, from the cache", 1000 * warm, "ms", "whole process, picture included", better="lower")


if __name__ == "__main__":
    main()
