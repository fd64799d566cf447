#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What shader outputs in displays cost: processor time of whole renders that show 0, 1 and 8 of them, one thread.

usage: outputs_bench.py RENDER SHADERS TEST_SHADERS
Prints JSON lines (docs/benchmarks.md). Nothing is written to files: the displays are of type null.
"""
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile

OUTPUTS = ["Cdiffuse", "fall", "Nout", "Pout", "P", "N", "st", "Cs"]
SCENE = """Display "{mode}" "null" "{mode}"
Format 256 256 1
PixelSamples 4 4
Projection "perspective" "fov" 40
WorldBegin
Surface "show_outputs"
Translate 0 0 5
Sphere 1.7 -1.7 1.7 360
WorldEnd
"""
RUNS = 5


def processor_seconds(command, folder, environment):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    render, shaders, test_shaders = (os.path.abspath(path) for path in sys.argv[1:4])
    counts = (0, 1, len(OUTPUTS))
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, PERIGEE_CACHE=os.path.join(folder, "cache"),
                           SHADERS=os.pathsep.join([shaders, test_shaders]))
        for count in counts:
            with open(os.path.join(folder, f"{count}.rib"), "w", encoding="ascii") as file:
                file.write(SCENE.format(mode=",".join(["rgba"] + OUTPUTS[:count])))
        times = {count: [] for count in counts}
        for _ in range(RUNS + 1):  # interleaved: other jobs disturb all alike
            for count in counts:
                command = [render, "-t", "1", "--progress=none", f"{count}.rib"]
                times[count].append(processor_seconds(command, folder, environment))
    plain = statistics.median(times[0][1:])  # the first run compiles the shader
    for count in counts:
        seconds = statistics.median(times[count][1:])
        print(json.dumps({"name": f"display of {count} shader outputs", "value": round(seconds / plain, 2),
                          "unit": "ratio", "better": "lower", "error": "none",
                          "note": f"{1000 * seconds:.0f} ms of one core; 256x256, 4x4 samples, one sphere"}))


if __name__ == "__main__":
    main()
