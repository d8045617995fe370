# SPDX-License-Identifier: Apache-2.0
"""The healthy pair beside one client of each kind, and beside eight at once; the pieces that engine
work is cut into meanwhile; and memory."""

import json
import os
import re
import time
from pathlib import Path

import loads
import metrics
import verdicts
from attack_parts import HealthyPair, Meter, RATE_HZ, Server, measure
from clients import Session
from identities import Identities

BUDGET_BYTES = 4 << 30
MIB = 1 << 20
WARM_UP_S = 180
QUIET_SHARE = 0.1  # of one core: the warm-up is over
ALONE_S = 3.0
LOAD_USED_S = 3.0
FIRST_PICTURE_S = 30.0  # the most costly lens compiles for 10 s, and is drawn in pieces
FIRST_SHARE = 0.2  # of the time with eight clients, until all have begun
# Some 8 times the engine time of its share, at 10 Hz.
SECOND = loads.quilt(4096)
WORKS = ("trace", "piece", "pack", "build")


def wait_until_warm(meter):
    """Until the server has made its small pictures."""
    end_s = time.monotonic() + WARM_UP_S
    while time.monotonic() < end_s:
        before_s = meter.cpu_s()
        time.sleep(1)
        if meter.cpu_s() - before_s < QUIET_SHARE:
            return
    raise RuntimeError(f"the server was still busy after {WARM_UP_S} s")


class Scene:
    """A server with a budget and identities, and the healthy pair."""

    def __init__(self, program, its_form, client_count=8):
        self.form = its_form
        self.identities = Identities(program)
        self.tokens = [self.identities.add(f"client-{number}") for number in range(client_count)]
        self.pair_token = self.identities.add("healthy")
        self.second_token = self.identities.add("second")
        settings = self.identities.settings() + ("--memory.budget", str(BUDGET_BYTES))
        self.server = Server(program, settings=settings, warms_up=its_form.is_long)

    def __enter__(self):
        self.server.__enter__()
        self.address = self.server.address
        self.meter = Meter(self.server.process.pid)
        self.peak_mib = 0.0
        if self.form.is_long:
            wait_until_warm(self.meter)
        elif self.form.is_warm:
            self.use_every_kind()
        self.pair = HealthyPair(self.address, self.pair_token)
        return self

    def __exit__(self, *_):
        self.pair.stop()
        self.server.__exit__()
        self.identities.__exit__()

    def metrics(self):
        return metrics.read(self.address, self.identities.operator)

    def memory_mib(self, name):
        status = Path(f"/proc/{self.server.process.pid}/status").read_text()
        return int(re.search(name + r":\s+(\d+) kB", status).group(1)) / 1024

    def note_peak(self):
        self.peak_mib = max(self.peak_mib, self.memory_mib("VmHWM"))

    def use_every_kind(self):
        """One picture of each, which also compiles what they need."""
        with Session(self.address, self.tokens[0], "every-kind") as session:
            session.publish(loads.scene(layer_count=2))
            requests = [one for kind in loads.KINDS for one in loads.requests_of(kind)]
            session.watch_in_turn(requests).join()
            print(f"every kind once: {session.atlases()} pictures, refused "
                  f"{session.refusals() or 'nothing'}", flush=True)

    def use_every_load(self):
        """One picture of each, if it comes in time, and more for a moment. Kernels that some ask
        for stay, and so do the last frames of streams, which have the names that rows give them."""
        without = set()
        for number, load in [*enumerate(loads.EIGHT), *((0, load) for load in loads.SINGLE)]:
            with Session(self.address, self.tokens[number], f"client{number}") as session:
                load(session)
                deadline = time.monotonic() + FIRST_PICTURE_S
                while not session.atlases() and time.monotonic() < deadline:
                    time.sleep(0.1)
                time.sleep(LOAD_USED_S)
                if not session.atlases():
                    without.add(load.__name__)
        print(f"every load for a moment: no picture of {sorted(without) or 'none'}", flush=True)

    def row(self, name, its_loads, its_budget, during=time.sleep):
        """Each load has an identity of its own. during: waits for so many seconds."""
        sessions = []
        cpu_s = []

        def act(address, budget):
            begun_s = time.process_time()
            for number, load in enumerate(its_loads):
                session = Session(address, self.tokens[number], f"client{number}")
                sessions.append(session)
                load(session)
            during(budget.seconds)
            for session in sessions:
                session.close()
            cpu_s.append(time.process_time() - begun_s)

        act.__name__ = name
        before = self.metrics()
        result = measure(act, self.server, self.pair, self.meter, self.address, its_budget)
        predicted_s = measured_s = 0.0
        if self.server.is_alive():
            self.note_peak()
            predicted_s, measured_s = (pieces.quantile(0.99)
                                       for pieces in pieces_between(before, self.metrics()))
        return verdicts.BesideRow(
            name, result.pictures, result.pictures_due, result.longest_gap_s, result.rest_gap_s,
            cpu_s[0], result.cpu_s, sum(one.atlases() for one in sessions),
            predicted_s, measured_s,
            sorted({text for one in sessions for text in one.refusals()}), result.found)


def engine_s(before, after):
    name = "viewloom_engine_seconds_total"
    return after.value(name) - before.value(name)


def second_s(before, after):
    """Engine time for the second pair."""
    name = "viewloom_client_engine_seconds_total"
    return after.value(name, client="second") - before.value(name, client="second")


def beside_eight(scene, its_loads):
    """The row of the healthy pair, and the share of a second pair that asks for more."""
    pair = HealthyPair(scene.address, scene.second_token,
                       ("--stream", "second", "--display", json.dumps(SECOND)))
    try:
        pair.take_count()
        before = scene.metrics()
        time.sleep(ALONE_S)
        picture_s = second_s(before, scene.metrics()) / max(1, pair.take_count()["seen"])
        counts = []

        def watch_share(seconds):
            time.sleep(FIRST_SHARE * seconds)
            begun_s, earlier = time.monotonic(), scene.metrics()
            time.sleep((1 - FIRST_SHARE) * seconds)
            took_s, later = time.monotonic() - begun_s, scene.metrics()
            counts.append((took_s, second_s(earlier, later), max(engine_s(earlier, later), 1e-9)))

        row = scene.row("eight_clients", its_loads, scene.form.many, watch_share)
    finally:
        pair.stop()
    took_s, its_s, total_s = counts[0]
    demand = RATE_HZ * took_s * picture_s / total_s
    return row, verdicts.ShareRow(demand, its_s / total_s)


def pieces_between(before, after, **labels):
    """Histograms of times as predicted, and as measured."""
    return [metrics.Histogram.between(before, after, name, **labels)
            for name in ("viewloom_predicted_piece_seconds", "viewloom_piece_seconds")]


def piece_rows(before, after):
    """Each kind of work that there was enough of, and all together."""
    for labels in [{"work": work} for work in WORKS] + [{}]:
        predicted, measured = pieces_between(before, after, **labels)
        longest = max(after.value("viewloom_longest_piece_seconds", work=work)
                      for work in labels.values() or WORKS)
        if labels and measured.count() < verdicts.PIECES_NEEDED:
            continue
        yield verdicts.PieceRow(labels.get("work", "all"), int(measured.count()),
                                predicted.quantile(0.99), measured.quantile(0.99), longest)


def run(program, its_form):
    limits, rows = its_form.limits, []

    def tell(row):
        rows.append(row)
        print(row.text(), flush=True)

    with Scene(program, its_form) as scene:
        print(f"identities by token, budget {BUDGET_BYTES / MIB:.0f} MiB, cores {os.cpu_count()}\n"
              f"{verdicts.BesideRow.HEADER}")
        if its_form.is_long:
            for load in loads.FIRST_USES:
                row = scene.row(load.__name__, [load], its_form.client)
                tell(verdicts.judged_beside(row, limits))
            scene.use_every_kind()
            scene.use_every_load()
        time.sleep(its_form.settle_s)
        rest_mib, before = scene.memory_mib("VmRSS"), scene.metrics()
        for load in loads.SINGLE if its_form.is_long else loads.SINGLE_SHORT:
            row = scene.row(load.__name__, [load], its_form.client)
            tell(verdicts.judged_beside(row, limits))
        row, share = beside_eight(scene, loads.EIGHT if its_form.is_long else loads.EIGHT_SHORT)
        tell(verdicts.judged_beside_many(row, limits))
        after = scene.metrics()
        print(f"\n{verdicts.ShareRow.HEADER}")
        tell(verdicts.judged_share(share, limits))
        print(f"\n{verdicts.PieceRow.HEADER}")
        for piece_row in piece_rows(before, after):
            tell(verdicts.judged_pieces(piece_row, limits))
        time.sleep(its_form.settle_s)
        print(f"\n{verdicts.MemoryRow.HEADER}")
        tell(verdicts.judged_memory(verdicts.MemoryRow(
            after.value("viewloom_memory_budget_bytes") / MIB, rest_mib, scene.peak_mib,
            scene.memory_mib("VmRSS")), limits))
    return rows
