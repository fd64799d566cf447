# SPDX-License-Identifier: Apache-2.0
"""Gathers the results of the benchmarks into one table.

In: meson-logs/benchmarklog.json; a benchmark prints one JSON object a line, as docs/benchmarks.md describes; other
lines are kept as they are. Out: a Markdown table and these texts; with --write it replaces the one in docs/benchmarks.md. Exit status 1 if a benchmark failed
or missed its limit.
"""

import json
import os
import platform
import subprocess
import sys

BEGIN, END = "<!-- results -->", "<!-- end of results -->"
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def results(path):
    """(rows, texts, failures): JSON results, what other benchmarks printed, names of those that failed."""
    rows, texts, failures = [], [], []
    with open(path, encoding="utf-8") as file:
        for entry in map(json.loads, filter(str.strip, file)):
            other = []
            for line in (entry.get("stdout") or "").splitlines():
                result = parse(line)
                (rows if result else other).append(result or line)
            if any(map(str.strip, other)):
                texts.append((entry["name"], "\n".join(other).strip("\n")))
            if entry["result"] != "OK":
                failures.append(entry["name"])
    return rows, texts, failures


def parse(line):
    """The result on a line, or None."""
    try:
        result = json.loads(line)
    except ValueError:
        return None
    return result if isinstance(result, dict) and {"name", "value", "unit"} <= result.keys() else None


def verdict(result):
    """"" without a limit, else whether it is kept."""
    limit = result.get("limit")
    if limit is None:
        return ""
    higher = result.get("better", "higher") == "higher"
    return "yes" if (result["value"] >= limit if higher else result["value"] <= limit) else "no"


def row(result):
    sign = {"higher": "at least ", "lower": "at most "}[result.get("better", "higher")]
    limit = sign + f"{result['limit']:g}" if result.get("limit") is not None else ""
    return (f"| {result['name']} | {result['value']:.4g} {result['unit']} | {limit} | {result.get('error', '')} | "
            f"{result.get('note', '')} | {verdict(result)} |")


def machine():
    model = platform.machine()
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.partition(":")[2].strip()
                break
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True,
                            check=False).stdout.strip()
    return f"{model}, {os.cpu_count()} threads, commit {commit}"


def main(path, *options):
    rows, texts, failures = results(path)
    lines = [machine(), ""]
    if rows:
        lines += ["| what | measured | limit | error | note | kept |", "|---|---|---|---|---|---|", *map(row, rows), ""]
    for name, text in texts:
        lines += [f"`{name}`:", "", "```", text, "```", ""]
    lines += [f"Failed or missed its limit: {name}." for name in failures]
    text = "\n".join(lines).rstrip()
    print(text)
    if "--write" in options:
        document = os.path.join(ROOT, "docs", "benchmarks.md")
        with open(document, encoding="utf-8") as file:
            before, _, rest = file.read().partition(BEGIN)
        after = rest.partition(END)[2]
        with open(document, "w", encoding="utf-8") as file:
            file.write(f"{before}{BEGIN}\n{text}\n{END}{after}")
    return 1 if failures or any(verdict(result) == "no" for result in rows) else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
