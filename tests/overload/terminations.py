# SPDX-License-Identifier: Apache-2.0
"""SIGTERM at random moments of a server that makes what costs most: it ends in order, soon, and
every atlas that ended was whole."""

import io
import random
import signal
import subprocess
import threading
import time
from dataclasses import dataclass, field

import grpc
from google.protobuf import json_format
from PIL import Image

import loads
import verdicts
from attack_parts import Server
from clients import WATCH, Session
from viewloom.atlas_inbox import AtlasInbox
from viewloom.errors import ViewloomError
from viewloom.v1 import display_service_pb2 as display_service

COSTLY = (loads.watching({**loads.LENS_MAX, "quality": "QUALITY_BEST"}, "best_lens"),
          loads.filter_at_maximum, loads.reflections_at_maximum, loads.large_quilt,
          loads.large_quilt_in_world, loads.tracked_and_flooded, loads.displays_at_240_hz,
          loads.small_bombs)
LOADS_MAX = 3
WATCHED = loads.quilt(512)
FIRST_S = 10.0  # until the whole viewer has a picture; then the moment is drawn
PATIENCE_S = 60


class Wholeness:
    """Puts atlases together, and finds those that ended torn."""

    def __init__(self, stream):
        self.atlases = 0
        self.torn = []
        self.first = threading.Event()
        self._inbox = AtlasInbox(stream)

    def take(self, response):
        try:
            self._inbox.add(response)
            atlas = self._inbox.take()
            if atlas is not None:
                self.atlases += 1
                Image.open(io.BytesIO(atlas.jpeg)).load()
                self.first.set()
        except (ViewloomError, OSError, ValueError) as error:
            self.torn.append(str(error))


class WholeViewer(Wholeness):
    """Watches, until the server ends."""

    def __init__(self, channel, stream, display):
        super().__init__(stream)
        request = json_format.ParseDict(
            {"open": {"stream": stream, "display": display, "wait_for_stream": True}},
            display_service.StreamAtlasesRequest())
        self._call = channel.stream_stream(
            WATCH, display_service.StreamAtlasesRequest.SerializeToString,
            display_service.StreamAtlasesResponse.FromString)(iter([request]))
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self):
        try:
            for response in self._call:
                self.take(response)
        except grpc.RpcError:
            pass  # the server has ended

    def join(self):
        self._thread.join(PATIENCE_S)


@dataclass
class ExitRow:
    seed: int
    work: str
    after_s: float  # from the first picture to SIGTERM
    took_s: float   # from SIGTERM to the end
    code: int
    atlases: int
    torn: list
    found: list = field(default_factory=list)

    HEADER = ("| seed | work | SIGTERM after, s | end after, s | exit code | atlases | torn "
              "| verdict |\n|---|---|---|---|---|---|---|---|")

    def text(self):
        return (f"| {self.seed} | {self.work} | {self.after_s:.2f} | {self.took_s:.2f} "
                f"| {self.code} | {self.atlases} | {len(self.torn)} | {verdicts.verdict(self)} |")


def judged_exit(row, limits):
    if row.code != 0:
        row.found.append(f"exit code {row.code}")
    if row.torn:
        row.found.append(f"torn: {row.torn[0]}")
    if row.took_s > limits.exit_s:
        row.found.append(f"took {row.took_s:.1f} s, at most {limits.exit_s:.0f}")
    return row


def summary(rows):
    clean = sum(not row.found for row in rows)
    torn = sum(len(row.torn) for row in rows)
    return (f"{clean} of {len(rows)} clean, {torn} of {sum(row.atlases for row in rows)} atlases "
            f"torn, the longest took {max(row.took_s for row in rows):.1f} s")


def end(process, patience_s=PATIENCE_S):
    """(exit code, seconds); kills what does not end."""
    begun_s = time.monotonic()
    process.send_signal(signal.SIGTERM)
    try:
        code = process.wait(patience_s)
    except subprocess.TimeoutExpired:
        process.kill()
        code = process.wait()
    return code, time.monotonic() - begun_s


def exit_row(program, seed, moment_max_s):
    chance = random.Random(seed)
    works = chance.sample(COSTLY, chance.randint(1, LOADS_MAX))
    after_s = chance.uniform(0, moment_max_s)
    with Server(program) as server, server.address.channel() as channel:
        sessions = [Session(server.address, "", f"costly{number}")
                    for number in range(len(works) + 1)]
        sessions[-1].publish(loads.scene(160, 90), name="whole")
        viewer = WholeViewer(channel, "whole", WATCHED)
        viewer.first.wait(FIRST_S)
        for session, work in zip(sessions, works):
            work(session)
        time.sleep(after_s)
        code, took_s = end(server.process)
        viewer.join()
        for session in sessions:
            session.close()
    return ExitRow(seed, ", ".join(work.__name__ for work in works), after_s, took_s, code,
                   viewer.atlases, viewer.torn)


def run(program, its_form):
    rows = []
    print(ExitRow.HEADER)
    for seed in range(its_form.first, its_form.first + its_form.count):
        row = exit_row(program, seed, 4.0 if its_form.is_long else 1.0)
        rows.append(judged_exit(row, its_form.limits))
        print(row.text(), flush=True)
    print(summary(rows), flush=True)
    return rows
