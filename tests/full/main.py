# SPDX-License-Identifier: Apache-2.0
"""tests/full.sh [--list | --fuzz | PART...]: the parts that are named, or all that have not passed.
--fuzz says how far the search of each fuzz target has come.
"""

import sys

import fuzz_record
import long_run
from fuzz_sources import FuzzSources
from parts import FUZZ_KEPT, PARTS

RECORD = "build/full/passed.json"


def main(words):
    record = long_run.Record(RECORD, long_run.source_of("."))
    if words == ["--list"]:
        for part in PARTS:
            print(f"{part.name:14} {long_run.covered(part, record):26} {part.text}")
        return 0
    if words == ["--fuzz"]:
        sources = FuzzSources(".")
        states = {target: sources.state_of(target) for target in sources.targets()}
        print(*fuzz_record.summary(FUZZ_KEPT, states), sep="\n")
        return 0
    names = {part.name for part in PARTS}
    unknown = [word for word in words if word not in names]
    if unknown:
        print(f"no part is called {', '.join(unknown)}; the parts: {', '.join(sorted(names))}",
              file=sys.stderr)
        return 2
    commands = long_run.Commands()
    commands.stop_on_signals()
    failed = []
    try:
        for part in PARTS:
            if words and part.name not in words:
                continue
            if not long_run.run(part, record, commands):
                failed.append(part.name)
    except long_run.Stopped:
        return 130
    print(f"FAILED: {', '.join(failed)}" if failed else "all passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
