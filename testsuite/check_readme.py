#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the first shader and scene of README.md as a reader would.

In: the fenced blocks of README.md that follow a line "`file name`:". Out: exit status 0 if `render` makes the
picture without a word and it is neither empty nor flat; 77 while there is no `render`.
"""

import os
import re
import subprocess
import sys
import tempfile

import pictures
import run

BLOCK = re.compile(r"^`([\w.]+)`:\n```\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def main():
    build = os.path.abspath(os.environ.get("PERIGEE_BUILD", os.path.join(run.ROOT, "build")))
    try:
        program = run.find_program("render", build)
    except run.Skip as reason:
        print(f"skipped README: {reason}")
        return run.SKIP
    with open(os.path.join(run.ROOT, "README.md"), encoding="utf-8") as file:
        files = dict(BLOCK.findall(file.read()))
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        done = subprocess.run([program, "ball.rib"], cwd=folder, env=run.environment(build, folder),
                              capture_output=True, text=True, check=False, timeout=100)
        print(done.stdout + done.stderr, end="")
        picture = pictures.read_picture(os.path.join(folder, "ball.png"))
    shades = {tuple(picture.at(x, picture.height // 2)) for x in range(picture.width)}
    if done.returncode or done.stderr or len(shades) < 20:
        print(f"exit code {done.returncode}, {len(shades)} colours across the middle")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
