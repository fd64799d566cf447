#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that docs/shading-language.md and the grammars below editors/ are those of the tables; --fix writes them.

In: slc/tokens.def and, in runtime/abi, sl_builtins.def, sl_variables.def, sl_ray_options.def, sl_output_pairs.def. Out: the tables between the marks of the
page, and the generated files of editors/. Also checks that the JSON files parse, that every word and built-in is in
both grammars, and, where vim is installed, that it loads the syntax.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGE = "docs/shading-language.md"
SHADERS = {"S": "surface", "D": "displacement", "L": "light", "V": "volume", "I": "imager", "T": "transformation"}
LETTERS = {"f": "float", "c": "color", "p": "point", "v": "vector", "n": "normal", "m": "matrix", "s": "string",
           "g": "point|vector|normal", "t": "triple", "x": "any", "X": "output any", "G": "output point|vector|normal"}
CONTROL = ("If", "Else", "While", "For", "Break", "Continue", "Return", "Illuminate", "Illuminance", "Solar")
STORAGE = ("Uniform", "Varying", "Output", "Extern")
MACROS = ("PERIGEE", "BMRT")


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


class Tables:
    def __init__(self):
        words = re.findall(r'^SLC_WORD\((\w+), "(\w+)"\)', read("slc/tokens.def"), re.MULTILINE)
        self.control = [text for name, text in words if name in CONTROL] + ["gather"]
        self.storage = [text for name, text in words if name in STORAGE]
        self.types = [text for name, text in words if name not in CONTROL + STORAGE]
        row = re.compile(r'^SL_BUILTIN\((\w+),\s*"([^"]+)",\s*(\w+),\s*([^,]+),\s*([\w|]+),\s*"((?:[^"\\]|\\.)*)"\)',
                         re.MULTILINE)
        section = re.compile(r"^/\* ([a-z][\w ]*)(?:\..*)? \*/$", re.MULTILINE)
        text = read("runtime/abi/sl_builtins.def")
        marks = [(m.start(), m[1]) for m in section.finditer(text)]
        self.builtins = []  # section, name, signature, properties, note
        for m in row.finditer(text):
            properties = m[5].split("|")
            if "SL_HIDDEN" not in properties:
                heads = [name for at, name in marks if at < m.start()]
                self.builtins.append((heads[-1], m[1], m[2], properties, m[6].replace('\\"', '"')))
        rows = text.count("\nSL_BUILTIN(")
        assert rows == len(row.findall(text)), "sl_builtins.def has rows this script does not read"
        self.variables = re.findall(r'^SL_VAR\((\w+),\s*(\w+),\s*(\w+),\s*([\w|]+),\s*([\w|]+),\s*"([^"]*)"\)',
                                    read("runtime/abi/sl_variables.def"), re.MULTILINE)
        rays = read("runtime/abi/sl_ray_options.def")
        text_of = r'"((?:[^"\\]|\\.)*)"'
        self.ray_numbers = re.findall(r"^SL_RAY_NUMBER\((\w+), ([^,]+), " + text_of + r"\)", rays, re.MULTILINE)
        self.ray_texts = re.findall(r"^SL_RAY_TEXT\((\w+), " + text_of + r"\)", rays, re.MULTILINE)
        self.output_pairs = re.findall(r"^SL_OUTPUT_PAIRS\((\w+), " + text_of + ", " + text_of + r"\)",
                                       read("runtime/abi/sl_output_pairs.def"), re.MULTILINE)
        self.names = sorted({name for _, name, _, _, _ in self.builtins}, key=str.lower)


def spell(letter):
    if letter == "void":
        return letter
    if letter.startswith("["):
        return spell(letter.strip("[]")) + "[]"
    return LETTERS.get(letter) or "output " + LETTERS[letter.lower()]


def form(name, signature):
    """'f(f,f*)' of pow as 'float pow(float, float, ...)'."""
    result, _, rest = signature.partition("(")
    arguments = []
    for argument in [a for a in rest.rstrip(")").split(",") if a]:
        ending = argument[-1] if argument[-1] in "+*" else ""
        base = argument[:-1] if ending else argument
        if ending == "*" and base == "x":
            arguments.append("...")
            continue
        arguments.append(spell(base))
        arguments += {"+": ["..."], "*": ["options"]}.get(ending, [])
    return f"{spell(result)} {name}({', '.join(arguments)})"


def marks_of(properties):
    words = {"SL_LIGHTS": "runs lights", "SL_TRACES": "traces", "SL_AREA": "area operator", "SL_MESSAGE": "asks others"}
    return ", ".join(text for key, text in words.items() if key in properties)


def cell(text):
    return text.replace("|", "\\|")


def builtin_tables(tables):
    text, last = "", None
    for section, name, signature, properties, note in tables.builtins:
        if section != last:
            text += f"\n### {section[0].upper() + section[1:]}\n\n| form | |\n|---|---|\n"
            last = section
        remark = "; ".join(x for x in (note, marks_of(properties)) if x)
        text += f"| `{cell(form(name, signature))}` | {cell(remark)} |\n"
    return text + "\n"


def variable_table(tables):
    def where(flags, other):
        letters = [f[-1] for f in flags.split("|") if f.startswith("SL_IN_")]
        return " ".join(("**%s**" if x in other else "%s") % x for x in letters)

    text = "\n| name | type | shaders | |\n|---|---|---|---|\n"
    for name, kind, detail, readable, writable, note in tables.variables:
        written = [f[-1] for f in writable.split("|")]
        shaders = where(readable, written)
        text += f"| `{name}` | {detail} {kind} | {shaders} | {note} |\n"
    legend = ", ".join(f"{letter} {name}" for letter, name in SHADERS.items())
    return text + f"\n{legend}; bold: may be assigned there.\n\n"


def ray_table(tables):
    text = "\n| pair | default | |\n|---|---|---|\n"
    defaults = {"1e30f": "none", "1.57079632679489662f": "pi/2"}
    for name, default, note in tables.ray_numbers:
        text += f"| `\"{name}\"` float | {defaults.get(default, default)} | {cell(note)} |\n"
    for name, note in tables.ray_texts:
        text += f"| `\"{name}\"` string | | {cell(note)} |\n".replace('\\"', '"')
    text += "\nPairs that set a variable; what is not found keeps its value:\n\n| function | names | |\n|---|---|---|\n"
    for body, names, note in tables.output_pairs:
        if note:
            function = {"gather_ray": "gather"}.get(body, body)
            text += f"| `{function}` | {spelt_names(names)} | {cell(note)} |\n".replace('\\"', '"')
    return text + "\n"


def spelt_names(names):
    spelt = {":": "any with a colon", "*": "any"}
    wanted = [spelt.get(n) or f"`{n}`" for n in names.split() if not n.startswith("-")]
    but = [f"`{n[1:]}`" for n in names.split() if n.startswith("-")]
    return ", ".join(wanted) + (" but " + ", ".join(but) if but else "")


def word_list(tables):
    rows = (("types", tables.types), ("storage", tables.storage), ("control", tables.control),
            ("shader types", SHADERS.values()))
    return "\n" + "".join(f"- {name}: {' '.join(f'`{w}`' for w in words)}\n" for name, words in rows) + "\n"


def page(tables):
    text = read(PAGE)
    for mark, part in (("words", word_list(tables)), ("variables", variable_table(tables)),
                       ("builtins", builtin_tables(tables)), ("rays", ray_table(tables))):
        pattern = re.compile(f"(<!-- {mark}, from the tables -->\n).*?(<!-- end -->)", re.DOTALL)
        assert pattern.search(text), f"{PAGE} has no mark for {mark}"
        text = pattern.sub(lambda m, part=part: m[1] + part + m[2], text, count=1)
    return text


def vim(tables):
    def lines(group, words):
        words = list(words)
        return "".join(f"syn keyword {group} {' '.join(words[i:i + 10])}\n" for i in range(0, len(words), 10))

    variables = [v[0] for v in tables.variables] + ["PI"]
    return f'''" SPDX-License-Identifier: Apache-2.0
" Vim syntax file: RenderMan Shading Language. Generated by testsuite/check_language.py from Perigee's tables.
if exists("b:current_syntax")
  finish
endif

{lines("slType", tables.types)}{lines("slStorage", tables.storage)}{lines("slStatement", tables.control)}\
{lines("slShader", SHADERS.values())}{lines("slVariable", variables)}{lines("slMacro", MACROS)}
" Built-in functions count only before a parenthesis: their names also serve as variables.
''' + "".join(f'syn match slFunction "\\<{name}\\>\\ze\\s*("\n' for name in tables.names) + r'''
syn match slNumber "\<\d\+\(\.\d*\)\=\([eE][-+]\=\d\+\)\=[fF]\=\>\="
syn match slNumber "\.\d\+\([eE][-+]\=\d\+\)\=[fF]\="
syn region slString start=+"+ skip=+\\\\\|\\"+ end=+"+
syn region slPreProc start="^\s*#" skip="\\$" end="$" keepend contains=slComment,slString,slNumber
syn keyword slTodo contained TODO FIXME XXX
syn region slComment start="/\*" end="\*/" contains=slTodo
syn match slComment "//.*$" contains=slTodo

hi def link slType Type
hi def link slStorage StorageClass
hi def link slStatement Statement
hi def link slShader Structure
hi def link slVariable Identifier
hi def link slMacro Macro
hi def link slFunction Function
hi def link slNumber Number
hi def link slString String
hi def link slPreProc PreProc
hi def link slTodo Todo
hi def link slComment Comment

let b:current_syntax = "sl"
'''


def grammar(tables):
    def words(names):
        return r"\b(" + "|".join(names) + r")\b"

    patterns = [
        {"name": "comment.block.sl", "begin": r"/\*", "end": r"\*/"},
        {"name": "comment.line.double-slash.sl", "match": "//.*$"},
        {"name": "meta.preprocessor.sl", "match": r"^\s*#\s*\w+", "captures": {"0": {"name": "keyword.control.directive.sl"}}},
        {"name": "string.quoted.double.sl", "begin": '"', "end": '"',
         "patterns": [{"name": "constant.character.escape.sl", "match": r"\\."}]},
        {"name": "constant.numeric.sl", "match": r"(\b\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?[fF]?"},
        {"match": words(SHADERS.values()) + r"\s+(\w+)\s*(?=\()",
         "captures": {"1": {"name": "storage.type.shader.sl"}, "2": {"name": "entity.name.function.shader.sl"}}},
        {"name": "storage.type.sl", "match": words(tables.types)},
        {"name": "storage.modifier.sl", "match": words(tables.storage)},
        {"name": "keyword.control.sl", "match": words(tables.control)},
        {"name": "support.function.sl", "match": words(tables.names) + r"(?=\s*\()"},
        {"name": "variable.language.sl", "match": words([v[0] for v in tables.variables])},
        {"name": "constant.language.sl", "match": words(["PI", *MACROS])},
        {"name": "keyword.operator.sl", "match": r"[-+*/^.!<>=?:&|]+"},
    ]
    return json.dumps({"name": "RenderMan Shading Language", "scopeName": "source.sl", "fileTypes": ["sl", "slh"],
                       "patterns": patterns}, indent=2) + "\n"


PACKAGE = {
    "name": "perigee-sl", "displayName": "RenderMan Shading Language", "publisher": "perigee", "version": "1.0.0",
    "description": "Syntax of the RenderMan Shading Language; messages of `slc --check`",
    "license": "Apache-2.0", "engines": {"vscode": "^1.50.0"}, "categories": ["Programming Languages"],
    "contributes": {
        "languages": [{"id": "sl", "aliases": ["RenderMan Shading Language", "sl"], "extensions": [".sl", ".slh"],
                       "configuration": "./language-configuration.json"}],
        "grammars": [{"language": "sl", "scopeName": "source.sl", "path": "./syntaxes/sl.tmLanguage.json"}],
        "problemMatchers": [{
            "name": "slc", "owner": "sl", "fileLocation": ["autoDetect", "${workspaceFolder}"],
            "pattern": {"regexp": r"^(.*?):(\d+):(\d+): (error|warning): (.*)$",
                        "file": 1, "line": 2, "column": 3, "severity": 4, "message": 5}}],
        "taskDefinitions": [{"type": "slc", "properties": {}}],
    },
}
CONFIGURATION = {
    "comments": {"lineComment": "//", "blockComment": ["/*", "*/"]},
    "brackets": [["{", "}"], ["[", "]"], ["(", ")"]],
    "autoClosingPairs": [["{", "}"], ["[", "]"], ["(", ")"], ["\"", "\""]],
}
FTDETECT = '" SPDX-License-Identifier: Apache-2.0\nautocmd BufRead,BufNewFile *.sl,*.slh setfiletype sl\n'


def outputs():
    tables = Tables()
    return tables, {
        PAGE: page(tables),
        "editors/vim/syntax/sl.vim": vim(tables),
        "editors/vim/ftdetect/sl.vim": FTDETECT,
        "editors/vscode/syntaxes/sl.tmLanguage.json": grammar(tables),
        "editors/vscode/package.json": json.dumps(PACKAGE, indent=2) + "\n",
        "editors/vscode/language-configuration.json": json.dumps(CONFIGURATION, indent=2) + "\n",
    }


def missing_words(tables, files):
    """What a grammar does not know, by the text of its patterns."""
    wanted = tables.control + tables.types + tables.storage + tables.names + [v[0] for v in tables.variables]
    for path in ("editors/vim/syntax/sl.vim", "editors/vscode/syntaxes/sl.tmLanguage.json"):
        known = set(re.findall(r"\w+", files[path].replace("\\\\b", " ").replace("\\<", " ").replace("\\>", " ")))
        yield from (f"{path} does not know {word}" for word in wanted if word not in known)
    for path, text in files.items():
        if path.endswith(".json"):
            json.loads(text)


def vim_complaints():
    program = shutil.which("vim")
    if program is None:
        return
    with tempfile.NamedTemporaryFile(suffix=".txt") as log:
        syntax = os.path.join(ROOT, "editors/vim/syntax/sl.vim")
        subprocess.run([program, "-u", "NONE", "-es", "-V0" + log.name, "-c", "syntax on", "-c", f"source {syntax}",
                        "-c", "if get(b:, 'current_syntax', '') != 'sl' | cquit | endif", "-c", "qa!"],
                       check=False, stdin=subprocess.DEVNULL, timeout=20)
        with open(log.name, encoding="utf-8", errors="replace") as file:
            yield from (f"vim: {line.strip()}" for line in file if re.search(r"\bE\d+:", line))


def main():
    tables, files = outputs()
    if "--fix" in sys.argv[1:]:
        for path, text in files.items():
            with open(os.path.join(ROOT, path), "w", encoding="utf-8") as file:
                file.write(text)
    problems = [f"{path} differs from the tables; testsuite/check_language.py --fix writes it"
                for path, text in files.items()
                if not os.path.exists(os.path.join(ROOT, path)) or read(path) != text]
    problems += list(missing_words(tables, files)) + list(vim_complaints())
    print("\n".join(problems) or f"{len(tables.builtins)} rows of built-ins, {len(tables.variables)} variables: up to date")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
