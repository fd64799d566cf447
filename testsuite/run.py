#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs conformance cases: small RIB or SL files whose head comment holds rule, section and expectation.

In: case files (or --list-cases, --list). Out: one line per case; exit status 0 passed, 1 failed, 77 skipped.
Every run happens in its own scratch folder, so cases may run side by side. See testsuite/README.md.
"""

import argparse
import os
import re
import resource
import shlex
import shutil
import subprocess
import sys

import case as case_format
import expect
import pictures
import rows

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
SKIP = 77
MESSAGE = re.compile(r"^(?:(?P<place>[^\s:]+(?::byte \d+|(?::\d+){0,2})): )(?P<severity>info|warning|error|severe): (?P<text>.*)$")
SANITIZER = re.compile(r"ERROR: \w+Sanitizer|WARNING: ThreadSanitizer|runtime error: |LeakSanitizer")


class Skip(Exception):
    """The case cannot run here; the text says why."""


class Failure(Exception):
    """The case ran and was wrong."""


def find_program(name, build):
    for folder in ("tracer", "slc", "ribtools", os.path.join("dist", "bin"), "bin"):
        path = os.path.join(build, folder, name)
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    raise Skip(f"the program '{name}' is not built")


def find_cases():
    found = []
    for folder, folders, files in os.walk(os.path.join(HERE, "cases")):
        folders.sort()
        found += [os.path.join(folder, name) for name in sorted(files) if name.endswith((".rib", ".sl"))]
    return [os.path.relpath(path, HERE) for path in found]


def environment(build, folder):
    """Shaders come from the build and from testsuite/shaders; nothing of the user's own set-up takes part."""
    env = {key: value for key, value in os.environ.items()
           if key not in ("SHADERS", "TEXTURES", "ARCHIVES", "BMRTHOME")}
    env["SHADERS"] = os.pathsep.join([os.path.join(build, "shaders"), os.path.join(HERE, "shaders"),
                                      os.path.join(folder, "shaders")])
    env["PERIGEE_CACHE"] = os.path.join(build, "testsuite", "cache")
    env["HOME"] = folder
    env["LC_ALL"] = "C"
    return env


# The scenes an SL case may ask for with `scene:`: its shader on a flat plate that fills a float picture.
PLATE = """Display "out.tif" "tiff" "rgba"
Quantize "rgba" 0 0 0 0
Format {size} {size} 1
PixelSamples 1 1
PixelFilter "box" 1 1
ScreenWindow -1 1 -1 1
Clipping .5 4.5
Projection "orthographic"
Translate 0 0 2
WorldBegin
{light}
Surface "{shader}"
Patch "bilinear" "P" [-1 1 0  1 1 0  -1 -1 0  1 -1 0]
WorldEnd
"""


class Runner:
    def __init__(self, case, build):
        self.case = case
        self.build = build
        name = os.path.relpath(os.path.abspath(case.path), HERE).replace(os.sep, "-")
        self.folder = os.path.join(build, "testsuite", "scratch", name)
        self.stderr = []
        self.stdout = []

    def prepare(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(os.path.join(self.folder, "shaders"))
        os.makedirs(os.path.join(self.build, "testsuite", "cache"), exist_ok=True)
        data = self.case.text.encode("utf-8", "surrogateescape")
        append = self.case.per_run["append"].get("main")
        if append:
            extra = eval(append, {"__builtins__": {}, "range": range, "bytes": bytes, "str": str})
            data += extra if isinstance(extra, bytes) else extra.encode()
        self.file = os.path.join(self.folder, os.path.basename(self.case.path))
        with open(self.file, "wb") as file:
            file.write(data)
        if "scene" in self.case.values:
            self.prepare_scene(self.case.values["scene"])

    def prepare_scene(self, text):
        """`plate [size] [| light requests]`: see PLATE."""
        kind, _, light = text.partition("|")
        words = kind.split()
        if words[:1] != ["plate"]:
            raise case_format.CaseError(f"scene '{text}' is unknown")
        shader = os.path.splitext(os.path.basename(self.case.path))[0]
        shutil.copy(self.file, os.path.join(self.folder, "shaders", shader + ".sl"))
        shutil.copy(os.path.join(HERE, "shaders", "check.h"), os.path.join(self.folder, "shaders"))
        with open(os.path.join(self.folder, "scene.rib"), "w", encoding="utf-8") as file:
            file.write(PLATE.format(size=(words + ["8"])[1], light=light.strip(), shader=shader))

    def command(self, text, name):
        places = {"case": self.file, "scene": os.path.join(self.folder, "scene.rib"), "root": ROOT,
                  "cases": os.path.dirname(os.path.abspath(self.case.path)), "build": self.build}
        words = [word.format(**places) for word in shlex.split(text)]
        stdin = None
        for i, word in enumerate(words):
            if word == "<":
                stdin = words[i + 1]
                del words[i:i + 2]
                break
        return [find_program(words[0], self.build)] + words[1:], stdin

    def run(self, name, text):
        words, stdin = self.command(text, name)
        folder = os.path.join(self.folder, name)
        os.makedirs(folder)
        source = open(stdin, "rb") if stdin else subprocess.DEVNULL
        try:
            done = subprocess.run(words, cwd=folder, stdin=source, capture_output=True, check=False,
                                  env=environment(self.build, self.folder),
                                  timeout=self.case.timeout_seconds() * float(os.environ.get("CASE_SLOWER", "1")))
        except subprocess.TimeoutExpired as error:
            raise Failure(f"{name}: no end after {error.timeout:g} s") from error
        finally:
            if stdin:
                source.close()
        self.stderr += done.stderr.decode("utf-8", "replace").splitlines()
        self.stdout += done.stdout.decode("utf-8", "replace").splitlines()
        self.check_exit(name, done.returncode)

    def check_exit(self, name, code):
        if code < 0:
            raise Failure(f"{name}: killed by signal {-code}")
        for line in self.stderr:
            if SANITIZER.search(line):
                raise Failure(f"{name}: {line}")
        wanted = self.case.exit_codes(name)
        if code not in wanted:
            raise Failure(f"{name}: exit code {code}, expected {' or '.join(map(str, sorted(wanted)))}")

    def check_messages(self):
        """Every warning and error must be expected, and every expected one must come."""
        messages = [line for line in self.stderr if is_problem(line)]
        for _, pattern in self.case.many["message"]:
            pattern = self.mark_lines(pattern)
            if not any(re.search(pattern, line) for line in self.stderr):
                raise Failure(f"no message matches /{pattern}/")
            messages = [line for line in messages if not re.search(pattern, line)]
        quiet = [self.mark_lines(pattern) for _, pattern in self.case.many["quiet"]]
        messages = [line for line in messages if not any(re.search(pattern, line) for pattern in quiet)]
        if messages:
            raise Failure(f"unexpected message: {messages[0]}")
        for _, pattern in self.case.many["output"]:
            if not any(re.search(pattern, line) for line in self.stdout):
                raise Failure(f"no line of standard output matches /{pattern}/")

    def mark_lines(self, pattern):
        """`@name` in a message pattern stands for the number of the line that carries `# @name`."""
        for number, line in enumerate(self.case.text.splitlines(), 1):
            for mark in re.findall(r"(?:#|//) (@\w+)$", line.strip()):
                pattern = re.sub(re.escape(mark) + r"\b", str(number), pattern)
        return pattern

    def check_expectations(self):
        names = expect.scope(self.folder)
        names["output"], names["messages"] = self.stdout, self.stderr
        for _, text in self.case.many["let"]:
            expect.assign(text, names)
        problems = [expect.check(text, names) for _, text in self.case.many["expect"]]
        problems = [problem for problem in problems if problem]
        if problems:
            raise Failure("\n    ".join(problems))

    def check_memory(self):
        limit = self.case.values.get("memory")
        if limit and "SANITIZE" not in os.environ:
            peak_mb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
            if peak_mb > float(limit.split()[0]):
                raise Failure(f"used {peak_mb:.0f} MB, expected at most {limit}")

    def execute(self):
        if "later" in self.case.values:
            raise Skip(f"waits for {self.case.values['later']}")
        for name in self.case.values.get("needs", "").split():
            find_program(name, self.build)
        for _, text in self.case.runs():
            find_program(shlex.split(text)[0], self.build)
        self.prepare()
        for name, text in self.case.runs():
            self.run(name, text)
        self.check_messages()
        self.check_expectations()
        self.check_memory()


def is_problem(line):
    match = MESSAGE.match(line)
    return bool(match) and match.group("severity") != "info"


def run_case(path, build):
    """Prints one line; returns the exit status."""
    name = os.path.relpath(os.path.abspath(path), HERE)
    try:
        runner = Runner(case_format.load(path), build)
    except case_format.CaseError as error:
        print(f"FAILED  {error}")
        return 1
    try:
        runner.execute()
    except Skip as reason:
        print(f"skipped {name}: {reason}")
        return SKIP
    except (Failure, case_format.CaseError, expect.ExpectError, pictures.PictureError) as problem:
        print(f"FAILED  {name}: {runner.case.values['rule']}\n    {problem}")
        print(f"    files: {runner.folder}")
        for line in runner.stderr[:20]:
            print(f"    stderr: {line}")
        return 1
    print(f"passed  {name}")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.environ.get("PERIGEE_BUILD", os.path.join(ROOT, "build")),
                        help="build folder (default: build)")
    parser.add_argument("--list-cases", action="store_true", help="print the case files")
    parser.add_argument("--list", action="store_true", help="print table rows that no case uses")
    parser.add_argument("cases", nargs="*", help="case files; none: all of them")
    options = parser.parse_args()
    if options.list_cases:
        print("\n".join(find_cases()))
        return 0
    if options.list:
        return rows.print_uncovered(ROOT)
    build = os.path.abspath(options.build)
    paths = options.cases or [os.path.join(HERE, name) for name in find_cases()]
    results = [run_case(path, build) for path in paths]
    if len(paths) > 1:
        skipped = results.count(SKIP)
        print(f"{results.count(0)} passed, {len(results) - results.count(0) - skipped} failed, {skipped} skipped")
        return 1 if any(code not in (0, SKIP) for code in results) else 0
    return results[0]


if __name__ == "__main__":
    sys.exit(main())
