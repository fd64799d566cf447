#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that C and C++ sources look as clang-format leaves them (.clang-format at the top; .def tables and the
Shading Language of shaders/headers are exempt).

In: the tree; `--fix` rewrites instead. Out: one line per file that differs; exit status 77 where there is no
clang-format.
"""

import os
import shutil
import subprocess
import sys

import check_includes


def main():
    program = shutil.which("clang-format")
    if program is None:
        print("skipped: clang-format is not installed")
        return 77
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    files = [path for path in check_includes.source_files(root, (".h", ".c", ".cpp"))
             if not path.startswith("shaders/headers/")]
    if "--fix" in sys.argv[1:]:
        return subprocess.run([program, "-i", *files], cwd=root, check=False).returncode
    done = subprocess.run([program, "--dry-run", "-Werror", *files], cwd=root, capture_output=True, text=True,
                          check=False)
    wrong = sorted({line.split(":")[0] for line in done.stderr.splitlines() if ": error: " in line})
    for path in wrong:
        print(f"{path}: not formatted (clang-format -i, or testsuite/check_format.py --fix)")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
