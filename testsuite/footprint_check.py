#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Footprints in reflections against finite differences of the whole ray path, in double.

usage: footprint_check.py RENDER SHADERS
A plane is seen in a plane mirror and in a ball; footprint.sl shows how far the next sample is across the ray. The paths of
the pixels beside it are followed here: eye, mirror, plane. Their distance across the ray is what must come out: the root of
the area they span, where the ball does not squeeze one direction to less than half of the other.
"""
import math
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures  # noqa: E402

SIZE, FOV = 64, 30.0
# The camera's footprint is the same all over a plane z = const; across the rays at the corner of the picture it is
# 1 - cos(21 degrees) / 2 smaller: 3.3 %; curvature over one pixel adds 1 %.
TOLERANCE = 0.05
PLANE_Z = -4.0
BALL = (0.0, 0.0, 8.0, 1.5)
HEAD = f"""Display "out.tif" "tiff" "rgb"
Quantize "rgb" 0 0 0 0
Format {SIZE} {SIZE} 1
PixelSamples 1 1
PixelFilter "box" 1 1
Hider "hidden" "jitter" [0]
Projection "perspective" "fov" {FOV}
WorldBegin
Surface "footprint"
Polygon "P" [-400 -400 {PLANE_Z}  -400 400 {PLANE_Z}  400 400 {PLANE_Z}  400 -400 {PLANE_Z}]
Surface "mirror"
"""
MIRRORS = {
    "plane": 'Polygon "P" [-50 -50 6  -50 50 6  50 50 6  50 -50 6]\n',
    "ball": f"Translate {BALL[0]} {BALL[1]} {BALL[2]}\nSphere {BALL[3]} {-BALL[3]} {BALL[3]} 360\n",
}


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add(a, b, scale=1.0):
    return [x + scale * y for x, y in zip(a, b)]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def mirrored(kind, direction):
    """Where the ray from the eye is reflected, and where to; None: it misses."""
    if kind == "plane":
        return [6 * x / direction[2] for x in direction], [direction[0], direction[1], -direction[2]]
    centre, radius = BALL[:3], BALL[3]
    b = dot(direction, centre)
    inside = b * b - dot(centre, centre) + radius * radius
    if inside <= 0:
        return None
    point = [(b - math.sqrt(inside)) * x for x in direction]
    normal = unit(add(point, centre, -1))
    return point, add(direction, normal, -2 * dot(direction, normal))


def landing(kind, x, y):
    """The point on the plane that raster position x, y sees, and the ray's direction there."""
    scale = math.tan(math.radians(FOV) / 2)
    found = mirrored(kind, unit([scale * (2 * x / SIZE - 1), scale * (1 - 2 * y / SIZE), 1.0]))
    if found is None or found[1][2] >= -0.05:
        return None
    point, direction = found
    return add(point, direction, (PLANE_Z - point[2]) / direction[2]), direction


def across(kind, x, y):
    """Width at pixel centre x, y, and how oblong the footprint is; None: not the plane."""
    h = 0.05
    middle = landing(kind, x, y)
    ends = [landing(kind, x + dx, y + dy) for dx, dy in ((-h, 0), (h, 0), (0, -h), (0, h))]
    if middle is None or None in ends:
        return None
    d = middle[1]
    sides = []
    for low, high in (ends[:2], ends[2:]):
        side = [(b - a) / (2 * h) for a, b in zip(low[0], high[0])]
        sides.append(add(side, d, -dot(side, d)))
    a, b, c = dot(sides[0], sides[0]), dot(sides[0], sides[1]), dot(sides[1], sides[1])
    area = math.sqrt(max(a * c - b * b, 0))
    longest = math.sqrt((a + c) / 2 + math.sqrt((a - c) ** 2 / 4 + b * b))
    return math.sqrt(area), longest * longest / area


def check(kind, picture):
    worst, compared = 0.0, 0
    for y in range(SIZE):
        for x in range(SIZE):
            wanted = across(kind, x + 0.5, y + 0.5)
            if wanted is None or wanted[1] > 2:
                continue
            compared += 1
            worst = max(worst, abs(picture.at(x, y)[0] / wanted[0] - 1))
    print(f"{kind}: {compared} pixels, worst error of the footprint {100 * worst:.2f} %")
    return compared > 100 and worst < TOLERANCE


def main():
    render, shaders = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    good = True
    for kind, mirror in MIRRORS.items():
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "t.rib"), "w", encoding="ascii") as file:
                file.write(HEAD + mirror + "WorldEnd\n")
            environment = dict(os.environ, PERIGEE_CACHE=os.path.join(folder, "cache"), SHADERS=shaders)
            subprocess.run([render, "--progress=none", "t.rib"], cwd=folder, env=environment, check=True)
            good &= check(kind, pictures.read_picture(os.path.join(folder, "out.tif")))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
