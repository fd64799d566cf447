# SPDX-License-Identifier: Apache-2.0
"""The scenes of docs/sampling.md: one RIB each, as text. What is measured differs in options only, which come first."""
import math
import random

SIZE = (320, 240)
HEAD = """Display "{file}" "tiff" "rgba" "quantize" [0 0 0 0]
Format {x} {y} 1
"""
CAMERA = 'Projection "perspective" "fov" 40\n'


def light(number, shader, position, intensity, shadows):
    return (f'Attribute "light" "string shadows" "{"on" if shadows else "off"}"\n'
            f'LightSource "{shader}" {number} "from" [{position[0]} {position[1]} {position[2]}] '
            f'"intensity" {intensity}\n')


def wall(corners, freq, color):
    points = " ".join(f"{x:g}" for corner in corners for x in corner)
    return (f'AttributeBegin\nColor {color}\nSurface "study_tiles" "freq" {freq}\n'
            f'Polygon "P" [{points}] "st" [0 0 1 0 1 1 0 1]\nAttributeEnd\n')


def room():
    """Tiled walls, marble balls, three point lights with shadows."""
    text = CAMERA + "WorldBegin\nTranslate 0 0 4.5\n" + 'LightSource "ambientlight" 1 "intensity" .15\n'
    for i, (x, z) in enumerate([(-1.2, -1), (1.2, -.5), (0, 1)]):
        text += light(i + 2, "pointlight", (x, 1.6, z), 1.6, True)
    a, b = 2, 1.8
    text += wall([(-a, -b, -2), (a, -b, -2), (a, -b, 2), (-a, -b, 2)], 5, ".8 .7 .6")
    text += wall([(-a, b, -2), (a, b, -2), (a, b, 2), (-a, b, 2)], 3, ".9 .9 .9")
    text += wall([(-a, -b, 2), (a, -b, 2), (a, b, 2), (-a, b, 2)], 4, ".6 .7 .8")
    text += wall([(-a, -b, -2), (-a, -b, 2), (-a, b, 2), (-a, b, -2)], 4, ".8 .4 .4")
    text += wall([(a, -b, -2), (a, -b, 2), (a, b, 2), (a, b, -2)], 4, ".4 .8 .4")
    for i in range(7):
        x, z = -1.4 + .47 * i, .5 * math.cos(2.5 * i)
        r = .2 + .05 * (i % 3)
        text += (f'AttributeBegin\nColor {.5 + .5 * (i % 2)} {.9 - .1 * i:.2f} .7\nSurface "study_marble"\n'
                 f'Translate {x:.3f} {-b + r:.3f} {z:.3f}\nSphere {r} {-r} {r} 360\nAttributeEnd\n')
    return text + "WorldEnd\n"


def bumps():
    """A field of spheres with waves on them."""
    text = CAMERA + "WorldBegin\nTranslate 0 0 7\nRotate -35 1 0 0\n" + 'LightSource "ambientlight" 1 "intensity" .1\n'
    text += light(2, "pointlight", (3, 3, -4), 22, True)
    for j in range(6):
        for i in range(7):
            text += (f'AttributeBegin\nColor {.4 + .1 * j:.2f} .6 {.9 - .1 * i:.2f}\nSurface "plastic"\n'
                     f'Displacement "study_waves" "freq" {3 + (i + j) % 4}\n'
                     f"Translate {.9 * (i - 3):.2f} {.9 * (j - 2.5):.2f} 0\nSphere .4 -.4 .4 360\nAttributeEnd\n")
    return text + "WorldEnd\n"


def patches():
    """A wavy sheet of 24 by 18 bicubic patches."""
    text = CAMERA + "WorldBegin\nTranslate 0 0 5\nRotate -40 1 0 0\n" + 'LightSource "ambientlight" 1 "intensity" .1\n'
    text += light(2, "pointlight", (2, 2, -3), 14, True)
    text += 'Surface "plastic" "Ks" .3\nColor .7 .6 .9\nBasis "bezier" 3 "bezier" 3\n'
    n, m = 24 * 3 + 1, 18 * 3 + 1
    points = []
    for j in range(m):
        for i in range(n):
            x, y = 4 * i / (n - 1) - 2, 3 * j / (m - 1) - 1.5
            points.append(f"{x:.4f} {y:.4f} {.25 * math.sin(5 * x) * math.cos(4 * y):.4f}")
    return text + f'PatchMesh "bicubic" {n} "nonperiodic" {m} "nonperiodic" "P" [{" ".join(points)}]\nWorldEnd\n'


def focus():
    """Rows of marble balls through a lens."""
    text = "DepthOfField 8 .8 5\n" + CAMERA + "WorldBegin\n" + 'LightSource "ambientlight" 1 "intensity" .1\n'
    text += light(2, "pointlight", (3, 4, 0), 22, True)
    text += "Translate 0 -.4 0\n"
    text += wall([(-9, -.5, 1), (9, -.5, 1), (9, -.5, 25), (-9, -.5, 25)], 18, ".6 .6 .5")
    for j in range(6):
        for i in range(5):
            text += (f'AttributeBegin\nColor .8 {.3 + .1 * j:.2f} {.2 + .15 * i:.2f}\nSurface "study_marble"\n'
                     f"Translate {1.1 * (i - 2):.2f} 0 {2.5 + 1.8 * j:.2f}\nSphere .5 -.5 .5 360\nAttributeEnd\n")
    return text + "WorldEnd\n"


def glass():
    """Partly opaque balls behind each other before tiles."""
    text = CAMERA + "WorldBegin\nTranslate 0 0 5\n" + 'LightSource "ambientlight" 1 "intensity" .2\n'
    text += light(2, "pointlight", (2, 3, -4), 18, False)
    text += wall([(-4, -3, 2), (4, -3, 2), (4, 3, 2), (-4, 3, 2)], 9, ".9 .8 .7")
    for k in range(9):
        x, y, z = 1.6 * math.sin(2.4 * k), 1.1 * math.cos(3.1 * k), 1.2 - .3 * k
        o = .25 + .05 * (k % 5)
        text += (f'AttributeBegin\nColor {.3 + .08 * k:.2f} .5 {1 - .1 * k:.2f}\nOpacity {o:.2f} {o:.2f} {o:.2f}\n'
                 f'Surface "plastic"\nTranslate {x:.3f} {y:.3f} {z:.3f}\nSphere .7 -.7 .7 360\nAttributeEnd\n')
    return text + "WorldEnd\n"


def mist():
    """The balls of `focus` without a lens, in fog."""
    return focus().replace("DepthOfField 8 .8 5\n", "").replace(
        "WorldBegin\n", 'WorldBegin\nAtmosphere "fog" "distance" 9 "background" [.5 .55 .6]\n')


def edges():
    """Outlines: some hundred thin cones and rings before nothing."""
    rng = random.Random(7)
    text = CAMERA + "WorldBegin\nTranslate 0 0 6\n" + 'LightSource "ambientlight" 1 "intensity" .2\n'
    text += light(2, "pointlight", (4, 5, -5), 40, False)
    for k in range(120):
        x, y, z = (rng.uniform(-2.4, 2.4), rng.uniform(-1.8, 1.8), rng.uniform(-1, 1))
        text += (f'AttributeBegin\nColor {rng.uniform(.3, 1):.2f} {rng.uniform(.3, 1):.2f} {rng.uniform(.3, 1):.2f}\n'
                 f'Surface "plastic"\nTranslate {x:.3f} {y:.3f} {z:.3f}\nRotate {rng.uniform(0, 360):.1f} 1 1 0\n' +
                 ("Cone 1 .08 360\n" if k % 2 else "Torus .3 .03 0 360 360\n") + "AttributeEnd\n")
    return text + "WorldEnd\n"


def penumbra():
    """A square light above balls and tiles."""
    text = CAMERA + "WorldBegin\nTranslate 0 -.3 5\nRotate -20 1 0 0\n" + 'LightSource "ambientlight" 1 "intensity" .1\n'
    text += ('Attribute "light" "string shadows" "on" "integer nsamples" 16\nAttributeBegin\nTranslate 0 3 0\n'
             'AreaLightSource "arealight" 2 "intensity" 12\n'
             'Polygon "P" [-.5 0 -.5 .5 0 -.5 .5 0 .5 -.5 0 .5]\nAttributeEnd\nIlluminate 2 1\n')
    text += wall([(-4, -1, -3), (4, -1, -3), (4, -1, 4), (-4, -1, 4)], 6, ".8 .8 .7")
    for i in range(5):
        text += (f'AttributeBegin\nColor .8 .5 .4\nSurface "matte"\nTranslate {1.1 * (i - 2):.2f} {-.5 + .3 * (i % 3):.2f} '
                 f"{.6 * (i % 2):.2f}\nSphere .35 -.35 .35 360\nAttributeEnd\n")
    return text + "WorldEnd\n"


SCENES = {f.__name__: f for f in (room, bumps, patches, focus, glass, mist, edges, penumbra)}


def rib(name, options, file, size=SIZE):
    return HEAD.format(file=file, x=size[0], y=size[1]) + options + SCENES[name]()
