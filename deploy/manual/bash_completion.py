# SPDX-License-Identifier: Apache-2.0
"""Completion for bash: commands, options, and values where the help lists them. Else files."""


def _cases(page, shared):
    """What follows a command: its options, and the values of those that take some."""
    command = page.words[1] if len(page.words) > 1 else ""
    options = [*page.options, *(entry for entry in shared if entry not in page.options)]
    for entry in options:
        if entry.value:
            patterns = "|".join(f"'{command} {name}'" for name in entry.names)
            words = " ".join(entry.choices)
            yield f"    {patterns})" + (f" values='{words}';;" if words else " is_file=1;;")


def _options(page, shared):
    names = [name for entry in (*page.options, *shared) for name in entry.names]
    return " ".join(dict.fromkeys(names))


def written(pages):
    program, rest = pages[0], pages[1:]
    name = program.words[0]
    shared = [entry for entry in program.options if entry.value]  # taken behind commands, too
    commands = [page.words[1] for page in rest]
    lines = [
        f"# bash completion of {name}. Made from its --help.",
        f"_{name}() {{",
        "  local word=${COMP_WORDS[COMP_CWORD]} command= i options values= is_file=",
        "  for ((i = 1; i < COMP_CWORD; i++)); do",
        f"    case ${{COMP_WORDS[i]}} in {'|'.join(commands)}) command=${{COMP_WORDS[i]}}; break;; "
        "esac",
        "  done",
        "  case \"$command ${COMP_WORDS[COMP_CWORD - 1]}\" in",
    ]
    for page in pages:
        lines += _cases(page, [] if page is program else shared)
    lines += ["  esac", "  COMPREPLY=()", "  [[ -n $is_file ]] && return", "  case $command in"]
    for page in rest:
        lines.append(f"    {page.words[1]}) options='{_options(page, shared)}';;")
    lines += [
        f"    *) options='{_options(program, [])}'",
        f"       [[ $word == -* || -n $values ]] || values='{' '.join(commands)}';;",
        "  esac",
        "  [[ $word == -* && -z $values ]] && values=$options",
        "  mapfile -t COMPREPLY < <(compgen -W \"$values\" -- \"$word\")",
        "}",
        f"complete -o bashdefault -o default -F _{name} {name}",
    ]
    return "\n".join(lines) + "\n"
