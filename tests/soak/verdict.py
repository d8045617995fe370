# SPDX-License-Identifier: Apache-2.0
"""What a soak has shown."""

import os
from dataclasses import dataclass, field

from trend import trend_of

FAILED_SHARE = 0.02
# The pools of the gRPC library grow up to twice the cores.
MORE_AT_END = {"descriptors": 0, "threads": 0, "pool_threads": 2 * os.cpu_count()}


@dataclass
class Series:
    """Readings at rest, and how many cycles went before each."""
    cycles: list = field(default_factory=list)
    readings: list = field(default_factory=list)

    def add(self, cycles, reading):
        self.cycles.append(cycles)
        self.readings.append(reading)

    def trend(self):
        return trend_of(self.cycles, [one.heap for one in self.readings])


@dataclass
class Verdict:
    lines: list = field(default_factory=list)
    leaks: list = field(default_factory=list)    # what is lost for certain
    unproven: list = field(default_factory=list)  # what the soak was too short for

    def text(self):
        found = [f"LEAK: {leak}" for leak in self.leaks] + [f"not shown: {one}"
                                                            for one in self.unproven]
        return "\n".join([*self.lines, *(found or ["ok"])])


def judged(series, cycles, failures, most_bytes):
    """cycles: all. failures: by words, of clients. most_bytes: of the heap, a cycle."""
    verdict = Verdict()
    judge_heap(series, most_bytes, verdict)
    begin, end = series.readings[0], series.readings[-1]
    for name, allowed in MORE_AT_END.items():
        before, after = getattr(begin, name), getattr(end, name)
        words = name.replace("_", " ")
        verdict.lines.append(f"{words}: {before} at the begin, {after} at the end")
        if after > before + allowed:
            verdict.leaks.append(f"{after - before} {words}")
    failed = sum(failures.values())
    verdict.lines.append(f"clients: {cycles:,}, of which {failed:,} failed")
    verdict.lines += [f"  {count} x {words}" for words, count in failures.most_common(8)]
    if failed > FAILED_SHARE * cycles:
        verdict.unproven.append(f"{failed:,} of {cycles:,} clients failed")
    return verdict


def judge_heap(series, most_bytes, verdict):
    trend, count = series.trend(), len(series.readings)
    if trend is None:
        verdict.unproven.append(f"the heap: {count} readings are too few")
        return
    verdict.lines.append(f"heap: {trend.text()}, from {count} readings; at most {most_bytes}")
    if trend.low > most_bytes:
        verdict.leaks.append(f"heap: {trend.text()}")
    elif trend.high > most_bytes:
        verdict.unproven.append(f"heap: the interval reaches beyond {most_bytes} bytes a cycle")
