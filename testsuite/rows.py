# SPDX-License-Identifier: Apache-2.0
"""Which rows of the tables have a conformance case.

In: the .def tables and the text of the cases. Out: for each table, the rows no case mentions. A request counts
when a case gives it, a built-in when a case or a case's shader calls it.
"""

import os
import re

ROW = re.compile(r"^\w+\(\s*\"?(\w+)", re.MULTILINE)
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


def table_names(path):
    """First cells, in file order, without repeats; [] while the table does not exist."""
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8") as file:
        text = COMMENT.sub("", file.read())
    text = "\n".join(line for line in text.splitlines() if "SL_HIDDEN" not in line)  # no user can call those
    return list(dict.fromkeys(ROW.findall(text)))


def texts(root, suffixes):
    for folder, _, files in os.walk(root):
        for name in files:
            if name.endswith(suffixes):
                with open(os.path.join(folder, name), encoding="utf-8", errors="replace") as file:
                    yield file.read()


def uncovered(root):
    """{table: (rows without a case, number of rows)}"""
    suite = os.path.join(root, "testsuite")
    rib = "\n".join(texts(suite, (".rib",)))
    sl = "\n".join(texts(suite, (".sl",)))
    rib = re.sub(r'#[^\n]*|"[^"\n]*"', "", rib)  # comments and strings name requests without giving them
    used = {"requests": lambda name: re.search(rf"\b{name}\b", rib),
            "builtins": lambda name: re.search(rf"\b{name}\s*\(", sl)}
    tables = {"requests": os.path.join(root, "ribtools", "ri_requests.def"),
              "builtins": os.path.join(root, "runtime", "abi", "sl_builtins.def")}
    report = {}
    for table, path in tables.items():
        names = table_names(path)
        report[table] = ([name for name in names if not used[table](name)], len(names))
    return report


def print_uncovered(root):
    for table, (missing, total) in uncovered(root).items():
        print(f"{table}: {total - len(missing)} of {total} have a case")
        for name in missing:
            print(f"  {name}")
    return 0
