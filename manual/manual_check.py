# SPDX-License-Identifier: Apache-2.0
"""Test: every switch of every program stands in its --help, its manual page and its completions.

usage: manual_check.py MANUAL-PROGRAM BUILT-MANUAL-FOLDER SOURCE-ROOT
The programs are found in the build tree. Pages are also formatted, and completions read by their shells, as far as
groff, mandoc and the shells are installed.
"""
import os
import re
import shutil
import subprocess
import sys

PROGRAMS = {"render": "tracer/render", "catrib": "ribtools/catrib", "slc": "slc/slc", "slctell": "slc/slctell",
            "txmake": "tracer/txmake"}
COMPLETIONS = {"bash": "{}", "zsh": "_{}", "fish": "{}.fish"}
READ_BY_RENDER = re.compile(r'(?:getenv|directories_from|variable)\("([A-Z_]+)"\)')
WHERE_READ = ("tracer/render.cpp", "runtime/shader_cache.cpp")


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def read(*parts):
    with open(os.path.join(*parts), encoding="utf-8") as file:
        return file.read()


def has_word(text, word):
    return re.search(r"(?<![\w-])" + re.escape(word) + r"(?![\w-])", text) is not None


def fish_spelling(switch):
    if switch.startswith("--"):
        return f"-l {switch[2:]}"
    return f"-{'s' if len(switch) == 2 else 'o'} {switch[1:]}"


def check_switches(manual, folder, build, program):
    """What is missing where, as texts."""
    switches = run([manual, program, "list"]).stdout.split()
    if not switches:
        yield f"{program}: no switches"
    texts = {
        "--help": run([os.path.join(build, PROGRAMS[program]), "--help"]).stdout,
        "manual page": read(folder, program + ".1").replace("\\-", "-"),
        "bash": read(folder, program),
        "zsh": read(folder, "_" + program),
    }
    fish = read(folder, program + ".fish")
    for switch in switches:
        for where, text in texts.items():
            if not has_word(text, switch):
                yield f"{program}: {switch} is not in {where}"
        if not has_word(fish, fish_spelling(switch)):
            yield f"{program}: {switch} is not in fish"


def check_environment(folder, root):
    """Variables that render reads and its page does not explain."""
    page = read(folder, "render.1")
    for name in sorted({name for path in WHERE_READ for name in READ_BY_RENDER.findall(read(root, path))}):
        if name != "HOME" and not has_word(page, name):
            yield f"render.1 does not explain {name}"


def check_page(page):
    """Complaints of the formatters."""
    for command in (["groff", "-man", "-ww", "-z", "-Tutf8"], ["mandoc", "-Tlint", "-Wwarning"]):
        if shutil.which(command[0]):
            result = run([*command, page])
            text = result.stdout + result.stderr
            if text.strip():
                yield f"{command[0]}: {text}"


def check_shell(shell, path):
    if shutil.which(shell):
        result = run([shell, "-n", path])
        if result.returncode != 0 or result.stderr:
            yield f"{shell} -n {path}: {result.stderr}"


def check_bash(folder):
    """Completion as bash does it."""
    script = """source "$1"; COMP_WORDS=($2 "$3" "$4"); COMP_CWORD=2; _perigee_$2; printf '%s\\n' "${COMPREPLY[@]}" """
    for program, before, typed, expected in (
            ("render", "x.rib", "--prog", "--progress"), ("render", "--progress", "lin", "lines"),
            ("slc", "--dump", "fac", "facts"), ("slctell", "x", "--js", "--json")):
        offered = run(["bash", "-c", script, "bash", os.path.join(folder, program), program, before, typed]).stdout.split()
        if offered != [expected]:
            yield f"bash offers {offered} for {program} {before} {typed}, not {expected}"


def main(manual, folder, root):
    build = os.path.dirname(folder)
    wrong = []
    readme = read(root, "README.md")
    for program in PROGRAMS:
        wrong += check_switches(manual, folder, build, program)
        page = os.path.join(folder, program + ".1")
        wrong += check_page(page)
        for shell, name in COMPLETIONS.items():
            wrong += check_shell(shell, os.path.join(folder, name.format(program)))
        if f"`{program}" not in readme or f"man {program}" not in readme:
            wrong.append(f"README.md does not name {program} and `man {program}`")
    wrong += check_bash(folder)
    wrong += check_environment(folder, root)
    print("\n".join(wrong) or "all switches are everywhere")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
