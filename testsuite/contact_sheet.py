#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders every shader of testsuite/sl/corpus on a small scene and lays the pictures out on labelled sheets.

usage: contact_sheet.py [--build DIR] [--out DIR] [--only NAME ...]
In: the programs of a build. Out: DIR/corpus_<kind>.png for surfaces, displacements, lights, volumes and imagers, and one
line per shader whose render said something. Needs the Debian package python3-pil.
"""

import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile

try:
    from PIL import Image, ImageDraw
except ImportError:
    sys.exit("contact_sheet.py needs the package python3-pil")

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CORPUS = os.path.join(ROOT, "testsuite", "sl", "corpus")
WIDTH, HEIGHT, LABEL, COLUMNS = 160, 120, 14, 7
SHADER = re.compile(r"^(surface|displacement|light|volume|imager)\s+(\w+)\s*\(", re.MULTILINE)

HEAD = '''Display "{picture}" "png" "rgb"
Format {w} {h} 1
PixelSamples 3 3
PixelFilter "gaussian" 2 2
ShadingRate 1
Exposure 1 1.6
Clipping .5 100
{imager}
Projection "perspective" "fov" 32
'''
LIGHTS = '''LightSource "ambientlight" 1 "intensity" .25
Attribute "light" "shadows" "off"
LightSource "distantlight" 2 "from" [-1 1.2 -1.5] "to" [0 0 0] "intensity" .9
LightSource "pointlight" 3 "from" [2 2 -1] "intensity" 1.5 "lightcolor" [.7 .8 1]
'''
ROOM = '''AttributeBegin Color .55 .55 .6 Surface "matte" {floor}
Polygon "P" [-6 -1 -3  -6 -1 6  6 -1 6  6 -1 -3]
Polygon "P" [-6 -1 3.5  -6 6 3.5  6 6 3.5  6 -1 3.5]
AttributeEnd
'''
# A ball and a standing square: patterns of space and of s, t.
THINGS = '''AttributeBegin
{shader}
TransformBegin Translate -.75 -.1 0 Rotate -90 1 0 0 Rotate 35 0 0 1 Scale .9 .9 .9 {reshade}
Sphere 1 -1 1 360 TransformEnd
TransformBegin Translate 1.05 -.05 .3 Rotate 25 0 1 0
Patch "bilinear" "P" [-.8 .85 0  .8 .85 0  -.8 -.85 0  .8 -.85 0] TransformEnd
AttributeEnd
'''
BALLS = '''AttributeBegin Color .8 .3 .2 Surface "plastic" Translate -1 -.4 0 Sphere .6 -.6 .6 360 AttributeEnd
AttributeBegin Color .2 .5 .8 Surface "plastic" Translate .8 -.3 1.5 Sphere .7 -.7 .7 360 AttributeEnd
AttributeBegin Color .3 .7 .3 Surface "matte" Translate .3 -.7 -.8 Sphere .3 -.3 .3 360 AttributeEnd
'''
EYE = "Translate 0 -.1 5\nRotate -8 1 0 0\n"

# Parameters where the defaults show nothing.
PARAMETERS = {
    "uber_light": '"intensity" 1.5 "roundness" .5',
    "barn_doors": '"intensity" 14',
    "slide_projector": '"intensity" 1.5 "fieldofview" .8',
    "window_light": '"intensity" 1.2 "point center" [0 0 3] "vector in" [0 0 1] "vector up" [0 1 0]',
    "area_soft": '"intensity" 8',
    "two_cones": '"intensity" 2',
    "metaball_light": '"intensity" 8',
    "noisy_mist": '"mindist" .02 "maxdist" .09',
    "smoke_march": '"opacdensity" .35 "lightdensity" .25',
    "texture_forms": '"map" "map.tif" "maps" ["map.tif" "map.tif"]',
    "bump_forms": '"map" "map.tif"',
    "environment_forms": '"envmap" ""',
    "planet_earth": '"Ka" .3',
}
COLORS = {"cel_shade": ".9 .5 .3", "car_paint": ".7 .05 .05", "velvet": ".5 .05 .2", "gooch": ".6 .5 .4", "badge": ".3 .3 .5",
          "water_waves": ".1 .2 .2", "brushed_metal": ".9 .9 .9", "skin_thin": ".9 .7 .6", "voronoi_rocks": ".7 .6 .5"}


def shaders():
    for name in sorted(os.listdir(CORPUS)):
        if name.endswith(".sl"):
            with open(os.path.join(CORPUS, name), encoding="utf-8") as file:
                # `surface` and the name may stand on two lines
                for kind, shader in SHADER.findall(re.sub(r"\b(surface|displacement|light)\n+", r"\1 ", file.read())):
                    if shader == name[:-3]:
                        yield kind, shader


def scene(kind, name, picture):
    given = PARAMETERS.get(name, "")
    imager = f'Imager "{name}" {given}' if kind == "imager" else 'Imager "background" "bgcolor" [.2 .22 .26]'
    text = HEAD.format(picture=picture, w=WIDTH, h=HEIGHT, imager=imager) + EYE + "WorldBegin\n"
    if kind == "light":
        text += ('LightSource "ambientlight" 1 "intensity" .06\nTransformBegin Translate -1.5 3 -2.5 Rotate 28 0 1 0 '
                 f'Rotate 40 1 0 0\nLightSource "{name}" 2 {given}\nTransformEnd\n')
    else:
        text += LIGHTS
    if kind == "volume":
        text += f'Atmosphere "{name}" {given}\n'
    text += ROOM.format(floor='"Kd" .9')
    if kind in ("light", "volume", "imager"):
        return text + BALLS + "WorldEnd\n"
    shader = f'Color {COLORS.get(name, ".75 .6 .45")}\n'
    call = f'Surface "{name}" {given}'
    if kind == "displacement":
        call = f'Attribute "displacementbound" "sphere" .3 "coordinatesystem" "shader"\nSurface "plastic" Displacement "{name}" {given}'
    return text + THINGS.format(shader=shader + call, reshade=call) + "WorldEnd\n"


def render(build, folder, kind, name):
    """The picture, and what was said."""
    picture = os.path.join(folder, name + ".png")
    path = os.path.join(folder, name + ".rib")
    with open(path, "w", encoding="utf-8") as file:
        file.write(scene(kind, name, picture))
    places = f"{CORPUS}:{os.path.join(build, 'shaders')}"
    result = subprocess.run([os.path.join(build, "tracer", "render"), "-shaders", places, path], cwd=folder, check=False,
                            capture_output=True, text=True, errors="replace", timeout=300)
    said = [line for line in result.stderr.splitlines() if re.search(r": (warning|error|severe)", line)]
    return (Image.open(picture).convert("RGB") if os.path.exists(picture) else None), said


def make_map(folder):
    """A picture with a gradient, a checker and a bright corner, for shaders that want one."""
    image = Image.new("RGB", (128, 128))
    image.putdata([(x * 2, y * 2, 200 if (x // 16 + y // 16) % 2 else 40) for y in range(128) for x in range(128)])
    image.save(os.path.join(folder, "map.tif"))


def sheet(pictures):
    rows = (len(pictures) + COLUMNS - 1) // COLUMNS
    columns = min(COLUMNS, len(pictures))
    image = Image.new("RGB", (columns * (WIDTH + 4) + 4, rows * (HEIGHT + LABEL + 4) + 4), (30, 30, 34))
    draw = ImageDraw.Draw(image)
    for i, (name, picture) in enumerate(pictures):
        x, y = 4 + i % COLUMNS * (WIDTH + 4), 4 + i // COLUMNS * (HEIGHT + LABEL + 4)
        if picture is not None:
            image.paste(picture, (x, y))
        draw.text((x + 2, y + HEIGHT + 1), name, fill=(225, 225, 225))
    return image.quantize(256, dither=Image.Dither.NONE if hasattr(Image, "Dither") else 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", default=os.path.join(ROOT, "build"))
    parser.add_argument("--out", default=os.path.join(ROOT, "docs", "pictures"))
    parser.add_argument("--only", nargs="*")
    options = parser.parse_args()
    kinds = {}
    with tempfile.TemporaryDirectory() as folder:
        make_map(folder)
        wanted = [(kind, name) for kind, name in shaders() if not options.only or name in options.only]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            done = list(pool.map(lambda job: render(os.path.abspath(options.build), folder, *job), wanted))
        for (kind, name), (picture, said) in zip(wanted, done):
            kinds.setdefault(kind, []).append((name, picture))
            if said or picture is None:
                print(f"{name}: {'; '.join(said[:3])}{' NO PICTURE' if picture is None else ''}", flush=True)
    for kind, pictures in kinds.items():
        sheet(pictures).save(os.path.join(options.out, f"corpus_{kind}.png"), optimize=True)
        print(f"corpus_{kind}.png: {len(pictures)} shaders")
    return 0


if __name__ == "__main__":
    sys.exit(main())
