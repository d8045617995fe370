# SPDX-License-Identifier: Apache-2.0
"""What a server may do when Vulkan fails: show right pictures again, or end in order."""

import re
from dataclasses import dataclass, field

EXIT_REFUSED, EXIT_FAILED = 2, 3
SAID_WHILE_SERVING = r"^\S+ error the server cannot go on: [A-Za-z].{20,}$"
SAID_AT_START = r"^viewloomd: [A-Za-z].{20,}$"


@dataclass(frozen=True)
class Limits:
    again_s: float  # until everybody is served again, beside what the same takes without a fault
    end_s: float    # until a process that gives up has ended


FULL = Limits(again_s=2.0, end_s=10.0)
# While other tests run.
SUITE = Limits(again_s=20.0, end_s=30.0)


@dataclass(frozen=True)
class Fault:
    """The call of that number of one function, counted from the stage's moment, fails."""
    function: str
    number: int
    result: str
    stays_lost: bool = True

    def text(self):
        return f"{self.function} {self.number}: {self.result.removeprefix('VK_')}"


@dataclass
class Outcome:
    """What one server did. Times are seconds after the fault, None where that did not come."""
    stage: str
    fault: object = None
    has_failed: bool = False   # the planted fault was reached
    again_s: float = None
    clean_s: float = 0.0       # what the stage takes without a fault
    end_s: float = None        # the process ended
    exit_code: int = None
    was_stopping: bool = False # SIGTERM had come
    had_started: bool = True
    wrong: list = field(default_factory=list)
    refusals: list = field(default_factory=list)
    log: str = ""
    counts: dict = field(default_factory=dict)  # calls by function

    def kind(self):
        if not self.has_failed:
            return "not reached"
        if self.wrong:
            return "wrong picture"
        if self.end_s is not None:
            return f"exit {self.exit_code}"
        return "served again" if self.again_s is not None else "half alive"


def found_in_end(outcome, limits):
    """The process has ended by itself, or in a drain."""
    found = []
    said = {EXIT_FAILED: SAID_WHILE_SERVING}
    if outcome.was_stopping:
        said[0] = ""
    if not outcome.had_started:
        said[EXIT_REFUSED] = SAID_AT_START
    if outcome.exit_code not in said:
        found.append(f"ended with {outcome.exit_code}")
    elif not re.search(said[outcome.exit_code], outcome.log, re.MULTILINE):
        found.append(f"ended with {outcome.exit_code} and without a sentence")
    if outcome.end_s > limits.end_s:
        found.append(f"took {outcome.end_s:.1f} s to end")
    return found


def is_late(outcome, limits):
    return outcome.again_s is not None and outcome.again_s > limits.again_s + outcome.clean_s


def found(outcome, limits):
    """All that is wrong; empty where the server did as it should."""
    result = list(outcome.wrong)
    if outcome.fault and not outcome.has_failed:
        result.append("the fault was not reached")
        return result
    if outcome.end_s is not None:
        return result + found_in_end(outcome, limits)
    if outcome.was_stopping:
        result.append("does not end at SIGTERM")
    elif outcome.again_s is None and not outcome.wrong:
        result.append("half alive: neither served nor ended")
    elif is_late(outcome, limits):
        result.append(f"served again only after {outcome.again_s:.1f} s")
    return result
