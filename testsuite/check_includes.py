#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the shape of the sources: include direction, outside libraries, file length, licence line.

In: deps.txt and the C and C++ files of the tree. Out: one line per violation, exit status 1 if there is any.
Unit tests (*_test.cpp) and benchmarks (*_bench.cpp) may include their own module and everything below it, like
other files, but do not count for the one-file rule of outside libraries.
"""

import os
import re
import sys

SUFFIXES = (".h", ".c", ".cpp", ".def")
LICENSED = SUFFIXES + (".py", ".sl", ".rib")
MAX_LINES = 1000
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]', re.MULTILINE)
SKIPPED = re.compile(r"^(build|dist|\.)")


class Rules:
    """deps.txt, parsed."""

    def __init__(self, text):
        self.modules, self.files, self.libraries, self.shared = {}, {}, {}, set()
        for number, line in enumerate(text.splitlines(), 1):
            line = line.split("#")[0].strip()
            if line:
                self.add(line, number)

    def add(self, line, number):
        kind, _, rest = line.partition(" ")
        name, _, value = rest.partition(":")
        name = name.strip()
        if kind == "module":
            self.modules[name] = set(value.split())
        elif kind == "file":
            self.files[name] = set(value.split())
        elif kind == "library":
            prefixes, _, users = value.partition("|")
            self.libraries[name] = (tuple(prefixes.split()), set(users.split()))
        elif kind == "shared":
            self.shared.add(name)
        else:
            raise SystemExit(f"deps.txt:{number}: unknown row '{line}'")

    def module_of(self, path):
        """The longest listed folder that holds the path, or None."""
        folder = os.path.dirname(path)
        while folder and folder not in self.modules:
            folder = os.path.dirname(folder)
        return folder or None

    def may_include(self, path, included):
        module, target = self.module_of(path), self.module_of(included)
        if target is None or module == target:
            return True
        allowed = self.modules[module] | self.files.get(path, set())
        return target in allowed or included in allowed

    def library_of(self, header):
        for name, (prefixes, _) in self.libraries.items():
            if header.startswith(prefixes):
                return name
        return None


def source_files(root, suffixes):
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if not SKIPPED.match(f) and f != "__pycache__")
        for name in sorted(files):
            if name.endswith(suffixes):
                yield os.path.relpath(os.path.join(folder, name), root)


def is_test(path):
    return re.search(r"_(test|bench|fuzz)\.(c|cpp)$", path) is not None


def check_text(path, text):
    """Length and licence line."""
    lines = text.count("\n") + 1
    if path.endswith(SUFFIXES) and lines > MAX_LINES:
        yield f"{path}: {lines} lines, at most {MAX_LINES}"
    if "SPDX-License-Identifier: Apache-2.0" not in "\n".join(text.split("\n", 6)[:6]):
        yield f"{path}: no SPDX licence line at the top"


def check_file(path, text, rules, users):
    """Include direction; collects the users of outside libraries."""
    module = rules.module_of(path)
    if module is None:
        return
    for match in INCLUDE.finditer(text):
        bracket, header = match.groups()
        place = f"{path}:{text.count(chr(10), 0, match.start() + 1) + 1}"
        if bracket == '"' and not rules.may_include(path, header):
            yield f"{place}: {module} may not include {header}"
        library = rules.library_of(header) if bracket == "<" else None
        if library and not is_test(path):
            users.setdefault((library, module), set()).add(path)
            if module not in rules.libraries[library][1]:
                yield f"{place}: {module} may not use {library}"
            elif path.endswith(".h") and path not in rules.shared:
                yield f"{place}: {library} named in a header"


def check_tree(root, rules):
    users = {}
    for path in source_files(root, LICENSED):
        with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
            text = file.read()
        yield from check_text(path, text)
        if path.endswith(SUFFIXES):
            yield from check_file(path, text, rules, users)
    for (library, module), paths in sorted(users.items()):
        paths -= rules.shared
        if len(paths) > 1:
            yield f"{library} is named in more than one file of {module}: {', '.join(sorted(paths))}"


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, "deps.txt"), encoding="utf-8") as file:
        rules = Rules(file.read())
    problems = list(check_tree(os.path.dirname(here), rules))
    print("\n".join(problems) if problems else "sources: include direction, libraries, length, licence: fine")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
