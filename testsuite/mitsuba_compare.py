#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares radiance with an independent physical renderer: a box with diffuse walls, lit by a bright panel.

In: a build folder and, in the running Python, Mitsuba 3 (`pip install mitsuba`); without it the script says so and ends with 77.
Both renderers get the same polygons, camera and numbers of samples. Two scenes: "panel", where light comes only by rays that
happen to meet the bright surface (LightSource "indirect" alone), and "area", where it is sampled (AreaLightSource). Units: Ci of a
matte surface is Cs Cl (N.L) without 1/pi, and an area light's Cl is the mean over its points, so radiance Le of a light of area A
is Cl = Le A / pi times cosine over squared distance (docs/verification.md). Out: a Markdown table: time, mean difference, and the
largest difference of a region in standard errors.

    testsuite/mitsuba_compare.py build [--size 96] [--samples 16] [--variant scalar_rgb] [--keep FOLDER]
"""

import argparse
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
from pictures import read_picture  # noqa: E402

WHITE, RED, GREEN = (.75, .75, .75), (.6, .1, .08), (.15, .5, .12)
RADIANCE = (12.0, 10.0, 7.0)
BOUNCES = 8
REGIONS = 8  # a side
# z of the eye's distance to the front edge; the box is 2 wide, its front open.
NEAR, FAR = 3.0, 5.0


def quad(a, b, c, d):
    return [a, b, c, d]


def block(x, z, half, turn, height):
    """The five visible faces of a block that stands on the floor."""
    s, c = math.sin(turn), math.cos(turn)
    corner = [(x + half * (c * i - s * k), z + half * (s * i + c * k)) for i, k in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    low, high = -1.0, -1.0 + height
    faces = [quad(*[(cx, high, cz) for cx, cz in corner])]
    for i in range(4):
        (ax, az), (bx, bz) = corner[i], corner[(i + 1) % 4]
        faces.append(quad((ax, low, az), (bx, low, bz), (bx, high, bz), (ax, high, az)))
    return faces


def surfaces(half_light):
    """Pairs of color and polygon; the light has color None."""
    walls = [
        (WHITE, quad((-1, -1, NEAR), (-1, -1, FAR), (1, -1, FAR), (1, -1, NEAR))),
        (WHITE, quad((-1, 1, NEAR), (-1, 1, FAR), (1, 1, FAR), (1, 1, NEAR))),
        (WHITE, quad((-1, -1, FAR), (-1, 1, FAR), (1, 1, FAR), (1, -1, FAR))),
        (RED, quad((-1, -1, NEAR), (-1, 1, NEAR), (-1, 1, FAR), (-1, -1, FAR))),
        (GREEN, quad((1, -1, NEAR), (1, 1, NEAR), (1, 1, FAR), (1, -1, FAR))),
    ]
    walls += [(WHITE, face) for face in block(-.38, 4.35, .3, .3, 1.2) + block(.4, 3.75, .28, -.35, .6)]
    h, y, z = half_light, .999, 4.0
    # In this order of the corners N points down, in both renderers.
    walls.append((None, quad((h, y, z - h), (h, y, z + h), (-h, y, z + h), (-h, y, z - h))))
    return walls


def rib_polygon(points):
    return 'Polygon "P" [' + "  ".join(" ".join(f"{v:.9g}" for v in p) for p in points) + "]\n"


AREA_LIGHT = """// A surface of even radiance, as a light: Cl is what the whole of it would give from P.
light evenarea(float intensity = 1; color lightcolor = 1;)
{
    illuminate (P, N, PI / 2)
        Cl = intensity * lightcolor * (normalize(L).normalize(N)) / (L.L);
}
"""

EMITTER = """// Shines on the side N points to only.
surface emitter() { Oi = 1; Ci = (N.I < 0) ? Cs : color 0; }
"""


def write_rib(path, scene, half_light, size, samples):
    text = f"""# A box for comparison with a physical renderer.
Display "ours.tif" "tiff" "rgb"
Quantize "rgba" 0 0 0 0
Format {size} {size} 1
PixelSamples {samples} {samples}
PixelFilter "box" 1 1
Projection "perspective" "fov" {math.degrees(2 * math.atan(1 / NEAR)):.9g}
Option "render" "max_raylevel" [{BOUNCES}]
WorldBegin
Attribute "indirect" "maxerror" [0] "nsamples" [1]
Attribute "light" "shadows" "on"
LightSource "indirect" 1
Sides 2
"""
    light = [p for color, p in surfaces(half_light) if color is None][0]
    radiance = " ".join(map(str, RADIANCE))
    text += f'Surface "emitter"\nColor {radiance}\n'
    if scene == "area":
        area = 4 * half_light * half_light
        text += "AttributeBegin\n"
        text += f'AreaLightSource "evenarea" 2 "intensity" [{area / math.pi:.9g}] "lightcolor" [{radiance}]\n'
    text += rib_polygon(light)
    if scene == "area":
        text += "AttributeEnd\nIlluminate 2 1\n"
    text += 'Surface "matte"\n'
    for color, points in surfaces(half_light):
        if color is not None:
            text += f"Color {color[0]} {color[1]} {color[2]}\n" + rib_polygon(points)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + "WorldEnd\n")


def ours(build, folder, scene, half_light, size, samples):
    write_rib(os.path.join(folder, scene + ".rib"), scene, half_light, size, samples)
    for name, source in (("evenarea.sl", AREA_LIGHT), ("emitter.sl", EMITTER)):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(source)
    render = [os.path.abspath(os.path.join(build, "tracer", "render")), "--progress=none", scene + ".rib"]
    subprocess.run(render, cwd=folder, check=True)  # compiles the shaders
    start = time.monotonic()
    subprocess.run(render, cwd=folder, check=True)
    seconds = time.monotonic() - start
    picture = read_picture(os.path.join(folder, "ours.tif"))
    return [[picture.at(x, y)[:3] for x in range(size)] for y in range(size)], seconds


def mitsuba_scene(mi, half_light, size, samples):
    import numpy

    scene = {"type": "scene", "integrator": {"type": "path", "max_depth": BOUNCES + 1, "rr_depth": 100}}
    scene["sensor"] = {
        "type": "perspective", "fov": math.degrees(2 * math.atan(1 / NEAR)), "near_clip": .01,
        "to_world": mi.ScalarTransform4f().look_at(origin=[0, 0, 0], target=[0, 0, 1], up=[0, 1, 0]),
        "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}, "pixel_format": "rgb",
                 "component_format": "float32"},
        "sampler": {"type": "independent", "sample_count": samples * samples},
    }
    for i, (color, points) in enumerate(surfaces(half_light)):
        mesh = mi.Mesh(f"quad{i}", vertex_count=4, face_count=2)
        params = mi.traverse(mesh)
        params["vertex_positions"] = numpy.array(points, dtype=numpy.float32).ravel()
        params["faces"] = numpy.array([0, 1, 2, 0, 2, 3], dtype=numpy.uint32)
        params.update()
        path = os.path.join(tempfile.gettempdir(), f"perigee_{os.getpid()}_{i}.ply")
        mesh.write_ply(path)
        shape = {"type": "ply", "filename": path, "face_normals": True}
        reflectance = color if color is not None else (0, 0, 0)
        shape["bsdf"] = {"type": "twosided",
                         "material": {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(reflectance)}}}
        if color is None:
            shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": list(RADIANCE)}}
        scene[f"shape{i}"] = shape
    return scene


def theirs(mi, half_light, size, samples, bounces):
    import numpy

    description = mitsuba_scene(mi, half_light, size, samples)
    description["integrator"]["max_depth"] = bounces + 1
    scene = mi.load_dict(description)
    start = time.monotonic()
    image = numpy.array(mi.render(scene, spp=samples * samples, seed=1))
    seconds = time.monotonic() - start
    # Mitsuba's camera looks along +z with x to the left.
    return [[tuple(float(v) for v in image[y][size - 1 - x][:3]) for x in range(size)] for y in range(size)], seconds


def region_stats(rows, size, rx, ry):
    """Mean and its variance, as if pixels were independent; neighbours' differences, so that shading does not count as noise."""
    step = size // REGIONS
    values = [[sum(rows[y][x]) / 3 for x in range(rx * step, (rx + 1) * step)] for y in range(ry * step, (ry + 1) * step)]
    count = step * step
    mean = sum(map(sum, values)) / count
    differences = [(row[i] - row[i + 1]) ** 2 for row in values for i in range(0, step - 1, 2)]
    variance = sum(differences) / (2 * len(differences))
    return mean, variance / count


def compare(a, b, size):
    worst, squares, number = 0.0, 0.0, 0
    total_a = total_b = 0.0
    for ry in range(REGIONS):
        for rx in range(REGIONS):
            (ma, va), (mb, vb) = region_stats(a, size, rx, ry), region_stats(b, size, rx, ry)
            total_a, total_b = total_a + ma, total_b + mb
            if va + vb > 0:
                z = (ma - mb) / math.sqrt(va + vb)
                worst, squares, number = max(worst, abs(z)), squares + z * z, number + 1
    return total_a / total_b - 1, worst, math.sqrt(squares / max(number, 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--samples", type=int, default=16, help="square root of the samples per pixel")
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--scenes", default="panel,area")
    parser.add_argument("--keep", help="folder for the pictures and the RIB files")
    options = parser.parse_args()
    try:
        import mitsuba as mi
    except ImportError:
        print("mitsuba_compare.py: Mitsuba is not installed (pip install mitsuba)", file=sys.stderr)
        return 77
    mi.set_variant(options.variant)
    folder = options.keep or tempfile.mkdtemp(prefix="perigee_mitsuba_")
    os.makedirs(folder, exist_ok=True)
    print("| scene | size, samples | Perigee | Mitsuba | mean radiance differs by | worst of 64 regions, standard errors | their rms |")
    print("|---|---|---|---|---|---|---|")
    for scene in options.scenes.split(","):
        half_light = .25 if scene == "area" else .7
        # Rays that find the light themselves see it one level sooner than light that is sampled.
        bounces = BOUNCES + (1 if scene == "area" else 0)
        mine, my_seconds = ours(options.build, folder, scene, half_light, options.size, options.samples)
        other, other_seconds = theirs(mi, half_light, options.size, options.samples, bounces)
        if options.keep:
            import numpy
            mi.Bitmap(numpy.array(other, dtype=numpy.float32)).write(os.path.join(folder, scene + "_mitsuba.exr"))
            shutil.copy(os.path.join(folder, "ours.tif"), os.path.join(folder, scene + "_perigee.tif"))
        share, worst, rms = compare(mine, other, options.size)
        print(f"| {scene} | {options.size} x {options.size}, {options.samples ** 2} | {my_seconds:.2f} s | {other_seconds:.2f} s "
              f"| {100 * share:+.2f} % | {worst:.1f} | {rms:.2f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
