#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the suite itself: every case parses, states rule and section, and is registered with Meson.

In: --cases N, the number Meson registered. Out: one line per problem.
"""

import argparse
import os
import sys

import case
import run


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, required=True)
    registered = parser.parse_args().cases
    problems = []
    paths = run.find_cases()
    if len(paths) != registered:
        problems.append(f"{len(paths)} case files, {registered} registered: run meson setup --reconfigure")
    for path in paths:
        try:
            loaded = case.load(os.path.join(run.HERE, path))
        except case.CaseError as error:
            problems.append(str(error))
            continue
        codes = loaded.per_run["exit"]
        if not loaded.many["expect"] and not loaded.many["message"] and not codes and not loaded.many["output"]:
            problems.append(f"{path}: expects nothing")
    print("\n".join(problems) or f"{len(paths)} cases")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
