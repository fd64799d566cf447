#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How full packets are at each ray level: a mirrored room of 60 spheres under 20 different mirror shaders.

usage: rays_bench.py RENDER [SIZE]
Prints JSON lines (docs/benchmarks.md); fails if fewer than 6 of 8 lanes are live at level 2. Nothing is written to files.
"""
import json
import os
import subprocess
import sys
import tempfile

NUM_SHADERS, NUM_SPHERES, WANTED = 20, 60, 6.0
SHADER = """surface mirror{n}(float Kr = .9; color tint = color(.9, .8, {blue}))
{{
    normal Nf = faceforward(normalize(N), I);
    color seen = trace(P, reflect(normalize(I), Nf));
    Oi = Os;
    Ci = Os * (.05 * ({n} + 1) / 20 + tint * Kr * seen{more});
}}
"""
HEAD = """Display "rays" "null" "rgb"
Format {size} {size} 1
PixelSamples 2 2
Projection "perspective" "fov" 70
WorldBegin
"""
WALLS = ["-4 -4 0  -4 -4 12  4 -4 12  4 -4 0", "-4 4 0  4 4 0  4 4 12  -4 4 12", "-4 -4 0  -4 4 0  -4 4 12  -4 -4 12",
         "4 -4 0  4 -4 12  4 4 12  4 4 0", "-4 -4 12  -4 4 12  4 4 12  4 -4 12", "-4 -4 -1  4 -4 -1  4 4 -1  -4 4 -1"]


def surface(number):
    return f'Surface "mirror{number % NUM_SHADERS}"\n'


def scene(size):
    text = HEAD.format(size=size)
    for number, corners in enumerate(WALLS):
        text += surface(3 * number) + f'Polygon "P" [{corners}]\n'
    state = 1
    for number in range(NUM_SPHERES):
        place = []
        for _ in range(3):
            state = (state * 1103515245 + 12345) % 2**31
            place.append(state / 2**31)
        text += (f"AttributeBegin\n{surface(number)}"
                 f"Translate {7 * place[0] - 3.5:.4f} {7 * place[1] - 3.5:.4f} {3 + 8 * place[2]:.4f}\n"
                 "Sphere .5 -.5 .5 360\nAttributeEnd\n")
    return text + "WorldEnd\n"


def run(render, size, folder):
    for number in range(NUM_SHADERS):
        with open(os.path.join(folder, f"mirror{number}.sl"), "w", encoding="ascii") as file:
            more = f" * mix(color(1), noise({number} * P), .1)" if number % 3 == 0 else ""
            file.write(SHADER.format(n=number, blue=f"{number / NUM_SHADERS:.2f}", more=more))
    with open(os.path.join(folder, "rays.rib"), "w", encoding="ascii") as file:
        file.write(scene(size))
    environment = dict(os.environ, PERIGEE_CACHE=os.path.join(folder, "cache"), SHADERS=folder)
    command = [render, "-t", "1", "--progress=none", "--stats-json", "stats.json", "rays.rib"]
    subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    with open(os.path.join(folder, "stats.json"), encoding="utf-8") as file:
        return json.load(file)["total"]


def main():
    size = int(sys.argv[2]) if len(sys.argv) > 2 else 256
    with tempfile.TemporaryDirectory() as folder:
        total = run(os.path.abspath(sys.argv[1]), size, folder)
    counters = total["counters"]
    lanes = {}
    for level in (1, 2, 3, 4):
        lanes[level] = 8 * counters[f"lanes_live_{level}"] / max(counters[f"lanes_offered_{level}"], 1)
        row = {"name": f"live lanes at ray level {level}", "value": round(lanes[level], 2), "unit": "of 8",
               "error": "exact", "note": f"20 mirror shaders, {counters['rays_reflection']} rays, {size}x{size}, 2x2 samples"}
        if level == 2:
            row["limit"] = WANTED
        print(json.dumps(row))
    seconds = total["seconds"]["render"]
    print(json.dumps({"name": "rays of shaders", "value": round(counters["rays_reflection"] / seconds / 1e6, 3),
                      "unit": "M/s", "error": "none", "note": "one thread, shading included"}))
    return 0 if lanes[2] >= WANTED else 1


if __name__ == "__main__":
    sys.exit(main())
