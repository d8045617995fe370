# SPDX-License-Identifier: Apache-2.0
"""A fast viewer beside 200 that never read and 8 slow ones; and whether those that never read are
cut."""

import statistics
import time
from dataclasses import dataclass, field

import metrics
import verdicts
from attack_parts import HealthyPair, Meter, QUILT, Server
from stalled_viewers import Crowd, Faker, Silent, Slow, Waiting

RATE_HZ = 20
COUNTS = {Silent: 67, Faker: 67, Waiting: 66, Slow: 8}
NEVER_READING = (Silent, Faker, Waiting)
KEEPALIVE_S, UNREAD_S, SHORT_UNREAD_S = 10, 10, 3
# Pings come after that silence, and wait half as long for an answer; a moment to fill windows, and
# to notice.
CUT_AFTER_S = max(1.5 * KEEPALIVE_S, UNREAD_S) + 5


@dataclass
class AgeRow:
    """Medians of the runs: age of the fast viewer's pictures that 99 of 100 do not exceed."""
    alone_s: float
    beside_s: float
    dropped: int  # in all runs
    runs: int
    client_cpu_s: float
    found: list = field(default_factory=list)

    HEADER = ("| p99 age alone, ms | beside the others | ratio | dropped | runs "
              "| CPU of clients, s | verdict |\n|---|---|---|---|---|---|---|")

    def text(self):
        return (f"| {self.alone_s * 1e3:.1f} | {self.beside_s * 1e3:.1f} "
                f"| {self.beside_s / self.alone_s:.2f} | {self.dropped} "
                f"| {self.runs} | {self.client_cpu_s:.1f} | {verdicts.verdict(self)} |")


def judged_age(row, limits):
    if row.dropped > limits.dropped:
        row.found.append(f"dropped: {row.dropped}")
    most_s = max(limits.age_ratio * row.alone_s, row.alone_s + limits.age_more_s)
    if row.beside_s > most_s:
        row.found.append(f"age: {row.beside_s * 1e3:.1f} ms, at most {most_s * 1e3:.1f}")
    return row


@dataclass
class CutRow:
    """Viewers of one kind."""
    kind: str
    count: int
    cut: int
    last_s: float
    found: list = field(default_factory=list)

    HEADER = "| viewers | count | cut | the last after, s | verdict |\n|---|---|---|---|---|"

    def text(self):
        return (f"| {self.kind} | {self.count} | {self.cut} | {self.last_s:.1f} "
                f"| {verdicts.verdict(self)} |")


def cut_row(address, kind, before_count, after_s=CUT_AFTER_S):
    """Waits until the server has cut all viewers of that kind, or that time is over. before_count:
    viewers that it had before."""
    count = COUNTS[kind]
    with Crowd(address, "healthy", QUILT, {kind: count}):
        begun_s = time.monotonic()
        left, last_s = count, 0.0
        time.sleep(1)  # all have opened
        while left and time.monotonic() < begun_s + after_s:
            time.sleep(0.5)
            now = int(metrics.read(address).value("viewloom_subscribers", transport="grpc"))
            if now - before_count < left:
                left, last_s = now - before_count, time.monotonic() - begun_s
    return CutRow(kind.__name__, count, count - left, last_s)


def judged_cut(row, is_to_be_cut):
    if is_to_be_cut and row.cut < row.count:
        row.found.append(f"{row.count - row.cut} never read and were not cut")
    if not is_to_be_cut and row.cut:
        row.found.append(f"{row.cut} read slowly and were cut")
    return row


def measured(pair, seconds):
    pair.take_count()
    time.sleep(seconds)
    return pair.take_count()


def age_row(server, pair, run_count, seconds):
    """Runs alone and beside the others, by turns."""
    alone_s, beside_s, dropped = [], [], 0
    begun_s = time.process_time()
    for _ in range(run_count):
        alone_s.append(measured(pair, seconds)["age_p99_s"])
        with Crowd(server.address, "healthy", QUILT, COUNTS):
            time.sleep(1)  # all have opened
            count = measured(pair, seconds)
        beside_s.append(count["age_p99_s"])
        dropped += count["dropped"]
        time.sleep(1)  # all have gone
    return AgeRow(statistics.median(alone_s), statistics.median(beside_s), dropped, run_count,
                  time.process_time() - begun_s)


def run(program, its_form):
    rows = []

    def tell(header, row):
        rows.append(row)
        print(f"{header}\n{row.text()}", flush=True)

    run_count, seconds = (5, 8.0) if its_form.is_long else (1, 1.5)
    kinds, unread_s = ((tuple(COUNTS), UNREAD_S) if its_form.is_long else
                       ((Waiting,), SHORT_UNREAD_S))
    settings = ("--grpc.keepalive_s", str(KEEPALIVE_S), "--grpc.unread_s", str(unread_s))
    with Server(program, settings=settings) as server:
        meter = Meter(server.process.pid)
        pair = HealthyPair(server.address, options=("--rate", str(RATE_HZ)))
        try:
            meter.start()
            row = age_row(server, pair, run_count, seconds)
            tell(AgeRow.HEADER, judged_age(row, its_form.limits))
            print(f"server: {meter.used_cpu_s():.1f} s of CPU time, "
                  f"{meter.peak_growth_mib():.0f} MiB more at its peak")
            for kind in kinds:
                time.sleep(1)  # those before have gone
                row = cut_row(server.address, kind, before_count=1)
                tell(CutRow.HEADER, judged_cut(row, kind in NEVER_READING))
        finally:
            pair.stop()
    return rows
