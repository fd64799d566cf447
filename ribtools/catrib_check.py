#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""catrib as a program: forms, switches, exit codes, what is left behind when something fails.

In: the path of catrib. Out: one line per failure; what the conversions themselves do is tested in rib_write_test.cpp.
"""

import gzip
import os
import re
import subprocess
import sys
import tempfile

CATRIB = os.path.abspath(sys.argv[1])
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "catrib_options.def")
failures = []


def run(*arguments, data=b""):
    result = subprocess.run([CATRIB, *arguments], input=data, capture_output=True, timeout=60)
    return result.returncode, result.stdout, result.stderr.decode(errors="replace")


def check(holds, what):
    if not holds:
        failures.append(what)


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def read(path):
    with open(path, "rb") as file:
        return file.read()


TEXT = b"##RenderMan RIB-Structure 1.1\nFormat 640 480 1\nTranslate 0.1 -0 1e-40\n"


def forms():
    check(run(data=TEXT) == (0, TEXT, ""), "text from standard input to standard output")
    check(run("-", data=TEXT)[1] == TEXT, "- is standard input")
    code, binary, said = run("--binary", data=TEXT)
    check(code == 0 and b"\xa6" in binary and not said, "binary")
    check(run("--text", data=binary)[1] == TEXT, "binary to text")
    code, packed, _ = run("--gzip", "--binary", data=TEXT)
    check(gzip.decompress(packed) == binary, "gzip: its own and Python's agree")
    check(run(data=packed)[1] == TEXT, "gzipped binary from standard input")
    check(run(data=gzip.compress(TEXT[:40]) + gzip.compress(TEXT[40:]))[1] == TEXT, "two gzip members")
    check(run("--indent=2", data=b"WorldBegin WorldEnd Sides 1")[1] == b"WorldBegin\nWorldEnd\nSides 1\n", "--indent=N")


def files():
    write("a.rib", b"Sides 1")
    write("b.rib", run("--binary", data=b"Sides 2")[1])
    check(run("a.rib", "b.rib")[1] == b"Sides 1\nSides 2\n", "several inputs")
    check(run("-o", "out.rib", "a.rib") == (0, b"", ""), "-o writes nothing else")
    check(read("out.rib") == b"Sides 1\n", "-o")
    check(run("--binary", "-o", "a.rib", "a.rib")[0] == 0, "in place")
    check(run("a.rib")[1] == b"Sides 1\n", "in place: what is read again")
    write("world.rib", b"Sphere 1 -1 1 360 ReadArchive \"a.rib\" ReadArchive \"none.rib\"")
    write("top.rib", b"ArchiveBegin \"i\" ArchiveEnd WorldBegin ReadArchive \"world.rib\" ReadArchive \"i\" WorldEnd")
    check(b'ReadArchive "world.rib"' in run("top.rib")[1], "archives are kept")
    code, out, said = run("--expand", "top.rib")
    check(out == b'ArchiveBegin "i"\nArchiveEnd\nWorldBegin\nSphere 1 -1 1 360\nSides 1\nReadArchive "none.rib"\n'
          b'ReadArchive "i"\nWorldEnd\n' and code == 1 and "none.rib: not found; kept" in said, "--expand")
    write("self.rib", b'ReadArchive "self.rib"')
    check(run("--expand", "self.rib")[1] == b'ReadArchive "self.rib"\n', "an archive that reads itself")


def mistakes():
    code, out, said = run(data=b"Translate 1 2\nSides 1\nFoo 1\n")
    check(code == 1 and out == b"Sides 1\nFoo 1\n", "malformed ones are left out, unknown ones kept")
    check("stdin:2:1: error: Translate: expected a number for 'dz'" in said, "messages have a place")
    check("stdin:3:1: warning: unknown request 'Foo': kept" in said, "unknown requests are told")
    whole = gzip.compress(b"".join(b"Sides %d " % i for i in range(9999)))
    code, out, said = run(data=whole[:len(whole) // 2])
    check(code == 1 and out.startswith(b"Sides 0\nSides 1\n") and said.count("\n") == 1, "cut gzip is one error: " + said)
    code, out, said = run(data=b"Sides \x83\x01")
    check(code == 1 and "stdin:byte 6: error: Sides: expected a number" in said, "cut binary: " + said)
    code, out, said = run("--check", data=b"Sides 3 Sphere 1 -1 1 360")
    check(code == 1 and out == b"" and "Sphere: not legal" in said, "--check: " + said)
    check(run("--check", data=TEXT) == (0, b"", ""), "--check of what is right")


def environment():
    code, out, said = run("none.rib")
    check(code == 3 and "cannot read none.rib" in said, "a missing file")
    write("old.rib", b"old")
    check(run("-o", "old.rib", "a.rib", "none.rib")[0] == 3 and read("old.rib") == b"old", "all inputs or no file")
    check(run("-o", "nowhere/out.rib", data=TEXT)[0] == 3, "a missing directory")
    with open("/dev/full", "wb") as full:
        result = subprocess.run([CATRIB], input=TEXT, stdout=full, stderr=subprocess.PIPE, timeout=60)
    check(result.returncode == 3 and b"cannot write standard output" in result.stderr, "a full disk")
    check(not [name for name in os.listdir(".") if "tmp" in name], "no temporary file stays")


def usage():
    for arguments in (["--wrong"], ["-o"], ["--indent", "x"], ["--indent=99"], ["--gzip=1"]):
        code, out, said = run(*arguments)
        check(code == 2 and out == b"" and "usage: catrib" in said, "wrong usage: " + " ".join(arguments))
    code, out, _ = run("--help")
    with open(TABLE, encoding="utf-8") as file:
        names = re.findall(r'^CATRIB_OPTION\(\w+,\s*"([^"]+)"', file.read(), re.MULTILINE)
    check(code == 0 and names and all(name in out.decode() for name in names), "--help names every switch")
    check(run("--version")[1].startswith(b"catrib (Perigee)"), "--version")
    write("-odd", b"Sides 1")
    check(run("--", "-odd")[1] == b"Sides 1\n", "-- ends the switches")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for part in (forms, files, mistakes, environment, usage):
            part()
        os.chdir("/")
    print("\n".join(failures) or "catrib: fine")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
