# SPDX-License-Identifier: Apache-2.0
"""Compares the protos with proto/baseline.txt, which lists all that they declared before.

proto_baseline.py            checks: the list must be that of the protos
proto_baseline.py --update   writes the list anew

Before version 1.0, an incompatible change is written once the newest section of CHANGELOG.md names
the message, enum or service. From 1.0 on it is refused, whatever the list says by then: it is also
compared with each list that was committed since 1.0.
"""

import argparse
import difflib
import pathlib
import re
import subprocess
import sys

import declarations
import incompatible

BASELINE = "proto/baseline.txt"
VERSIONED = "CMakeLists.txt"
UPDATE = "/usr/bin/python3 tests/proto/proto_baseline.py --update"
HEAD = """\
# All that the protos declare. Not to be edited: after a change of a proto, run
# {update}
# proto/README.md says which changes are allowed ("What may change").

""".format(update=UPDATE)


class Refused(Exception):
    """Why the protos cannot stay as they are."""


def is_stable(lists):
    """Whether the text of the top CMakeLists.txt has a version of 1.0 or later."""
    match = re.search(r"project\(viewloom VERSION (\d+)", lists)
    return match is not None and int(match.group(1)) >= 1


def newest_section(changes):
    return re.split(r"^## ", changes, flags=re.MULTILINE)[1:2] or [""]


def committed_lists(root):
    """The lists that were committed since version 1.0, the newest first; none without git."""
    def git(*words):
        return subprocess.run(["git", "-c", "safe.directory=*", *words], cwd=root, check=True,
                              capture_output=True, text=True).stdout
    try:
        for commit in git("log", "--format=%H", "--", VERSIONED, BASELINE).split():
            if not is_stable(git("show", f"{commit}:{VERSIONED}")):
                return
            yield commit[:10], git("show", f"{commit}:{BASELINE}")
    except (OSError, subprocess.CalledProcessError) as problem:
        print(f"the lists of earlier commits were not compared: {problem}")


def refuse_breaks(root, current, listed):
    """From 1.0 on: nothing that was listed may change."""
    for origin, text in [(BASELINE, listed), *committed_lists(root)]:
        found = incompatible.breaks(declarations.read(text), current)
        if found:
            raise Refused("\n".join(
                [f"incompatible with {origin}, which is refused from 1.0 on:",
                 *(f"  {one}" for one in found),
                 "Leave v1 as it is, and declare what changes in a new package, viewloom.v2."]))


def check(root, text, listed):
    """Prints what changed, and raises Refused unless the list is that of the protos."""
    found = incompatible.breaks(declarations.read(listed), declarations.read(text))
    if HEAD + text == listed:
        return
    raise Refused("\n".join(
        [*difflib.unified_diff(listed.splitlines(), (HEAD + text).splitlines(), BASELINE,
                               "the protos", n=1, lineterm=""),
         *(f"incompatible: {one}" for one in found),
         f"{BASELINE} is not that of the protos. Run, and commit what it writes:", UPDATE]))


def update(root, text, listed):
    """Writes the list, once each incompatible change is told to users."""
    found = incompatible.breaks(declarations.read(listed), declarations.read(text))
    section, = newest_section((root / "CHANGELOG.md").read_text(encoding="utf-8"))
    untold = set()
    for one in found:
        print(f"incompatible: {one}")
        name = one.declaration.rpartition(".")[2]
        if not re.search(rf"\b{name}\b", section):
            untold.add(name)
    if untold:
        raise Refused("nothing is written: say in the newest section of CHANGELOG.md what changed "
                      f"in {', '.join(sorted(untold))}, and keep \"What may change\" in "
                      "proto/README.md true")
    (root / BASELINE).write_text(HEAD + text, encoding="utf-8")
    print(f"wrote {BASELINE}")


def main(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--protoc", default="protoc")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).parents[2])
    options = parser.parse_args(arguments)
    root, baseline = options.root, options.root / BASELINE
    text = declarations.text_of(root / "proto", options.protoc)
    listed = baseline.read_text(encoding="utf-8") if baseline.exists() else ""
    try:
        if is_stable((root / VERSIONED).read_text(encoding="utf-8")):
            refuse_breaks(root, declarations.read(text), listed)
        (update if options.update else check)(root, text, listed)
    except (Refused, ValueError) as problem:
        print(problem)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
