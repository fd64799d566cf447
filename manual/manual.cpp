// SPDX-License-Identifier: Apache-2.0
// Build program: manual pages and shell completion from the tables of switches that the programs
// themselves read. In: the name of a program, the form wanted, for `man` a page with @OPTIONS@ and
// @VERSION@ to be filled in. Out: the text on standard output.
//
// usage: manual PROGRAM man PAGE VERSION | bash | zsh | fish | list
#include "runtime/base/file.h"
#include "runtime/base/option_table.h"

#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace {

using base::OptionRow;
using Names = std::vector<std::string_view>;

// --- the tables

constexpr std::string_view not_yet(std::string_view state) {
    return state == "LATER" ? " (not yet)" : "";
}

struct Switch : OptionRow {
    std::string_view note; // follows the help text
};

constexpr Switch render_rows[] = {
#define RENDER_OPTION(id, name, arguments, metavar, state, help)                                   \
    {{name, arguments, metavar, help}, not_yet(#state)},
#include "tracer/options.def"
#undef RENDER_OPTION
};
constexpr Switch catrib_rows[] = {
#define CATRIB_OPTION(id, name, arguments, metavar, state, help)                                   \
    {{name, arguments, metavar, help}, not_yet(#state)},
#include "ribtools/catrib_options.def"
#undef CATRIB_OPTION
};
constexpr Switch slc_rows[] = {
#define SLC_OPTION(id, name, arguments, metavar, help) {{name, arguments, metavar, help}, ""},
#include "slc/options.def"
#undef SLC_OPTION
};
constexpr Switch slctell_rows[] = {
#define SLCTELL_OPTION(id, name, arguments, metavar, help) {{name, arguments, metavar, help}, ""},
#include "slc/slctell_options.def"
#undef SLCTELL_OPTION
};

constexpr Switch txmake_rows[] = {
#define TXMAKE_OPTION(id, name, arguments, metavar, help) {{name, arguments, metavar, help}, ""},
#include "tracer/txmake_options.def"
#undef TXMAKE_OPTION
};

struct Program {
    std::string_view name, also; // a second name, "" = none
    std::span<const Switch> switches;
    std::string_view suffixes; // of its input files, separated by spaces
};
constexpr Program programs[] = {
    {"render", "rendrib", render_rows, "rib rib.gz"},
    {"catrib", "", catrib_rows, "rib rib.gz"},
    {"slc", "", slc_rows, "sl slo"},
    {"slctell", "", slctell_rows, "slo slpkg"},
    {"txmake", "", txmake_rows, "tif tiff png exr jpg z"},
};

// --- what completion offers for a value

enum class Offer { Nothing, File, Directory, Words };

Offer offer(const OptionRow& row) {
    if (row.arguments != "s") {
        return Offer::Nothing;
    }
    if (row.metavar.find('|') != std::string_view::npos || row.metavar == "c") {
        return Offer::Words;
    }
    return row.metavar == "FILE"                           ? Offer::File
           : row.metavar == "DIR" || row.metavar == "PATH" ? Offer::Directory
                                                           : Offer::Nothing;
}

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        if (text.substr(at).starts_with(from)) {
            out += to;
            at += from.size();
        } else {
            out += text[at++];
        }
    }
    return out;
}

std::string words(const OptionRow& row) {
    return replaced(row.metavar, "|", " ");
}

std::string all_names(const Program& program) {
    std::string names(program.name);
    return names + (program.also.empty() ? "" : " " + std::string(program.also));
}

std::string joined(std::span<const std::string_view> parts, std::string_view between) {
    std::string text;
    for (const std::string_view part : parts) {
        text += text.empty() ? "" : between;
        text += part;
    }
    return text;
}

Names names_offering(const Program& program, Offer wanted) {
    Names names;
    for (const Switch& row : program.switches) {
        if (offer(row) == wanted) {
            names.push_back(row.name);
        }
    }
    return names;
}

// --- roff

std::string roff(std::string_view text) {
    std::string out = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string man_options(const Program& program) {
    std::string text;
    for (const Switch& row : program.switches) {
        text += ".TP\n.B " + roff(row.name) + "\n";
        if (!row.metavar.empty()) {
            text.pop_back();
            text += " \\fI" + roff(row.metavar) + "\\fR\n";
        }
        text += roff(row.help) + std::string(row.note) + ".\n";
    }
    return text;
}

bool print_man(const Program& program, const std::string& page, const std::string& version) {
    const auto text = base::read_file(page);
    if (!text) {
        std::fprintf(stderr, "manual: cannot read %s\n", page.c_str());
        return false;
    }
    const std::string filled = replaced(*text, "@OPTIONS@\n", man_options(program));
    std::fputs(replaced(filled, "@VERSION@", version).c_str(), stdout);
    return true;
}

// --- shells

void print_bash(const Program& program) {
    const std::string function = "_perigee_" + std::string(program.name);
    std::printf("# bash completion for %s of Perigee; made from its table of switches\n%s()\n{\n"
                "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n"
                "    if [[ $cur == = ]]; then cur=; "
                "elif [[ $prev == = ]]; then prev=${COMP_WORDS[COMP_CWORD-2]}; fi\n"
                "    case $prev in\n",
                all_names(program).c_str(), function.c_str());
    for (const Switch& row : program.switches) {
        if (offer(row) == Offer::Words) {
            std::printf("        %s) COMPREPLY=($(compgen -W '%s' -- \"$cur\")); return ;;\n",
                        std::string(row.name).c_str(), words(row).c_str());
        }
    }
    const auto values = [&](Offer kind, const char* action) {
        if (const Names names = names_offering(program, kind); !names.empty()) {
            std::printf("        %s) COMPREPLY=($(compgen %s -- \"$cur\")); return ;;\n",
                        joined(names, "|").c_str(), action);
        }
    };
    values(Offer::File, "-f");
    values(Offer::Directory, "-d");
    Names all;
    for (const Switch& row : program.switches) {
        all.push_back(row.name);
    }
    std::printf("    esac\n    if [[ $cur == -* ]]; then\n"
                "        COMPREPLY=($(compgen -W '%s' -- \"$cur\"))\n    else\n"
                "        COMPREPLY=($(compgen -d -- \"$cur\") "
                "$(compgen -f -X '!*.@(%s)' -- \"$cur\"))\n    fi\n}\n"
                "shopt -s extglob\ncomplete -o filenames -F %s %s\n",
                joined(all, " ").c_str(), replaced(program.suffixes, " ", "|").c_str(),
                function.c_str(), all_names(program).c_str());
}

std::string zsh_value(const Switch& row) {
    const std::string label = replaced(row.metavar, ":", "\\:");
    switch (offer(row)) {
    case Offer::File:
        return ":" + label + ":_files";
    case Offer::Directory:
        return ":" + label + ":_files -/";
    case Offer::Words:
        return ":value:(" + words(row) + ")";
    case Offer::Nothing:
        break;
    }
    std::string text;
    bool optional = false;
    for (const char letter : row.arguments) {
        optional |= letter == '?';
        text += letter == '?' ? "" : (optional ? "::" : ":") + label + ":";
    }
    return text;
}

void print_zsh(const Program& program) {
    std::printf("#compdef %s\n# Made from the table of switches of Perigee's %s\n_arguments \\\n",
                all_names(program).c_str(), std::string(program.name).c_str());
    for (const Switch& row : program.switches) {
        const bool has_two_dashes = row.name.starts_with("--");
        const std::string help =
            replaced(replaced(replaced(replaced(row.help, "'", "'\\''"), "[", "\\["), "]", "\\]"),
                     ":", "\\:");
        std::printf("  '*%s%s[%s]%s' \\\n", std::string(row.name).c_str(),
                    has_two_dashes && !row.arguments.empty() ? "=" : "", help.c_str(),
                    zsh_value(row).c_str());
    }
    std::printf("  '*:file:_files -g \"*.(%s)\"'\n", replaced(program.suffixes, " ", "|").c_str());
}

void print_fish(const Program& program) {
    Names names = {program.name};
    if (!program.also.empty()) {
        names.push_back(program.also);
    }
    for (const std::string_view name : names) {
        for (const Switch& row : program.switches) {
            const bool is_long = row.name.starts_with("--");
            const std::string spelled(row.name.substr(is_long ? 2 : 1));
            std::printf("complete -c %s %s %s", std::string(name).c_str(),
                        is_long               ? "-l"
                        : spelled.size() == 1 ? "-s"
                                              : "-o",
                        spelled.c_str());
            if (offer(row) == Offer::Words) {
                std::printf(" -x -a '%s'", words(row).c_str());
            } else if (offer(row) == Offer::Directory) {
                std::printf(" -x -a '(__fish_complete_directories)'");
            } else if (!row.arguments.empty() && !row.arguments.starts_with('?')) {
                std::printf(offer(row) == Offer::File ? " -r" : " -x");
            }
            std::printf(" -d '%s'\n", replaced(row.help, "'", "\\'").c_str());
        }
    }
}

int print(const Program& program, std::span<char* const> arguments) {
    const std::string_view form = arguments[0];
    if (form == "man" && arguments.size() == 3) {
        return print_man(program, arguments[1], arguments[2]) ? 0 : 1;
    }
    if (form == "bash") {
        print_bash(program);
    } else if (form == "zsh") {
        print_zsh(program);
    } else if (form == "fish") {
        print_fish(program);
    } else if (form == "list") {
        for (const Switch& row : program.switches) {
            std::printf("%s\n", std::string(row.name).c_str());
        }
    } else {
        return 2;
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    for (const Program& program : programs) {
        if (argc > 2 && program.name == argv[1]) {
            return print(program, {argv + 2, argv + argc});
        }
    }
    std::fprintf(stderr, "usage: manual PROGRAM man PAGE VERSION | bash | zsh | fish | list\n");
    return 2;
}
