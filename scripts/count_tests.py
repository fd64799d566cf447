# SPDX-License-Identifier: Apache-2.0
"""Summarises a Meson test run.

In: a JSON log of meson test. Out: what failed and why, what was skipped and why, and as the last line
"N passed, N failed[, N skipped]"; exit status 1 if any test failed or none ran.
"""

import collections
import json
import sys


def kind(result):
    if result in ("OK", "EXPECTEDFAIL"):
        return "passed"
    return "skipped" if result == "SKIP" else "failed"


def reason(entry):
    """The last lines a failed test printed."""
    text = (entry.get("stdout") or "") + (entry.get("stderr") or "")
    return "\n".join("    " + line for line in text.rstrip().splitlines()[-25:])


def main(path):
    tests = []
    try:
        with open(path, encoding="utf-8") as file:
            tests = [json.loads(line) for line in file if line.strip()]
    except OSError as error:
        print(f"no test ran: {error}")
    counts = collections.Counter()
    skips = collections.Counter()
    for entry in tests:
        verdict = kind(entry["result"])
        counts[verdict] += 1
        if verdict == "failed":
            print(f"FAILED {entry['name']} ({entry['result']}, {entry['duration']:.1f} s)\n{reason(entry)}")
        elif verdict == "skipped":
            lines = (entry.get("stdout") or "").strip().splitlines() or ["no reason given"]
            skips[lines[-1].partition(": ")[2] or lines[-1]] += 1
    for text, count in sorted(skips.items()):
        print(f"skipped {count}: {text}")
    summary = f"{counts['passed']} passed, {counts['failed']} failed"
    print(summary + (f", {counts['skipped']} skipped" if counts["skipped"] else ""))
    return 1 if counts["failed"] or not counts["passed"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
