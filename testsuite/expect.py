# SPDX-License-Identifier: Apache-2.0
"""Evaluates expectations: `left relation right +- tolerance | reason`.

In: one expectation, and the folder the runs wrote their pictures to. Out: None, or what was wrong.
Sides are Python expressions over the functions below; colours and positions are Vectors and compare by their
worst component. Expectations come from our own case files and are as trusted as the runner itself.
"""

import math
import os
import struct

import pictures

RELATIONS = ("==", "!=", "<=", ">=", "<", ">")


class ExpectError(Exception):
    """The expectation itself cannot be read or evaluated."""


class Vector(tuple):
    """A colour or position: arithmetic by component, .r .g .b .a or .x .y .z."""

    def _with(self, other, op):
        other = other if isinstance(other, tuple) else (other,) * len(self)
        return Vector(op(a, b) for a, b in zip(self, other, strict=True))

    def __add__(self, other):
        return self._with(other, lambda a, b: a + b)

    def __sub__(self, other):
        return self._with(other, lambda a, b: a - b)

    def __mul__(self, other):
        return self._with(other, lambda a, b: a * b)

    def __truediv__(self, other):
        return self._with(other, lambda a, b: a / b)

    __radd__ = __add__
    __rmul__ = __mul__

    def __neg__(self):
        return self * -1.0

    def __getattr__(self, name):
        index = {"r": 0, "g": 1, "b": 2, "a": 3, "x": 0, "y": 1, "z": 2}.get(name)
        if index is None or index >= len(self):
            raise AttributeError(f"no component {name} among {len(self)}")
        return self[index]

    @property
    def rgb(self):
        return Vector(self[:3])


def vec(*values):
    return Vector(float(v) for v in values)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return vec(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return Vector(a) / length(a)


def mix(a, b, t):
    return a * (1 - t) + b * t


def smoothstep(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


class PictureFunctions:
    """The functions of an expectation that look at files of the run folder."""

    def __init__(self, folder):
        self.folder = folder
        self.cache = {}

    def path(self, name):
        """`out.tif` belongs to the only run, `two/out.tif` to run `two`."""
        return os.path.join(self.folder, name if "/" in name else os.path.join("main", name))

    def picture(self, name):
        """`out.exr:N` is the layer N of it."""
        if name not in self.cache:
            file, _, layer = name.partition(":")
            self.cache[name] = (self.picture(file).layer(layer) if layer
                                else pictures.read_picture(self.path(file)))
        return self.cache[name]

    def pixel(self, name, x, y):
        return Vector(self.picture(name).at(x, y))

    def region(self, name, x0=0, x1=None, y0=0, y1=None):
        """Yields (x, y, colour) for x0 <= x < x1, y0 <= y < y1."""
        picture = self.picture(name)
        for y in range(y0, picture.height if y1 is None else y1):
            for x in range(x0, picture.width if x1 is None else x1):
                yield x, y, Vector(picture.at(x, y))

    def total(self, name, *box):
        columns = zip(*(colour for _, _, colour in self.region(name, *box)))
        return Vector(math.fsum(column) for column in columns)

    def mean(self, name, *box):
        count = sum(1 for _ in self.region(name, *box))
        return self.total(name, *box) / count

    def lowest(self, name, *box):
        return Vector(min(column) for column in zip(*(c for _, _, c in self.region(name, *box))))

    def highest(self, name, *box):
        return Vector(max(column) for column in zip(*(c for _, _, c in self.region(name, *box))))

    def deviation(self, name, *box):
        """Standard deviation over the region, by channel."""
        mean = self.mean(name, *box)
        columns = list(zip(*(c for _, _, c in self.region(name, *box))))
        return Vector(math.sqrt(math.fsum((v - m) ** 2 for v in column) / len(column))
                      for column, m in zip(columns, mean))

    def centroid(self, name, *box, channel=0):
        """Mean raster position (pixel centres at +0.5) weighted by a channel."""
        sx, sy, weight = 0.0, 0.0, 0.0
        for x, y, colour in self.region(name, *box):
            sx += (x + 0.5) * colour[channel]
            sy += (y + 0.5) * colour[channel]
            weight += colour[channel]
        if weight == 0:
            raise ExpectError(f"centroid: {name} is zero there")
        return vec(sx / weight, sy / weight)

    def worst(self, name, function, *box):
        """Largest value of function(x, y, colour) over the region; the position is kept for the message."""
        values = [(function(x + 0.5, y + 0.5, c), x, y) for x, y, c in self.region(name, *box)]
        values = [v for v in values if v[0] is not None]
        if not values:
            raise ExpectError("worst: no pixel took part")
        self.note = "at pixel (%d, %d)" % max(values)[1:]
        return max(values)[0]

    def count(self, name, function, *box):
        return sum(1 for x, y, c in self.region(name, *box) if function(x + 0.5, y + 0.5, c))

    def difference(self, one, two):
        """Largest absolute difference of two pictures of one size."""
        a, b = self.picture(one), self.picture(two)
        if (a.width, a.height, len(a.channels)) != (b.width, b.height, len(b.channels)):
            raise ExpectError(f"{one} and {two} differ in size or channels")
        return max(abs(p - q) for ra, rb in zip(a.rows, b.rows) for p, q in zip(ra, rb))

    def size(self, name):
        return vec(self.picture(name).width, self.picture(name).height)

    def channels(self, name):
        return self.picture(name).channels

    def levels(self, name):
        return self.picture(name).levels

    def parts(self, name):
        return self.picture(name).parts

    def kind(self, name, channel):
        """How OpenEXR holds a channel: half or float."""
        return {"e": "half", "f": "float", "I": "integer"}[self.picture(name).kinds[channel]]

    def tag(self, name, key):
        return self.picture(name).tags.get(key)

    def window(self, name, key):
        """OpenEXR: dataWindow or displayWindow as (x0, y0, x1, y1), corners included."""
        return struct.unpack("<4i", self.picture(name).tags[key])

    def file_bytes(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def file_text(self, name):
        return self.file_bytes(name).decode("utf-8", "replace")

    def exists(self, name):
        return os.path.exists(self.path(name))


def scope(folder):
    """Names that expectations may use."""
    functions = PictureFunctions(folder)
    names = {name: getattr(functions, name) for name in dir(functions)
             if not name.startswith("_") and callable(getattr(functions, name))}
    names.update({name: getattr(math, name) for name in
                  ("pi", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log",
                   "floor", "ceil", "hypot", "radians", "degrees", "isfinite", "inf", "erf")})
    names.update(vec=vec, dot=dot, cross=cross, length=length, unit=unit, mix=mix, smoothstep=smoothstep,
                 abs=abs, min=min, max=max, sum=sum, len=len, all=all, any=any, range=range, round=round,
                 zip=zip, sorted=sorted, set=set, int=int, float=float, functions=functions)
    return names


def assign(text, names):
    """`name = expression` of a `let:` line."""
    name, _, value = text.partition("=")
    if not name.strip().isidentifier():
        raise ExpectError(f"let: '{text}' is not 'name = expression'")
    names[name.strip()] = evaluate(value.strip(), names)


def evaluate(text, names):
    try:
        return eval(text, {"__builtins__": {}, **names})  # pylint: disable=eval-used
    except (pictures.PictureError, ExpectError):
        raise
    except Exception as error:  # a typing error in a case must name itself, whatever its type
        raise ExpectError(f"'{text}': {type(error).__name__}: {error}") from error


def compare(left, relation, right, tolerance):
    if relation in ("==", "!="):
        if isinstance(left, tuple) or isinstance(right, tuple):
            size = len(left if isinstance(left, tuple) else right)
            left = left if isinstance(left, tuple) else (left,) * size
            right = right if isinstance(right, tuple) else (right,) * size
            equal = len(left) == len(right) and all(abs(a - b) <= tolerance for a, b in zip(left, right))
        elif isinstance(left, (int, float)) and isinstance(right, (int, float)):
            equal = abs(left - right) <= tolerance
        else:
            equal = left == right
        return equal == (relation == "==")
    left = left if isinstance(left, tuple) else (left,)
    right = right if isinstance(right, tuple) else (right,) * len(left)
    order = {"<": lambda a, b: a < b, "<=": lambda a, b: a <= b,
             ">": lambda a, b: a > b, ">=": lambda a, b: a >= b}[relation]
    return all(order(a, b) for a, b in zip(left, right))


def split_outside(text, separators):
    """(before, separator, after) at the first separator outside brackets and strings, or None."""
    depth, quote = 0, ""
    for i, letter in enumerate(text):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter in "([{":
            depth += 1
        elif letter in ")]}":
            depth -= 1
        elif letter == " " and depth == 0:
            word = text[i + 1:].partition(" ")[0]
            if word in separators:
                return text[:i].strip(), word, text[i + 1 + len(word):].strip()
    return None


def split_claim(claim):
    """(left, relation, right, tolerance or "")"""
    sides = split_outside(claim, RELATIONS)
    if sides is None:
        raise ExpectError(f"'{claim}' has no relation ({' '.join(RELATIONS)})")
    left, relation, right = sides
    bounds = split_outside(right, ("+-",))
    return (left, relation, bounds[0], bounds[2]) if bounds else (left, relation, right, "")


def shorten(value):
    if isinstance(value, tuple):
        return "(" + ", ".join(shorten(v) for v in value) + ")"
    text = f"{value:.7g}" if isinstance(value, float) else repr(value)
    return text if len(text) < 90 else text[:60] + f"... ({len(text)} characters)"


def check(text, names):
    """None, or a sentence that says what was measured and what was expected."""
    claim, _, reason = text.partition(" | ")
    left_text, relation, right_text, tolerance_text = split_claim(claim.strip())
    if tolerance_text and not reason:
        raise ExpectError(f"'{claim}' has a tolerance without a reason (| reason)")
    functions = names["functions"]
    functions.note = ""
    left, right = evaluate(left_text, names), evaluate(right_text, names)
    tolerance = evaluate(tolerance_text, names) if tolerance_text else 0.0
    if compare(left, relation, right, tolerance):
        return None
    wanted = f"{relation} {shorten(right)}" + (f" +- {shorten(tolerance)}" if tolerance_text else "")
    return f"{left_text} is {shorten(left)}, expected {wanted} {functions.note}".rstrip()
