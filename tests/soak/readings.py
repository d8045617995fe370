# SPDX-License-Identifier: Apache-2.0
"""What a server holds: its heap, its files and its threads."""

import contextlib
import http.client
import os
import re
import time
from dataclasses import dataclass
from pathlib import Path

# Gauges of clients. The scrape itself is one HTTP connection.
BUSY = ("viewloom_subscribers", "viewloom_streams_live", "viewloom_displays",
        "viewloom_grpc_connections")
HTTP, OWN_CONNECTIONS = "viewloom_http_connections", 1
HEAP, IDLE = "viewloom_memory_heap_bytes", "viewloom_memory_idle_bytes"
# Names of threads of the gRPC library, as the system cuts them off.
POOLS = ("default-executo", "event_engine", "grpc_global_tim", "nexting_thread", "resolver-execut",
         "timer_manager")
LOOK_S = 0.2
ANSWER_S = 30


@dataclass(frozen=True)
class Reading:
    """At rest: nobody is connected. heap: bytes that are lent, without what waits for reuse.
    threads: without those of the gRPC library's pools, which grow with the load."""
    heap: int
    descriptors: int
    threads: int
    pool_threads: int


def sums_of(text):
    """The metrics of Prometheus' text by name; those with labels are added up."""
    sums = {}
    for name, value in re.findall(r"^(\w+)(?:\{[^}]*\})? (\S+)$", text, re.MULTILINE):
        sums[name] = sums.get(name, 0) + float(value)
    return sums


class Gauges:
    """Reads a server's gauges, each time over a connection of its own. rest_s: within this, a
    server notices that clients have left."""

    def __init__(self, place, rest_s=60):
        self.place = place
        self.rest_s = rest_s

    def read(self):
        one = http.client.HTTPConnection("localhost", timeout=ANSWER_S)
        one.sock = self.place.address.connect(self.place.address.http_port, ("http/1.1",))
        try:
            one.request("GET", "/metrics", headers={
                "Host": f"localhost:{self.place.address.http_port}", **dict(self.place.metadata)})
            answer = one.getresponse()
            text = answer.read().decode()
        finally:
            one.close()
        if answer.status != 200:
            raise RuntimeError(f"/metrics answered {answer.status}: {text[:200]}")
        return sums_of(text)

    def is_at_rest(self, sums):
        return (not any(sums[name] for name in BUSY) and
                sums[HTTP] <= OWN_CONNECTIONS)

    def counted(self):
        """Open files, threads, and threads of pools of the process."""
        process = Path(f"/proc/{self.place.pid}")
        names = []
        for thread in (process / "task").iterdir():
            with contextlib.suppress(OSError):  # it has just ended
                names.append((thread / "comm").read_text().strip())
        pooled = sum(name in POOLS for name in names)
        return len(os.listdir(process / "fd")), len(names) - pooled, pooled

    def at_rest(self, idle_s, looks_s):
        """The smallest values within `looks_s`, once nobody is connected, and once no buffer waits
        for reuse or `idle_s` are over: such buffers are subtracted. RuntimeError: clients that have
        left are still there."""
        begun_s = time.monotonic()
        sums = self.read()
        while not self.is_at_rest(sums) or (sums[IDLE] and time.monotonic() < begun_s + idle_s):
            if time.monotonic() > begun_s + self.rest_s:
                held = {name: sums[name] for name in (*BUSY, HTTP)}
                raise RuntimeError(f"clients that have left are still there: {held}")
            time.sleep(LOOK_S)
            sums = self.read()
        readings = []
        begun_s = time.monotonic()
        while not readings or time.monotonic() < begun_s + looks_s:
            sums = self.read()
            time.sleep(LOOK_S)  # the server closes the connection of this look
            readings.append((sums[HEAP] - sums[IDLE], *self.counted()))
        return Reading(*(int(min(values)) for values in zip(*readings)))
