# SPDX-License-Identifier: Apache-2.0
"""The soak finds faults that are planted: in series, and in a server. Arguments: viewloomd, the
library of planted_fault.cpp. PYTHONPATH as for main.py."""

import collections
import contextlib
import dataclasses
import os
import signal
import sys
import time
import unittest

import numpy as np

import http2
import soak
from faults import bad_display
from main import planted
from place import served
from readings import Gauges, Reading, sums_of
from trend import trend_of
from verdict import Series, judged
from visits import SWEPT

PROGRAM, LIBRARY = sys.argv.pop(1), sys.argv.pop(1)
NOISE_BYTES = 20_000
CYCLES, SAMPLES = 12_000, 52  # of ten minutes
# A few seconds of one kind of client show what is lost with each connection, before the server has
# no files left.
FEW = dataclasses.replace(soak.SUITE, seconds=0, round_s=0.1, workers=1, actions=(bad_display,),
                          kinds=SWEPT[:1], most_bytes=32768)
LARGE_LOSS = "heap:65536"


def series_of(slope, noise=NOISE_BYTES, seed=1, descriptors=(20, 20), threads=(30, 30)):
    """Readings of a server that loses so many bytes a cycle. Neighbours are alike."""
    random = np.random.default_rng(seed)
    cycles = np.linspace(0, CYCLES, SAMPLES)
    rest = np.zeros(SAMPLES)
    for index in range(1, SAMPLES):
        rest[index] = 0.5 * rest[index - 1] + random.normal(0, noise)
    series = Series()
    for index, cycle in enumerate(cycles):
        is_late = index > SAMPLES // 2
        series.add(cycle, Reading(50_000_000 + slope * cycle + rest[index], descriptors[is_late],
                                  threads[is_late], 9))
    return series


class Trends(unittest.TestCase):
    def test_the_slope_lies_within_its_interval(self):
        for slope in (0.0, 16.0):
            inside = 0
            for seed in range(10):
                trend = series_of(slope, seed=seed).trend()
                self.assertLess(trend.low, trend.high)
                inside += trend.low <= slope <= trend.high
            self.assertGreaterEqual(inside, 7, slope)

    def test_one_wild_reading_in_ten_changes_little(self):
        series = series_of(0.0, noise=100)
        sizes = [one.heap for one in series.readings]
        sizes[::10] = [size + 50_000_000 for size in sizes[::10]]
        self.assertLess(abs(trend_of(series.cycles, sizes).slope), 1.0)

    def test_few_readings_show_nothing(self):
        self.assertIsNone(trend_of([1, 2, 3], [1, 2, 3]))


class Verdicts(unittest.TestCase):
    def found(self, series, failed=0):
        return judged(series, CYCLES, collections.Counter({"planted": failed}), 4)

    def test_a_server_that_loses_nothing_is_ok(self):
        verdict = self.found(series_of(0.0, noise=500))
        self.assertEqual((verdict.leaks, verdict.unproven), ([], []), verdict.text())

    def test_clients_that_fail_are_no_proof(self):
        verdict = self.found(series_of(0.0, noise=500), failed=CYCLES // 10)
        self.assertIn("clients failed", verdict.unproven[0])

    def test_what_is_lost_is_found(self):
        self.assertIn("heap", self.found(series_of(16.0, noise=500)).leaks[0])
        self.assertEqual(self.found(series_of(0.0, noise=500, descriptors=(20, 21))).leaks,
                         ["1 descriptors"])
        self.assertEqual(self.found(series_of(0.0, noise=500, threads=(30, 33))).leaks,
                         ["3 threads"])

    def test_noise_is_no_proof(self):
        verdict = self.found(series_of(0.0, noise=500_000))
        self.assertEqual(verdict.leaks, [])
        self.assertIn("the interval reaches", verdict.unproven[0])


class Servers(unittest.TestCase):
    def leaks(self, fault, plan=FEW):
        said = []
        verdict = soak.soak(PROGRAM, plan, environment=planted(LIBRARY, fault), say=said.append)
        self.assertFalse(any("failed" in one for one in verdict.unproven), verdict.text())
        return " ".join(verdict.leaks)

    def test_each_planted_fault_is_found(self):
        self.assertEqual(self.leaks("nothing"), "")
        self.assertIn("heap: ", self.leaks(LARGE_LOSS))
        self.assertIn("descriptors", self.leaks("descriptor"))
        self.assertIn("threads", self.leaks("thread"))

    def test_clients_that_stay_are_found(self):
        with contextlib.ExitStack() as parts:
            server, place = parts.enter_context(served(PROGRAM))
            gauges = Gauges(place, rest_s=1)
            parts.enter_context(http2.Connection(server.address))
            while gauges.is_at_rest(gauges.read()):
                time.sleep(0.1)
            with self.assertRaisesRegex(RuntimeError, "still there.*grpc_connections': 1"):
                gauges.at_rest(0, 0)

    def test_an_end_of_the_server_is_found(self):
        def end(visit):
            os.kill(visit.place.pid, signal.SIGKILL)

        with self.assertRaisesRegex(RuntimeError, "the server ended with -9"):
            soak.soak(PROGRAM, dataclasses.replace(FEW, actions=(end,)), say=lambda _: None)


class Metrics(unittest.TestCase):
    def test_labels_are_added_up(self):
        text = '# HELP a b\na{x="1"} 2\na{x="2"} 3.5\nb 1e3\n'
        self.assertEqual(sums_of(text), {"a": 5.5, "b": 1000.0})


if __name__ == "__main__":
    unittest.main(verbosity=2)
