# SPDX-License-Identifier: Apache-2.0
"""Reads the head comment of a conformance case.

In: a RIB, SL or Python-free text file that opens with `# key: value` lines (`//` or ` * ` in SL).
Out: a Case. The keys are described in testsuite/README.md; an unknown key is an error, so that a misspelt
expectation cannot pass unnoticed.
"""

import re

RUN_KEYS = {"run", "exit", "append"}
ONE_KEYS = {"rule", "spec", "timeout", "memory", "needs", "scene", "later"}
MANY_KEYS = {"expect", "let", "message", "output", "quiet"}
KEY_LINE = re.compile(r"^([a-z]+)(?: ([A-Za-z_]\w*))?:(?: (.*)|)$")


class CaseError(Exception):
    """The head comment is malformed."""


class Case:
    def __init__(self, path, text):
        self.path = path
        self.text = text
        self.values = {}                                  # ONE_KEYS
        self.many = {key: [] for key in MANY_KEYS}        # in file order
        self.per_run = {key: {} for key in RUN_KEYS}      # by run name, "main" if none is given
        for key, name, value in head_entries(text):
            self.add(key, name, value)
        for key in ("rule", "spec"):
            if key not in self.values:
                raise CaseError(f"{path}: no '{key}:' line")

    def add(self, key, name, value):
        if key in RUN_KEYS:
            self.per_run[key][name or "main"] = value
        elif key in ONE_KEYS and key not in self.values and not name:
            self.values[key] = value
        elif key in MANY_KEYS:
            self.many[key].append((name, value))
        else:
            raise CaseError(f"{self.path}: '{key}{' ' + name if name else ''}:' is unknown or given twice")

    def runs(self):
        """(name, command) in file order; `render {case}` or, for SL, `slc {case}` when none is given."""
        default = "render {scene}" if "scene" in self.values else \
            "slc {case}" if self.path.endswith(".sl") else "render {case}"
        return list(self.per_run["run"].items()) or [("main", default)]

    def exit_codes(self, run):
        codes = self.per_run["exit"]
        return {int(code) for code in codes.get(run, codes.get("main", "0")).split(" or ")}

    def timeout_seconds(self):
        return float(self.values.get("timeout", "60"))


def head_lines(text):
    """The leading comment block, without comment signs. `##` lines are RIB structure comments."""
    for line in text.splitlines():
        stripped = line.strip()
        if stripped.startswith("##") or stripped in ("/*", "*/"):
            continue
        match = re.match(r"(#|//|/\*|\*)(?: ?)(.*?)(?:\*/)?$", stripped)
        if not match:
            return
        yield match.group(2).rstrip()


def head_entries(text):
    """Joins continuation lines (indented) and splits the keys off."""
    entry = None
    for line in head_lines(text):
        match = KEY_LINE.match(line)
        if match:
            if entry:
                yield entry
            entry = (match.group(1), match.group(2), match.group(3) or "")
        elif line.startswith("  ") and entry:
            entry = (entry[0], entry[1], (entry[2] + " " + line.strip()).strip())
        elif entry:
            yield entry
            entry = None
    if entry:
        yield entry


def load(path):
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        return Case(path, file.read())
