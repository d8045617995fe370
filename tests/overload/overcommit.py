# SPDX-License-Identifier: Apache-2.0
"""More streams than the machine can make pictures of: pictures a second, what each costs, and how
fast a server that is this busy refuses."""

import statistics
import time
from dataclasses import dataclass, field

import grpc
from google.protobuf import json_format

import loads
import metrics
import verdicts
from attack_parts import Meter, Server
from clients import Session
from viewloom.v1 import display_service_pb2 as display_service
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub

STREAM_COUNTS = (8, 10, 12, 14, 28, 56)
SHORT_COUNTS = (8, 56)
RATE_HZ = 10
DISPLAY = loads.quilt(512)
# Each is refused: because of what is asked, and the last because there are enough displays.
REFUSED = ({"preset": "there-is-none"}, loads.quilt(512, 51), loads.quilt(500))
SETTINGS = ("--limits.displays_max", str(STREAM_COUNTS[-1]), "--limits.streams_max",
            str(STREAM_COUNTS[-1]))
REFUSAL_COUNT = 20


@dataclass
class LoadRow:
    streams: int
    atlases_hz: float
    server_ms: float   # CPU time for each atlas
    server_cores: float
    client_cores: float
    runs: int
    found: list = field(default_factory=list)

    HEADER = ("| streams | atlases a second | a CPU second of the server | CPU of server, ms each "
              "| cores of server | of clients | runs | verdict |\n"
              "|---|---|---|---|---|---|---|---|")

    def per_cpu_s(self):
        return 1e3 / self.server_ms if self.server_ms else 0.0

    def text(self):
        return (f"| {self.streams} | {self.atlases_hz:.1f} | {self.per_cpu_s():.0f} "
                f"| {self.server_ms:.2f} "
                f"| {self.server_cores:.2f} | {self.client_cores:.2f} | {self.runs} "
                f"| {verdicts.verdict(self)} |")


def judged_loads(rows, limits):
    """Rows with more and more streams."""
    best = max(row.per_cpu_s() for row in rows)
    most_hz = 0.0
    for row in rows:
        if row.per_cpu_s() < limits.efficiency * best:
            row.found.append(f"{row.per_cpu_s():.0f} pictures a CPU second, the best is {best:.0f}")
        if row.atlases_hz < limits.rate_kept * most_hz:
            row.found.append(f"{most_hz:.0f} pictures a second came of fewer streams")
        most_hz = max(most_hz, row.atlases_hz)
    return rows


@dataclass
class RefusalRow:
    """Calls that are refused while the server has more to do than it can: round trips, and what
    passes inside the server from the message to its refusal."""
    median_s: float
    p90_s: float
    rest_median_s: float  # the same of a server with nothing to do
    inside_p99_s: float
    count: int
    found: list = field(default_factory=list)

    HEADER = ("| refusal inside the server, ms, 99 of 100 | round trip under load, median "
              "| 90 of 100 | at rest, median | calls | verdict |\n|---|---|---|---|---|---|")

    def text(self):
        return (f"| {self.inside_p99_s * 1e3:.1f} | {self.median_s * 1e3:.1f} "
                f"| {self.p90_s * 1e3:.1f} "
                f"| {self.rest_median_s * 1e3:.1f} | {self.count} | {verdicts.verdict(self)} |")


def judged_refusal(row, limits):
    if row.inside_p99_s > limits.refusal_s:
        row.found.append(f"{row.inside_p99_s * 1e3:.1f} ms, at most {limits.refusal_s * 1e3:.0f}")
    return row


def refusals_s(channel):
    stub = DisplayServiceStub(channel)
    times_s = []
    for number in range(REFUSAL_COUNT):
        request = json_format.ParseDict(
            {"open": {"stream": "load0", "display": REFUSED[number % len(REFUSED)]}},
            display_service.StreamAtlasesRequest())
        begun_s = time.monotonic()
        try:
            next(stub.StreamAtlases(iter([request]), timeout=5))
        except grpc.RpcError as error:
            if error.code() != grpc.StatusCode.DEADLINE_EXCEEDED:
                times_s.append(time.monotonic() - begun_s)
        time.sleep(0.02)
    return sorted(times_s) or [float("inf")]


def load_row(server, meter, count, seconds):
    before, begun_cpu_s, sessions = None, 0.0, []
    try:
        for number in range(count):
            session = Session(server.address, "", f"load{number}")
            sessions.append(session)
            session.publish(loads.scene(layer_count=2), RATE_HZ)
            session.watch(DISPLAY)
        time.sleep(0.2 * seconds + 0.5)  # until all have begun
        meter.start()
        before, begun_cpu_s = sum(one.atlases() for one in sessions), time.process_time()
        time.sleep(seconds)
        took_s = time.monotonic() - meter.begun_s
        atlases = sum(one.atlases() for one in sessions) - before
        cpu_s = meter.used_cpu_s()
        row = LoadRow(count, atlases / took_s, 1e3 * cpu_s / max(1, atlases), cpu_s / took_s,
                      (time.process_time() - begun_cpu_s) / took_s, 1)
        with server.address.channel() as channel:
            return row, refusals_s(channel) if count == STREAM_COUNTS[-1] else []
    finally:
        for session in sessions:
            session.close()


def median_row(rows):
    def middle(name):
        return statistics.median(getattr(row, name) for row in rows)
    return LoadRow(rows[0].streams, middle("atlases_hz"), middle("server_ms"),
                   middle("server_cores"), middle("client_cores"), len(rows))


def run(program, its_form):
    counts = STREAM_COUNTS if its_form.is_long else SHORT_COUNTS
    run_count, seconds = (5, 8.0) if its_form.is_long else (1, 2.0)
    measured = {count: [] for count in counts}
    refused_s = []
    with Server(program, settings=SETTINGS) as server:
        meter = Meter(server.process.pid)
        with server.address.channel() as channel:
            rest_s = refusals_s(channel)
        before = metrics.read(server.address)
        for _ in range(run_count):
            for count in counts:
                row, times_s = load_row(server, meter, count, seconds)
                measured[count].append(row)
                refused_s += times_s
                time.sleep(0.5)
        snapshot = metrics.read(server.address)
    rows = judged_loads([median_row(measured[count]) for count in counts], its_form.limits)
    print(LoadRow.HEADER)
    for row in rows:
        print(row.text())
    refused_s.sort()
    inside = metrics.Histogram.between(before, snapshot, "viewloom_call_refusal_seconds")
    refusal = judged_refusal(
        RefusalRow(statistics.median(refused_s), refused_s[int(0.9 * len(refused_s))],
                   statistics.median(rest_s), inside.quantile(0.99), len(refused_s)),
        its_form.limits)
    pictures = snapshot.value("viewloom_atlases_traced_total")
    print(f"\n{RefusalRow.HEADER}\n{refusal.text()}\nframes prepared for each picture: "
          f"{snapshot.value('viewloom_structures_built_total') / max(1, pictures):.2f}", flush=True)
    return [*rows, refusal]
