# SPDX-License-Identifier: Apache-2.0
"""Completion for zsh: commands, options with their help, values where the help lists them."""


def _quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def _summary(entry):
    text = entry.summary.replace("\\", "\\\\")
    for sign in "[]:":
        text = text.replace(sign, "\\" + sign)
    return text


def _value(entry):
    if not entry.value:
        return ""
    if entry.choices:
        return f":value:({' '.join(entry.choices)})"
    return ":value:_files"


def _options(entries):
    for entry in entries:
        for name in entry.names:
            yield _quoted(f"*{name}[{_summary(entry)}]{_value(entry)}") + " \\"


def written(pages):
    program, rest = pages[0], pages[1:]
    name = program.words[0]
    shared = [entry for entry in program.options if entry.value]
    lines = [f"#compdef {name}", f"# zsh completion of {name}. Made from its --help.",
             f"_{name}() {{", "  local state line", "  local -a commands=("]
    for entry in program.commands:
        lines.append("    " + _quoted(f"{entry.head}:{entry.summary}"))
    lines += ["  )", "  _arguments -C \\"]
    lines += ["    " + line for line in _options(program.options)]
    lines += ["    '1: :->command' '*:: :->rest'", "  case $state in",
              "    command) _describe command commands;;", "    rest)", "      case $words[1] in"]
    for page in rest:
        named = {name for entry in page.options for name in entry.names}
        inherited = [entry for entry in shared if not named.intersection(entry.names)]
        lines.append(f"        {page.words[1]}) _arguments \\")
        lines += ["          " + line for line in _options([*page.options, *inherited])]
        lines.append("          '*:file:_files';;")
    lines += ["      esac;;", "  esac", "}", f"_{name} \"$@\""]
    return "\n".join(lines) + "\n"
