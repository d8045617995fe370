# SPDX-License-Identifier: Apache-2.0
"""What viewloomd does while nothing moves: nothing. Prints what share of a core that takes, and
asserts what was counted. Arguments: viewloomd, viewloom."""
import array
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

import viewloomd  # takes its argument

from PIL import Image

CLIENT = sys.argv.pop(1)
MEASURED_S = 10
UNCHANGED_COUNT = 20  # frames that are sent again at least
SIZE_PX = (320, 240)
WORK = ("viewloom_structures_built_total", "viewloom_atlases_encoded_total",
        'viewloom_atlases_traced_total{method="sweep"}',
        'viewloom_atlases_traced_total{method="walk"}',
        'viewloom_atlases_sent_total{transport="grpc"}',
        'viewloom_stage_seconds_count{stage="upload"}')


class StaticInput(unittest.TestCase):
    def setUp(self):
        self.server = viewloomd.Viewloomd()
        self.addCleanup(self.server.stop)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        Image.radial_gradient("L").resize(SIZE_PX).convert("RGB").save(self.folder / "color.png")
        depth_m = array.array("f", (2 + x / 200 for _ in range(SIZE_PX[1])
                                    for x in range(SIZE_PX[0])))
        (self.folder / "depth.pfm").write_bytes(
            b"Pf\n%d %d\n-1\n" % SIZE_PX + depth_m.tobytes())

    def start(self, *arguments):
        process = subprocess.Popen([CLIENT, "--server", self.server.address, *arguments, "--quiet"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait, viewloomd.PATIENCE_S)
        self.addCleanup(process.send_signal, signal.SIGINT)

    def publish(self, *more):
        self.start("publish", str(self.folder / "color.png"), "--depth",
                   str(self.folder / "depth.pfm"), "--fov", "50", "--stream", "scene", *more)

    def metrics(self):
        with urllib.request.urlopen(self.server.url + "metrics",
                                    timeout=viewloomd.PATIENCE_S) as reply:
            return {name: float(value) for name, value in
                    (line.rsplit(" ", 1) for line in reply.read().decode().splitlines()
                     if not line.startswith("#"))}

    def wait_for(self, metric, count):
        deadline = time.monotonic() + viewloomd.PATIENCE_S
        while self.metrics()[metric] < count:
            self.assertLess(time.monotonic(), deadline, f"{metric} stays below {count}")
            time.sleep(0.05)

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.server.process.pid}/stat").read_text(encoding="ascii")
        user, system = fields.rsplit(")", 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def work(self):
        return {name: count for name, count in self.metrics().items() if name in WORK}

    def measure(self, what):
        before = self.cpu_s()
        time.sleep(MEASURED_S)
        print(f"{what}: {100 * (self.cpu_s() - before) / MEASURED_S:.2f} % of a core")

    def watch(self):
        self.start("watch", "scene", "--columns", "4", "--rows", "2", "--size", "640x480",
                   "--cone", "30")
        self.wait_for('viewloom_atlases_sent_total{transport="grpc"}', 1)

    def test_a_publisher_that_holds_sends_nothing(self):
        self.publish("--hold")
        self.watch()
        before = self.work()
        self.measure("held, one display watches")
        self.assertEqual(self.metrics()["viewloom_frames_received_total"], 1)
        self.assertEqual(self.work(), before)

    def test_a_frame_that_comes_again_is_not_made_again(self):
        self.publish("--loop", "--fps", "15")
        self.watch()
        before = self.work()
        self.assertEqual(set(before), set(WORK))
        unchanged = self.metrics()["viewloom_frames_unchanged_total"]
        self.measure("the same frame 15 times a second, one display watches")
        self.wait_for("viewloom_frames_unchanged_total", unchanged + UNCHANGED_COUNT)
        self.assertEqual(self.work(), before)
        self.assertEqual(before["viewloom_structures_built_total"], 1)
        # A new viewer gets the resident frame.
        self.watch()
        self.wait_for('viewloom_atlases_sent_total{transport="grpc"}', 2)
        self.assertEqual(self.work()["viewloom_structures_built_total"], 1)


if __name__ == "__main__":
    unittest.main()
