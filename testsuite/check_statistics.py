#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the tables of docs/statistics.md are those of tracer/stats.def; --fix writes them."""

import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TABLE, PAGE = os.path.join(ROOT, "tracer", "stats.def"), os.path.join(ROOT, "docs", "statistics.md")
BEGIN, END = "<!-- rows -->\n", "<!-- end of rows -->\n"
ROW = re.compile(r'^TRACE_(\w+)\((\w+),\s*(?:(\w+),\s*)?"([^"]*)"\)$', re.MULTILINE)
NOTES = {"RATE": ", also per second", "MAX": " (of several frames the largest)"}
KINDS = {"PHASE": "seconds", "PART": "parts", "COUNTER": "counters", "AMOUNT": "amounts", "SHADER": "shaders"}


def tables():
    with open(TABLE, encoding="utf-8") as file:
        rows = ROW.findall(file.read())
    text = ""
    for kind, key in KINDS.items():
        text += f"\n| {key} | |\n|---|---|\n"
        text += "".join(f"| `{name}` | {words}{NOTES.get(note, '')} |\n" for k, name, note, words in rows if k == kind)
    return text + "\n"


def main():
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    head, rest = page.split(BEGIN)
    tail = rest.split(END)[1]
    wanted = head + BEGIN + tables() + END + tail
    if wanted == page:
        print("docs/statistics.md: the tables of stats.def")
        return 0
    if "--fix" in sys.argv[1:]:
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(wanted)
        return 0
    print("docs/statistics.md differs from tracer/stats.def; testsuite/check_statistics.py --fix writes its tables")
    return 1


if __name__ == "__main__":
    sys.exit(main())
