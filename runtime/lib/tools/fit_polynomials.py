#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds the polynomial coefficients of math_body.h: minimax fits (Remez exchange) rounded to float one by one.

Not part of the build; needs mpmath. Prints one C line per coefficient, lowest power first, and the largest weighted
error before float arithmetic. Rounding: the lowest coefficient is rounded to float and fixed, then the rest is fitted
again, so that each rounding is repaired by the coefficients above it. Where the interval contains 0 the higher powers alone cannot alternate: all are rounded at once.
"""
import struct
import sys

from mpmath import mp, mpf, matrix, lu_solve, sin, cos, tan, exp, log, atan, asin, erf, erfc, sqrt, pi, taylor

mp.dps = 40


def to_float(x):
    return mpf(struct.unpack("f", struct.pack("f", float(x)))[0])


def remez(f, weight, a, b, n, fixed):
    """Coefficients len(fixed)..n-1 minimising max |(p - f) weight| on [a, b]; fixed are the lower ones."""
    k = n - len(fixed)
    points = [(a + b) / 2 - (b - a) / 2 * cos(pi * (2 * i + 1) / (2 * k + 2)) for i in range(k + 1)]
    rest = lambda x: f(x) - sum(c * x**i for i, c in enumerate(fixed))
    grid = [a + (b - a) * i / 600 for i in range(601)]
    coefficients, worst = [], mpf(0)
    for _ in range(12):
        A, r = matrix(k + 1, k + 1), matrix(k + 1, 1)
        for i, x in enumerate(points):
            for j in range(k):
                A[i, j] = x ** (len(fixed) + j)
            A[i, k] = (-1) ** i / max(weight(x), mpf("1e-9"))
            r[i] = rest(x)
        solution = lu_solve(A, r)
        coefficients = [solution[j] for j in range(k)]
        error = lambda x: (sum(c * x ** (len(fixed) + j) for j, c in enumerate(coefficients)) - rest(x)) * weight(x)
        values = [error(x) for x in grid]
        worst = max(abs(v) for v in values)
        peaks, run = [], [0]
        for i in range(1, len(grid)):
            if (values[i] > 0) != (values[run[-1]] > 0):
                peaks.append(max(run, key=lambda j: abs(values[j])))
                run = []
            run.append(i)
        peaks.append(max(run, key=lambda j: abs(values[j])))
        if len(peaks) < k + 1:
            break
        while len(peaks) > k + 1:
            peaks.pop(0 if abs(values[peaks[0]]) < abs(values[peaks[-1]]) else -1)
        points = [grid[i] for i in peaks]
    return coefficients, worst


def fit(name, f, weight, a, b, n):
    fixed = []
    if a < 0:
        fixed = [to_float(c) for c in remez(f, weight, mpf(a), mpf(b), n, [])[0]]
    while len(fixed) < n:
        fixed.append(to_float(remez(f, weight, mpf(a), mpf(b), n, fixed)[0][0]))
    grid = [mpf(a) + (mpf(b) - mpf(a)) * i / 2000 for i in range(2001)]
    worst = max(abs((sum(c * x**i for i, c in enumerate(fixed)) - f(x)) * weight(x)) for x in grid)
    print(f"{name}: 2^{float(log(worst, 2)):.1f}")
    for c in fixed:
        print(f"    {float(c):.9g}f,")


def near0(f, low=mpf("1e-12")):
    """f with its limit taken from slightly off zero, where the quotient is 0/0."""
    return lambda x: f(x if x > low else low)


FITS = {
    # in z = r^2: sin r = r + r z P(z)
    "sin": (near0(lambda z: (sin(sqrt(z)) / sqrt(z) - 1) / z), lambda z: z, 0, (pi / 4 + mpf("1e-3"))**2, 3),
    "cos": (near0(lambda z: (cos(sqrt(z)) - 1 + z / 2) / z**2), lambda z: z * z, 0, (pi / 4 + mpf("1e-3"))**2, 3),
    "tan": (near0(lambda z: (tan(sqrt(z)) / sqrt(z) - 1) / z), lambda z: z, 0, (pi / 4 + mpf("1e-3"))**2, 7),
    # in r: e^r = 1 + r + r^2 P(r)
    "exp": (lambda r: (exp(r) - 1 - r) / r**2 if abs(r) > mpf("1e-9") else mpf(1) / 2, lambda r: r * r / exp(r),
            -log(2) / 2 - mpf("1e-3"), log(2) / 2 + mpf("1e-3"), 5),
    # in f: log(1+f) = f - f^2/2 + f^3 P(f)
    "log": (lambda f: (log(1 + f) - f + f * f / 2) / f**3 if abs(f) > mpf("1e-8") else mpf(1) / 3,
            lambda f: f**3 / log(1 + f) if abs(f) > mpf("1e-8") else f * f, sqrt(mpf(1) / 2) - 1, sqrt(mpf(2)) - 1, 10),
    # in z = s^2, s = f/(2+f): log(1+f) = 2s + s z P(z)
    "log_s": (near0(lambda z: (log((1 + sqrt(z)) / (1 - sqrt(z))) / sqrt(z) - 2) / z), lambda z: z, 0,
              (mpf("0.1717"))**2, 4),
    "atan": (near0(lambda z: (atan(sqrt(z)) / sqrt(z) - 1) / z), lambda z: z, 0, mpf("0.4476"), 7),
    "asin": (near0(lambda z: (asin(sqrt(z)) / sqrt(z) - 1) / z), lambda z: z, 0, mpf("0.2501"), 5),
    # in z = x^2: erf x = x + x P(z)
    "erf": (near0(lambda z: erf(sqrt(z)) / sqrt(z) - 1), lambda z: sqrt(z) / erf(sqrt(z)) if z > mpf("1e-9") else mpf(1),
            0, mpf("0.8467"), 8),
    # in t = (x-3)/(x+3): (1 + 2x) e^(x^2) erfc x
    "erfcx": (lambda t: (lambda x: (1 + 2 * x) * exp(x * x) * erfc(x))(3 * (1 + t) / (1 - t)), lambda t: mpf(1),
              (mpf("0.49") - 3) / (mpf("0.49") + 3), (mpf("10.3") - 3) / (mpf("10.3") + 3), 11),
}

if __name__ == "__main__":
    for name in sys.argv[1:] or FITS:
        fit(name, *FITS[name])
