# SPDX-License-Identifier: Apache-2.0
"""A publisher of 10 Hz and one viewer of a small quilt, which an attack must not disturb.

Argument: HOST:PORT. Prints "ready" when pictures come. Each line on standard input begins a new
count; its answer is what was due, what was seen, and the longest gap, as JSON. The end of the input
ends the pair.
"""

import json
import sys
import threading
import time

import numpy as np

import viewloom

RATE_HZ = 10
WIDTH_PX, HEIGHT_PX = 96, 72
QUILT = {"quilt": {"columns": 4, "rows": 2, "size": {"width": 384, "height": 144},
                   "view_cone_rad": 0.3, "focal_distance_m": 3.0}}


def source(number):
    color = np.full((HEIGHT_PX, WIDTH_PX, 3), number % 200, np.uint8)
    color[20:50, 30:60] = (200, 40, 30)
    depth_m = np.full((HEIGHT_PX, WIDTH_PX), 4.0, np.float32)
    depth_m[20:50, 30:60] = 2.0
    return viewloom.Source(color, depth_m, fov_y_rad=0.9)


class Count:
    """Pictures due and seen since its begin. Thread-safety: none, Python's own lock is enough."""

    def __init__(self):
        self.begun_s = self.last_s = time.monotonic()
        self.due = self.seen = 0
        self.longest_gap_s = 0.0

    def see(self):
        now_s = time.monotonic()
        self.longest_gap_s = max(self.longest_gap_s, now_s - self.last_s)
        self.last_s = now_s
        self.seen += 1

    def result(self):
        gap_s = max(self.longest_gap_s, time.monotonic() - self.last_s)
        return {"due": self.due, "seen": self.seen, "longest_gap_s": round(gap_s, 3)}


class Pair:
    def __init__(self, address):
        self.count = Count()
        self.stopping = threading.Event()
        self.server = viewloom.connect(address)
        self.first_picture = threading.Event()
        self.threads = [threading.Thread(target=self.publish, daemon=True),
                        threading.Thread(target=self.watch, daemon=True)]
        for thread in self.threads:
            thread.start()

    def publish(self):
        with self.server.publish("healthy") as publisher:
            number, next_s = 0, time.monotonic()
            while not self.stopping.wait(max(0, next_s - time.monotonic())):
                next_s = max(next_s + 1 / RATE_HZ, time.monotonic() - 1)
                number += 1
                self.count.due += 1
                publisher.send(source(number))

    def watch(self):
        time.sleep(0.5)  # the stream is there then
        with self.server.watch("healthy", QUILT) as watcher:
            while not self.stopping.is_set():
                watcher.receive(60)
                self.count.see()
                self.first_picture.set()


def main(address):
    pair = Pair(address)
    if not pair.first_picture.wait(60):
        sys.exit("no picture came within 60 s")
    print("ready", flush=True)
    for _ in sys.stdin:
        count, pair.count = pair.count, Count()
        print(json.dumps(count.result()), flush=True)
    pair.stopping.set()


if __name__ == "__main__":
    main(sys.argv[1])
