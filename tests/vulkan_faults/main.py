# SPDX-License-Identifier: Apache-2.0
"""Lets Vulkan fail under a server of its own on loopback, and judges what the server does.

Arguments: viewloomd, the folder of the layer's manifest, and --suite, --stage NAME, --sites COUNT
with --seed NUMBER, or --calls. PYTHONPATH has the Python client. Each stage is lived through
without a fault first: its pictures are those that must come, its calls those that fail. Prints a
row for each fault. The exit code is 1 if a server stayed half alive, showed a wrong picture, or
ended as it should not.
"""

import argparse
import collections
import dataclasses
import itertools
import random
import sys

import judge
import plan
import trial
from pictures import Pictures
from stages import BY_NAME, STAGES
from trial import Trial

HEADER = ("| stage | call that fails | outcome | after, s | without it, s | verdict |\n"
          "|---|---|---|---|---|---|")
CLEAN_PATIENCE_S = 120.0


def row(outcome, found):
    after_s = outcome.end_s if outcome.end_s is not None else outcome.again_s
    after = "-" if after_s is None else f"{after_s:.2f}"
    return (f"| {outcome.stage} | {outcome.fault.text()} | {outcome.kind()} | {after} "
            f"| {outcome.clean_s:.2f} | {'; '.join(found) or 'ok'} |")


class Faults:
    """Stages that were recorded, and the outcomes so far."""

    def __init__(self, words, limits):
        self.words, self.limits = words, limits
        self.pictures = Pictures()
        self.clean = {}
        self.life = None  # the server in use
        self.tally = collections.Counter()
        self.longest_s = collections.Counter()
        self.bad = 0

    def record(self, stage):
        """The stage without a fault."""
        if stage.name not in self.clean:
            self.end_life()
            self.pictures.is_learning = True
            life = self.be_born(stage)
            outcome = Trial(life, patience_s=CLEAN_PATIENCE_S).outcome
            self.pictures.is_learning = False
            if outcome.wrong or outcome.exit_code not in (None, 0):
                raise RuntimeError(f"{stage.name} fails without a fault: {outcome}")
            self.clean[stage.name] = outcome
            self.end_life()
        return self.clean[stage.name]

    def be_born(self, stage, fault=None):
        self.life = trial.born(self.words.viewloomd, self.words.layers, stage, self.pictures, fault)
        return self.life

    def end_life(self):
        """Stops the server in use, which has to end in order."""
        life, self.life = self.life, None
        if life is None:
            return
        if life.server.is_alive():
            code = life.stop()
            if code != 0:
                self.bad += 1
                print(f"| {life.stage.name} | SIGTERM afterwards | exit {code} | - | - "
                      "| did not end in order |", flush=True)
        life.close()

    def reach(self, stage, fault):
        """Its outcome: on the server in use if that comes to such a call, or else on a new one. A
        call that is one of many does not come each time: then an earlier one."""
        clean_s = self.record(stage).clean_s
        patience_s = self.limits.again_s + 2 * clean_s + 10
        while True:
            is_new = self.life is None or self.life.stage != stage
            if is_new:
                self.end_life()
                self.be_born(stage, fault)
            one = Trial(self.life, fault, patience_s, clean_s)
            if not one.is_reusable or not one.outcome.has_failed:
                self.end_life()
            if one.outcome.has_failed or (is_new and fault.number == 1):
                return one.outcome
            if is_new:
                fault = dataclasses.replace(fault, number=(fault.number + 1) // 2)

    def plant(self, stage, fault):
        outcome = self.reach(stage, fault)
        if judge.is_late(outcome, self.limits):  # twice, or others were using the machine
            self.end_life()
            outcome = self.reach(stage, outcome.fault)
        found = judge.found(outcome, self.limits)
        print(row(outcome, found), flush=True)
        if found and self.words.verbose:
            print(outcome, flush=True)
        self.bad += bool(found)
        self.tally[outcome.kind()] += 1
        after_s = outcome.end_s if outcome.end_s is not None else outcome.again_s
        if after_s is not None:
            self.longest_s[outcome.kind()] = max(self.longest_s[outcome.kind()], after_s)

    def say_end(self):
        kinds = ", ".join(f"{count} {kind} (at most {self.longest_s[kind]:.1f} s)"
                          for kind, count in sorted(self.tally.items()))
        print(f"\n{sum(self.tally.values())} faults: {kinds or 'none'}; {self.bad} not in order")


def print_calls(faults, stages):
    """Functions by stage; those in brackets cannot fail."""
    for stage in stages:
        counts = faults.record(stage).counts
        can_fail = plan.fallible(counts)
        words = [f"{name} {count}" if name in can_fail else f"({name} {count})"
                 for name, count in sorted(counts.items())]
        print(f"{stage.name}: {len(can_fail)} functions that can fail, "
              f"{sum(can_fail.values())} calls: {', '.join(words)}", flush=True)


def run(words):
    faults = Faults(words, judge.SUITE if words.suite else judge.FULL)
    stages = [BY_NAME[name] for name in words.stage] or STAGES
    if words.calls:
        print_calls(faults, stages)
        return 0
    print(HEADER)
    if words.suite:
        for name, fault in plan.SHORT:
            faults.plant(BY_NAME[name], fault)
    elif words.sites:
        chooser = random.Random(words.seed)
        drawn = ((stage, plan.random_fault(chooser, faults.record(stage).counts))
                 for stage in plan.random_stages(words.seed))
        for stage, fault in itertools.islice((one for one in drawn if one[1]), words.sites):
            faults.plant(stage, fault)
    else:
        for stage in stages:
            for fault in plan.faults_in(faults.record(stage).counts):
                if words.only in fault.text():
                    faults.plant(stage, fault)
    faults.end_life()
    faults.say_end()
    return 1 if faults.bad else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("viewloomd")
    parser.add_argument("layers")
    parser.add_argument("--suite", action="store_true", help="a handful of faults")
    parser.add_argument("--stage", action="append", default=[], choices=list(BY_NAME))
    parser.add_argument("--only", default="", metavar="TEXT", help="faults with TEXT in them")
    parser.add_argument("--sites", type=int, default=0, metavar="COUNT", help="random calls")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--calls", action="store_true", help="list the functions, plant nothing")
    parser.add_argument("--verbose", action="store_true", help="all about what is not in order")
    return run(parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
