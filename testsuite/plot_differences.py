#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables and plots of docs/derivatives.md.

In: a build folder (its programs difference_study and surface_difference_study print JSON lines with --all), and where the
pictures go. Out: two SVG files, and Markdown tables on standard output. Needs python3-matplotlib for the pictures only.

    testsuite/plot_differences.py build docs/pictures
"""

import json
import os
import subprocess
import sys

GOAL = 1e-3
STEPS = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1]
POSITIONS = [1, 10, 100, 1e3, 1e4, 1e5, 1e6]
METHODS = [("values", "float values", "tab:red"), ("duals", "dual numbers", "tab:orange"),
           ("propagated", "propagated", "tab:blue")]


def rows_of(program):
    text = subprocess.run([program, "--all"], check=True, capture_output=True, text=True).stdout
    return [json.loads(line) for line in text.splitlines() if line.startswith("{")]


def names_of(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def number(x):
    return "0" if x == 0 else f"{x:.0e}".replace("e-0", "e-").replace("e+0", "e")


def expression_table(rows):
    print("| expression | values | duals | propagated | worst at | share of cells above 1e-3: values, duals, propagated |")
    print("|---|---|---|---|---|---|")
    for name in names_of(rows, "expression"):
        mine = [row for row in rows if row["expression"] == name]
        worst = {m: max(mine, key=lambda row, m=m: row[m]) for m, _, _ in METHODS}
        share = [sum(row[m] > GOAL for row in mine) for m, _, _ in METHODS]
        at = worst["propagated"]
        print(f"| {name} | {number(worst['values']['values'])} | {number(worst['duals']['duals'])} | "
              f"{number(at['propagated'])} | {number(at['position'])}, {number(at['step'])} | "
              f"{share[0]}, {share[1]}, {share[2]} of {len(mine)} |")


def truncation_table(rows):
    print("| expression | " + " | ".join(f"step {number(s)}" for s in STEPS) + " |")
    print("|---|" + "---|" * len(STEPS))
    for name in names_of(rows, "expression"):
        cells = [row["truncation"] for s in STEPS for row in rows
                 if row["expression"] == name and row["position"] == 1 and row["step"] == s]
        print(f"| {name} | " + " | ".join(number(c) for c in cells) + " |")


def surface_table(rows):
    print("| surface | P | N | s, t | varying colour | worst place of N |")
    print("|---|---|---|---|---|---|")
    for name in names_of(rows, "surface"):
        mine = [row for row in rows if row["surface"] == name]
        worst = {k: max(row[k] for row in mine) for k in ("P", "N", "st", "Cs")}
        place = max(mine, key=lambda row: row["N"])["place"]
        print(f"| {name} | {number(worst['P'])} | {number(worst['N'])} | {number(worst['st'])} | "
              f"{number(worst['Cs'])} | {place} |")


def plot_expressions(plt, rows, path):
    names = names_of(rows, "expression")
    figure, axes = plt.subplots(3, 5, figsize=(14, 8), sharex=True, sharey=True)
    for name, axis in zip(names, axes.flat):
        for method, label, color in METHODS:
            for position in POSITIONS:
                line = [row[method] for s in STEPS for row in rows
                        if row["expression"] == name and row["position"] == position and row["step"] == s]
                shade = 0.25 + 0.75 * POSITIONS.index(position) / (len(POSITIONS) - 1)
                axis.loglog(STEPS, [max(x, 1e-9) for x in line], color=color, alpha=shade, linewidth=1,
                            label=label if position == POSITIONS[-1] else None)
        axis.axhline(GOAL, color="0.4", linewidth=0.8, linestyle="--")
        axis.set_title(name, fontsize=10)
        axis.set_ylim(1e-9, 1e3)
    for axis in list(axes.flat)[len(names):]:
        axis.axis("off")
    axes.flat[0].legend(fontsize=8)
    figure.supxlabel("step")
    figure.supylabel("error of the difference, 99 % of points (pale: position 1, full: position 1e6)")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def plot_surfaces(plt, rows, path):
    names = names_of(rows, "surface")
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.5), sharey=True)
    for key, axis in zip(("P", "N"), axes):
        for name in names:
            line = [max(max(row[key] for row in rows if row["surface"] == name and row["step"] == s), 1e-9)
                    for s in STEPS]
            axis.loglog(STEPS, line, label=name, linewidth=1.2)
        axis.axhline(GOAL, color="0.4", linewidth=0.8, linestyle="--")
        axis.set_title(f"{key}: worst point of all places and positions", fontsize=10)
        axis.set_xlabel("step of u or v")
    axes[0].set_ylabel("error of the difference")
    axes[1].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    if len(sys.argv) != 3:
        print(__doc__)
        return 2
    build, pictures = sys.argv[1:]
    expressions = rows_of(os.path.join(build, "runtime/lib/difference_study"))
    surfaces = rows_of(os.path.join(build, "geometry/surface_difference_study"))
    expression_table(expressions)
    print()
    truncation_table(expressions)
    print()
    surface_table(surfaces)
    try:
        import matplotlib
    except ImportError:
        print("no pictures: python3-matplotlib is not installed", file=sys.stderr)
        return 3
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "perigee"
    import matplotlib.pyplot as plt
    plot_expressions(plt, expressions, os.path.join(pictures, "differences_expressions.svg"))
    plot_surfaces(plt, surfaces, os.path.join(pictures, "differences_surfaces.svg"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
