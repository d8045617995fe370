# SPDX-License-Identifier: Apache-2.0
"""A server that clients churn for a while, and what it holds at rest, round after round."""

import contextlib
import subprocess
import time
from dataclasses import dataclass

import viewloom
from chores import Chores
from churn import Churn
from faults import FAULTS
from pages import PAGES
from place import Protection, served
from readings import Gauges
from trend import SAMPLES_LEAST
from verdict import Series, judged
from visits import STREAMS_MAX, SWEPT, SWEPT_VISITS, VISITS, Visit, leave_alike, show_all

# At most this long, files and threads of clients that have left are waited for at the end.
END_S = 30
SETTLED_S = 0.5
ENDING_S = 5  # a process that was killed ends within this


@dataclass(frozen=True)
class Plan:
    """seconds: of the rounds that count, at least eight. round_s: how long clients come and go
    before a reading. idle_s: patience for buffers that wait for reuse. settling: rounds that fill
    caches. streams_left: see leave_alike()."""
    seconds: float
    round_s: float
    idle_s: float
    looks_s: float
    settling: int
    workers: int = 4
    actions: tuple = VISITS + FAULTS + PAGES
    kinds: tuple = Visit.kinds
    streams_left: int = STREAMS_MAX
    most_bytes: int = 4  # of the heap, a cycle


# Too short for small losses: caches fill meanwhile.
SUITE = Plan(seconds=20, round_s=1.0, idle_s=0, looks_s=0.3, settling=2, workers=3,
             actions=SWEPT_VISITS + FAULTS + PAGES, kinds=SWEPT, most_bytes=16384,
             streams_left=0)
SHORT = Plan(seconds=600, round_s=6, idle_s=6, looks_s=1, settling=12)
HOUR = Plan(seconds=3600, round_s=12, idle_s=6, looks_s=1, settling=24)


def soak(program, plan, is_protected=False, environment=None, say=print):
    """The verdict."""
    with contextlib.ExitStack() as parts:
        protection = Protection(program) if is_protected else None
        chores = None
        if protection:
            parts.callback(protection.close)
            chores = Chores(protection)
        server, place = parts.enter_context(served(program, protection, environment))
        gauges = Gauges(place)
        churn = Churn(place, plan.actions, plan.kinds, plan.workers)
        show_all(churn.visit(0, 0))
        series = Series()
        begun_s = None
        while (begun_s is None or len(series.readings) < SAMPLES_LEAST or
               time.monotonic() < begun_s + plan.seconds):
            if len(series.readings) == plan.settling and begun_s is None:
                say(f"settled after {churn.cycles:,} cycles: {series.readings[-1]}"
                    if series.readings else "begun")
                series, begun_s = Series(), time.monotonic()
            if chores:
                chores.next()
            churn.run(plan.round_s)
            with ended_server_named(server):
                leave_alike(place, plan.streams_left)
                series.add(churn.cycles, gauges.at_rest(plan.idle_s, plan.looks_s))
            say_now_and_then(series, say)
        series.readings[-1] = last_reading(gauges, plan, series.readings[0])
        return judged(series, churn.cycles, churn.failures, plan.most_bytes)


@contextlib.contextmanager
def ended_server_named(server):
    """Clients fail where the server has ended: that is the error then."""
    try:
        yield
    except (OSError, viewloom.ViewloomError):
        with contextlib.suppress(subprocess.TimeoutExpired):
            server.process.wait(ENDING_S)
            raise RuntimeError(f"the server ended with {server.process.returncode}") from None
        raise


def say_now_and_then(series, say):
    if len(series.readings) % 10 == 0:
        reading = series.readings[-1]
        say(f"{series.cycles[-1]:,} cycles: heap {reading.heap:,} bytes, "
            f"{reading.descriptors} descriptors, {reading.threads} threads")


def last_reading(gauges, plan, first):
    """Once files and threads are as at the begin, or no longer expected to become so."""
    end_s = time.monotonic() + END_S
    while True:
        reading = gauges.at_rest(plan.idle_s, plan.looks_s)
        is_back = (reading.descriptors <= first.descriptors and reading.threads <= first.threads)
        if is_back or time.monotonic() > end_s:
            return reading
        time.sleep(SETTLED_S)
