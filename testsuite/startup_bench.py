#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Start to finish of one sphere, 64x64, one sample, shaders compiled: the median of many whole processes.

usage: startup_bench.py RENDER SHADERS
Prints one JSON line (docs/benchmarks.md); an empty process stands beside it. Goal: 50 ms (design.md 9).
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

SCENE = """Display "one.png" "png" "rgb"
Format 64 64 1
PixelSamples 1 1
Projection "perspective" "fov" 40
WorldBegin
LightSource "pointlight" 1 "from" [3 4 -2] "intensity" 20
Surface "plastic"
Translate 0 0 5
Sphere 1 -1 1 360
WorldEnd
"""
RUNS = 25
GOAL_MS = 50


def median_ms(command, folder, environment):
    times = []
    for run in range(RUNS + 2):
        begin = time.perf_counter()
        subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
        if run >= 2:  # the first ones warm the file cache
            times.append(1000 * (time.perf_counter() - begin))
    return statistics.median(times)


def main():
    render, shaders = (os.path.abspath(path) for path in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "one.rib"), "w", encoding="ascii") as file:
            file.write(SCENE)
        environment = dict(os.environ, PERIGEE_CACHE=os.path.join(folder, "cache"), SHADERS=shaders)
        empty = median_ms(["/bin/true"], folder, environment)
        whole = median_ms([render, "--progress=none", "one.rib"], folder, environment)
    print(json.dumps({"name": "one sphere, 64x64, start to finish", "value": round(whole, 1), "unit": "ms",
                      "limit": GOAL_MS, "better": "lower", "error": "none",
                      "note": f"an empty process: {empty:.1f} ms; median of {RUNS}"}))


if __name__ == "__main__":
    main()
