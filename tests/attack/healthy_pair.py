# SPDX-License-Identifier: Apache-2.0
"""A publisher and one viewer of a small quilt, which an attack must not disturb.

Prints "ready" when pictures come. Each line on standard input begins a new count; its answer is
what was due, what was seen, what was dropped on the way to the viewer, what was lost anywhere, the
longest gap, and how old pictures were when they came, as JSON. The end of the input ends the pair.
"""

import argparse
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
        self.due = self.seen = self.dropped = self.lost = 0
        self.longest_gap_s = 0.0
        self.ages_s = []

    def see(self, atlas, lost):
        now_s = time.monotonic()
        self.longest_gap_s = max(self.longest_gap_s, now_s - self.last_s)
        self.last_s = now_s
        self.seen += 1
        self.dropped += atlas.skipped
        self.lost += lost
        self.ages_s.append((time.time_ns() - atlas.header.capture_time_ns) * 1e-9)

    def result(self):
        gap_s = max(self.longest_gap_s, time.monotonic() - self.last_s)
        ages_s = sorted(self.ages_s) or [float("inf")]
        return {"due": self.due, "seen": self.seen, "dropped": self.dropped,
                "lost": self.lost, "longest_gap_s": round(gap_s, 3),
                "age_p99_s": round(ages_s[int(0.99 * (len(ages_s) - 1))], 4)}


class Pair:
    def __init__(self, words):
        self.words = words
        self.display = json.loads(words.display) if words.display else QUILT
        self.count = Count()
        self.stopping = threading.Event()
        self.server = viewloom.connect(words.address)
        self.first_picture = threading.Event()
        self.threads = [threading.Thread(target=self.publish, daemon=True),
                        threading.Thread(target=self.watch, daemon=True)]
        for thread in self.threads:
            thread.start()

    def publish(self):
        with self.server.publish(self.words.stream) as publisher:
            number, next_s, step_s = 0, time.monotonic(), 1 / self.words.rate
            while not self.stopping.wait(max(0, next_s - time.monotonic())):
                # Frames that could not be sent in time are not made up for.
                next_s = max(next_s + step_s, time.monotonic() - step_s)
                number += 1
                self.count.due += 1
                publisher.send(source(number))

    def watch(self):
        time.sleep(0.5)  # the stream is there then
        with self.server.watch(self.words.stream, self.display) as watcher:
            captured_ns = None
            while not self.stopping.is_set():
                atlas = watcher.receive(60)
                before_ns, captured_ns = captured_ns, atlas.header.capture_time_ns
                steps = round((captured_ns - (before_ns or captured_ns)) * 1e-9 * self.words.rate)
                self.count.see(atlas, max(0, steps - 1))
                self.first_picture.set()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", help="HOST:PORT")
    parser.add_argument("--stream", default="healthy", help="its name")
    parser.add_argument("--rate", type=float, default=RATE_HZ, help="frames a second")
    parser.add_argument("--display", help="JSON of a Display, instead of the small quilt")
    pair = Pair(parser.parse_args())
    if not pair.first_picture.wait(60):
        sys.exit("no picture came within 60 s")
    print("ready", flush=True)
    for _ in sys.stdin:
        count, pair.count = pair.count, Count()
        print(json.dumps(count.result()), flush=True)
    pair.stopping.set()


if __name__ == "__main__":
    main()
