#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a text file into C++ string literals, to be included where a string is expected.

usage: embed_text.py INPUT OUTPUT
"""

import sys


def literal(line):
    escaped = line.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
    return f'"{escaped}"'


def main(source, target):
    with open(source, encoding="utf-8", newline="\n") as file:
        lines = file.readlines()
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(map(literal, lines)) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
