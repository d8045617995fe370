# SPDX-License-Identifier: Apache-2.0
"""server/schedule decides and never acts: it has no thread, waits for nothing and reads no clock of
its own, so that tests turn time by hand. A mutex is allowed: threads may share a decision.
"""

import re

from tree import Finding

FOLDER = "server/schedule/"
FORBIDDEN = (
    ("a thread", re.compile(r"\bstd::(j?thread|async|stop_token)\b|<(thread|future|stop_token)>")),
    ("a wait", re.compile(r"\bcondition_variable|\bstd::(\w*semaphore|latch|barrier)\b"
                          r"|<(semaphore|latch|barrier)>|\bu?(sleep|wait)(_for|_until)?\s*\(")),
    ("a clock of its own", re.compile(r"_clock::now\b|\bSteadyClock\b")),
)


def check(tree):
    for path in tree.text_files(".h", ".cpp"):
        if not path.startswith(FOLDER):
            continue
        for number, line in enumerate(tree.lines(path), 1):
            code = line.split("//")[0]
            for name, pattern in FORBIDDEN:
                if pattern.search(code):
                    yield Finding(path, number, "schedule", f"{FOLDER} has {name}")
