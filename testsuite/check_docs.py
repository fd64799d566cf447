#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the documentation against the tree: every file it names exists, every citation key resolves.

In: README.md, the other Markdown files, and the comments of the sources. Out: one line per broken reference.
A file reference is a relative Markdown link, or `folder/name.suffix` in backquotes whose first part is a
top-level folder. Citation keys look like [Cohen88] and must have an entry in REFERENCES.md.
"""

import os
import re
import sys

import check_includes

LINK = re.compile(r"\]\((?!https?:|#|mailto:)([^)\s#]+)(?:#[^)]*)?\)")
QUOTED = re.compile(r"`([\w.-]+(?:/[\w.{},*-]+)+)`")
KEY = re.compile(r"\[([A-Z][a-z]+\d{2}[a-z]?|pbrt\d)\]")
GENERATED = ("build", "dist")


def expand(name):
    """`a/{b,c}.h` names two files."""
    match = re.match(r"(.*)\{([^}]*)\}(.*)$", name)
    return [match[1] + part + match[3] for part in match[2].split(",")] if match else [name]


def check_markdown(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        text = file.read()
    folder = os.path.dirname(path)
    for match in LINK.finditer(text):
        if not os.path.exists(os.path.join(root, folder, match[1])):
            yield f"{path}: link to {match[1]}, which does not exist"
    for match in QUOTED.finditer(text):
        for name in expand(match[1]):
            top = name.split("/")[0]
            if "*" in name or top in GENERATED or not os.path.isdir(os.path.join(root, top)):
                continue
            if not any(os.path.exists(os.path.join(root, base, name)) for base in ("", folder)):
                yield f"{path}: {name} does not exist"


def known_keys(root):
    with open(os.path.join(root, "REFERENCES.md"), encoding="utf-8") as file:
        return set(re.findall(r"^\*\*\[(\w+)\]\*\*", file.read(), re.MULTILINE))


def check_citations(root, keys):
    for path in check_includes.source_files(root, (".h", ".c", ".cpp", ".def", ".sl")):
        with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
            for number, line in enumerate(file, 1):
                comment = line.partition("//")[2] if "//" in line else line if line.lstrip().startswith("*") else ""
                for match in KEY.finditer(comment):
                    if match[1] not in keys:
                        yield f"{path}:{number}: [{match[1]}] is not in REFERENCES.md"


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    problems = list(check_citations(root, known_keys(root)))
    for path in check_includes.source_files(root, (".md",)):
        problems += check_markdown(root, path)
    print("\n".join(problems) or "documentation: every reference resolves")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
