# SPDX-License-Identifier: Apache-2.0
"""Every detector of the overloads finds a fault that is planted. Argument: viewloomd.

PYTHONPATH has the Python client."""

import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import beside
import form
import loads
import metrics
import overcommit
import slow_viewers
import terminations
import verdicts
from attack_parts import Budget, HealthyPair, Server
from clients import Session, scene
from verdicts import FULL
from viewloom.v1 import atlas_pb2
from viewloom.v1 import display_service_pb2 as display_service

PROGRAM = sys.argv.pop(1)
# They say that they are there.
DEAF = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); " \
       "print(flush=True); time.sleep(60)"
FAULTY = "import signal, sys; signal.signal(signal.SIGTERM, lambda *_: sys.exit(3)); " \
         "print(flush=True); signal.pause()"
BEFORE = """
viewloom_piece_seconds_bucket{work="trace",le="0.01"} 10
viewloom_piece_seconds_bucket{work="trace",le="0.03"} 10
viewloom_piece_seconds_bucket{work="trace",le="+Inf"} 10
"""


def after(up_to_10_ms, up_to_30_ms, all_pieces):
    return metrics.Snapshot(f"""
viewloom_piece_seconds_bucket{{work="trace",le="0.01"}} {10 + up_to_10_ms}
viewloom_piece_seconds_bucket{{work="trace",le="0.03"}} {10 + up_to_30_ms}
viewloom_piece_seconds_bucket{{work="trace",le="+Inf"}} {10 + all_pieces}
viewloom_predicted_piece_seconds_bucket{{work="trace",le="0.01"}} {all_pieces}
viewloom_predicted_piece_seconds_bucket{{work="trace",le="+Inf"}} {all_pieces}
viewloom_longest_piece_seconds{{work="trace"}} 0.2
""")


class Starving:
    """A server that serves nobody but that client: it stops while the client is there."""

    def __init__(self, process):
        self._process = process

    def load(self, session):
        session.publish(scene())
        threading.Thread(target=self._starve, args=(session,), daemon=True).start()

    def _starve(self, session):
        while not session.stopping.is_set():
            os.kill(self._process.pid, signal.SIGSTOP)
            time.sleep(0.9)
            os.kill(self._process.pid, signal.SIGCONT)
            time.sleep(0.1)


class PlantedVerdicts(unittest.TestCase):
    def found(self, row):
        return " ".join(row.found)

    def test_the_healthy_pair_is_judged(self):
        def judged(pictures, gap_s):
            row = verdicts.BesideRow("planted", pictures, 40.0, gap_s, 0.12, 1.0, 1.0, 3)
            return self.found(verdicts.judged_beside(row, FULL))

        self.assertEqual(judged(38, 0.25), "")
        self.assertIn("pictures: 30 of 40", judged(30, 0.25))
        self.assertIn("gap: 0.45 s", judged(38, 0.45))
        row = verdicts.BesideRow("planted", 30, 40.0, 1.2, 0.12, 1.0, 1.0, 3)
        found = self.found(verdicts.judged_beside_many(row, FULL))
        self.assertIn("pictures: 30 of 40", found)
        self.assertIn("gap: 1.20 s, at most 1.0", found)

    def test_a_wrong_share_is_found(self):
        def judged(demand, share):
            return self.found(verdicts.judged_share(verdicts.ShareRow(demand, share), FULL))

        self.assertEqual(judged(0.5, 0.12), "")
        self.assertIn("share: 0.050", judged(0.5, 0.05))
        self.assertIn("share: 0.200", judged(0.5, 0.2))
        self.assertIn("asks for less", judged(0.1, 0.1))

    def test_long_pieces_are_found(self):
        def judged(*counts):
            rows = beside.piece_rows(metrics.Snapshot(BEFORE), after(*counts))
            return " ".join(self.found(verdicts.judged_pieces(row, FULL)) for row in rows).strip()

        self.assertEqual(judged(900, 995, 1000), "")
        self.assertIn("measured: inf ms", judged(900, 980, 1000))
        self.assertIn("too few to judge", judged(9, 10, 10))
        row = verdicts.PieceRow("trace", 1000, 0.02, 0.02, 0.02)
        self.assertIn("predicted: 20.0 ms", self.found(verdicts.judged_pieces(row, FULL)))

    def test_memory_is_judged(self):
        def judged(peak_mib, left_mib):
            row = verdicts.MemoryRow(1000, 400, peak_mib, left_mib)
            return self.found(verdicts.judged_memory(row, FULL))

        self.assertEqual(judged(1050, 410), "")
        self.assertIn("peak: 1200 MiB", judged(1200, 410))
        self.assertIn("kept: 100 MiB", judged(1000, 500))

    def test_ages_and_drops_of_a_fast_viewer_are_judged(self):
        def judged(beside_s, dropped):
            row = slow_viewers.AgeRow(0.02, beside_s, dropped, 5, 1.0)
            return self.found(slow_viewers.judged_age(row, FULL))

        self.assertEqual(judged(0.0255, 0), "")
        self.assertIn("age: 40.0 ms, at most 26.0", judged(0.04, 0))
        self.assertIn("dropped: 1", judged(0.02, 1))

    def test_viewers_that_are_not_cut_are_found(self):
        kept = slow_viewers.judged_cut(slow_viewers.CutRow("Silent", 5, 3, 9.0), True)
        self.assertIn("2 never read and were not cut", self.found(kept))
        cut = slow_viewers.judged_cut(slow_viewers.CutRow("Slow", 5, 1, 9.0), False)
        self.assertIn("1 read slowly", self.found(cut))

    def test_an_overcommitted_server_is_judged(self):
        def judged(*hz_and_ms):
            rows = [overcommit.LoadRow(8 + 2 * number, hz, ms, 1.0, 0.5, 1)
                    for number, (hz, ms) in enumerate(hz_and_ms)]
            return " ".join(map(self.found, overcommit.judged_loads(rows, FULL))).strip()

        self.assertEqual(judged((80, 5.7), (86, 5.6), (86, 5.9)), "")
        collapsed = judged((80, 5.7), (85, 5.6), (63, 7), (35, 10))
        self.assertIn("100 pictures a CPU second, the best is 179", collapsed)
        self.assertIn("85 pictures a second came of fewer streams", collapsed)

    def test_a_slow_refusal_is_found(self):
        row = overcommit.RefusalRow(0.001, 0.002, 0.001, 0.03, 20)
        self.assertIn("30.0 ms, at most 10",
                      self.found(overcommit.judged_refusal(row, FULL)))


class PlantedProcesses(unittest.TestCase):
    def exit_of(self, script, patience_s=None):
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE) as process:
            process.stdout.readline()
            code, took_s = terminations.end(process, patience_s or terminations.PATIENCE_S)
        row = terminations.ExitRow(1, "planted", 0.5, took_s, code, 3, [])
        return " ".join(terminations.judged_exit(row, FULL).found)

    def test_a_server_that_does_not_end_is_found(self):
        self.assertIn("exit code -9", self.exit_of(DEAF, 0.5))
        row = terminations.ExitRow(1, "planted", 0.5, 12.0, 0, 3, [])
        good = terminations.ExitRow(2, "planted", 0.5, 1.0, 0, 4, [])
        self.assertIn("took 12.0 s", " ".join(terminations.judged_exit(row, FULL).found))
        self.assertEqual(terminations.summary([row, good]),
                         "1 of 2 clean, 0 of 7 atlases torn, the longest took 12.0 s")

    def test_a_server_that_ends_with_a_fault_is_found(self):
        self.assertIn("exit code 3", self.exit_of(FAULTY))

    def test_a_torn_atlas_is_found(self):
        viewer = terminations.Wholeness("planted")
        header = display_service.AtlasHeader(sequence=1, band_count=2)
        band = display_service.Band(sequence=1, plane=atlas_pb2.ATLAS_PLANE_COLOR, row_count=8,
                                    last_piece=True, data=b"\xff\xd8")
        layout = atlas_pb2.AtlasLayout(size={"width": 8, "height": 8})
        for message in ({"layout": layout}, {"header": header}, {"band": band},
                        {"end": display_service.AtlasEnd(sequence=1)}):
            viewer.take(display_service.StreamAtlasesResponse(**message))
        self.assertIn("before it was whole", viewer.torn[0])
        header.band_count = 1
        for message in ({"header": header}, {"band": band},
                        {"end": display_service.AtlasEnd(sequence=1)}):
            viewer.take(display_service.StreamAtlasesResponse(**message))
        self.assertEqual(len(viewer.torn), 2)

    def test_a_server_that_starves_the_pair_is_found(self):
        its_form = form.Form(False, False, FULL, Budget(2.0, 1), Budget(2.0, 1), 0)
        with beside.Scene(PROGRAM, its_form) as a_scene:
            starving = Starving(a_scene.server.process)
            row = a_scene.row("starving", [starving.load], its_form.client)
        found = " ".join(verdicts.judged_beside(row, FULL).found)
        self.assertIn("gap", found)
        self.assertIn("pictures", found)

    def test_a_refusal_is_told(self):
        with Server(PROGRAM) as server, Session(server.address, "", "refused") as session:
            session.publish(scene(160, 90))
            session.watch(loads.quilt(256, 51)).done.wait(10)
            self.assertIn("INVALID_ARGUMENT", " ".join(session.refusals()))

    def test_viewers_that_a_server_keeps_are_counted(self):
        with Server(PROGRAM) as server:
            pair = HealthyPair(server.address)
            self.addCleanup(pair.stop)
            row = slow_viewers.cut_row(server.address, slow_viewers.Slow, 1, after_s=2)
        self.assertEqual((row.count, row.cut), (slow_viewers.COUNTS[slow_viewers.Slow], 0))


if __name__ == "__main__":
    unittest.main(verbosity=2)
