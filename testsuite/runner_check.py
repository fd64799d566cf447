# SPDX-License-Identifier: Apache-2.0
"""Checks the runner: that it reads cases right, and above all that it fails where it must.

In: nothing; `render` is played by a small shell script. Out: exit status 0, or an assertion.
"""

import contextlib
import io
import os
import struct
import tempfile

import case
import check_includes
import expect
import pictures_check
import run

HEAD = "# rule: a rule\n# spec: RI 3.2, Spheres\n"


def parse(text):
    return case.Case("x.rib", text)


def check_head():
    parsed = parse("##RenderMan RIB-Structure 1.1\n" + HEAD + "# run one: render -t 1 {case}\n#   -silent\n"
                   "# expect: 1 == 1\n#\n# prose: not read after a blank line? it is a key\n" .replace(
                       "# prose: not read after a blank line? it is a key\n", "# plain prose\n") + "Format 1 1 1\n# run: no\n")
    assert parsed.runs() == [("one", "render -t 1 {case} -silent")], parsed.runs()
    assert parsed.many["expect"] == [(None, "1 == 1")]
    for bad in ("# rule: only\n", HEAD + "# expects: 1 == 1\n", HEAD + "# rule: twice\n"):
        try:
            parse(bad)
        except case.CaseError:
            continue
        raise AssertionError(f"accepted {bad!r}")
    assert case.Case("x.sl", "/* rule: r\n * spec: s\n */\nsurface x() {}\n").values == {"rule": "r", "spec": "s"}


def check_relations():
    names = expect.scope("/nowhere")
    assert expect.split_claim("f(a == 1, '< x') <= 2 +- 3 - 1") == ("f(a == 1, '< x')", "<=", "2", "3 - 1")
    for good in ("1 == 1", "vec(1, 2) == vec(1, 2.05) +- 0.1 | because", "1 < 2", "vec(1, 2) >= 1", "'a' != 'b'"):
        assert expect.check(good, names) is None, good
    for wrong in ("1 == 2", "vec(1, 2) == vec(1, 2.2) +- 0.1 | because", "2 < 1", "vec(0, 2) >= 1",
                  "float('nan') == 0 +- 1 | NaN is near nothing", "vec(1, 1) == vec(1, 1, 1)"):
        assert expect.check(wrong, names), wrong
    for broken in ("1", "1 == 1 +- 1", "missing_name == 1"):
        try:
            expect.check(broken, names)
        except expect.ExpectError:
            continue
        raise AssertionError(f"accepted {broken!r}")


def run_fake(text, script, name="x.rib"):
    """Runs a case with a shell script in place of render; returns (status, what was printed)."""
    with tempfile.TemporaryDirectory() as build:
        os.makedirs(os.path.join(build, "tracer"))
        program = os.path.join(build, "tracer", "render")
        with open(program, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + script + "\n")
        os.chmod(program, 0o755)
        raw = struct.pack("<12f", *([0.25, 0.5, 0.75] * 4))
        with open(os.path.join(build, "good.tif"), "wb") as file:
            file.write(pictures_check.make_tiff("<", 32, 3, 3, 2, 2, raw))
        path = os.path.join(build, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            status = run.run_case(path, build)
        return status, printed.getvalue()


def check_verdicts():
    copy = 'cp "$(dirname "$0")/../good.tif" out.tif'
    mean = '# expect: mean("out.tif") == vec(.25, .5, .75)\n'
    assert run_fake(HEAD + mean, copy)[0] == 0
    assert run_fake(HEAD + '# expect: centroid("out.tif") == vec(1, 1)\n', copy)[0] == 0
    assert run_fake(HEAD + '# expect: mean("out.tif").r == .3\n', copy)[0] == 1
    assert run_fake(HEAD + mean, "true")[0] == 1, "a missing picture must fail"
    assert run_fake(HEAD + mean, copy + "; exit 1")[0] == 1, "a wrong exit code must fail"
    assert run_fake(HEAD + mean, copy + '; echo "x.rib:3:1: warning: hm" >&2')[0] == 1, "unexpected message"
    assert run_fake(HEAD + mean, copy + '; echo "perigee: error: hm" >&2')[0] == 1, "unexpected message, no place"
    assert run_fake(HEAD + mean, copy + '; echo "==1==ERROR: AddressSanitizer: x" >&2')[0] == 1
    assert run_fake(HEAD + "# exit: 1\n", "kill -SEGV $$")[0] == 1, "a crash must fail"
    wanted = HEAD + "# exit: 1\n# message: x.rib:@here:\\d+: error: .*Sphere\nSphere 1 # @here\n"
    complain = 'echo "x.rib:5:8: error: Sphere: no" >&2; exit 1'
    assert run_fake(wanted, complain)[0] == 0
    assert run_fake(wanted, complain.replace(":5:", ":6:"))[0] == 1, "the line must be right"
    assert run_fake(wanted, "exit 1")[0] == 1, "an expected message must come"
    assert run_fake(HEAD + "# run: slc {case}\n# exit: 0\n", "true")[0] == run.SKIP, "missing program"
    both = "# run a: render\n# run b: render\n# expect: file_bytes('a/out.tif') == file_bytes('b/out.tif')\n"
    assert run_fake(HEAD + both, copy)[0] == 0


def check_rules():
    rules = check_includes.Rules("module low:\nmodule high: low\nmodule low/base:\nlibrary tiff: tiff | high\n")
    assert rules.may_include("high/a.cpp", "low/b.h") and not rules.may_include("low/a.cpp", "high/b.h")
    assert not rules.may_include("high/a.cpp", "low/base/b.h"), "a folder does not allow its sub-folders"
    users = {}
    problems = list(check_includes.check_file("high/a.h", "\n#include <tiffio.h>\n#include \"low/b.h\"\n", rules, users))
    assert problems == ["high/a.h:2: tiff named in a header"], problems
    problems = list(check_includes.check_file("low/a.cpp", '#include "high/b.h"\n', rules, users))
    assert problems == ["low/a.cpp:1: low may not include high/b.h"], problems


if __name__ == "__main__":
    check_head()
    check_relations()
    check_verdicts()
    check_rules()
