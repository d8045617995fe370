# SPDX-License-Identifier: Apache-2.0
"""Publishers that are corrected, hang, vanish or lose their server, against the real programs.
Arguments: viewloomd, viewloom, folder of the generated Python stubs."""
import array
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, CLIENT, STUBS = sys.argv.pop(1), sys.argv.pop(1), sys.argv.pop(1)

from PIL import Image

PATIENCE_S = 120
SIZE_PX = (192, 128)

# Claims a stream's name without heartbeats, and does nothing more.
SILENT_PUBLISHER = """
import sys, threading
sys.path.insert(0, sys.argv[1])
import grpc
from viewloom.v1 import ingest_service_pb2 as ingest
from viewloom.v1 import ingest_service_pb2_grpc as ingest_grpc
def messages():
    yield ingest.PublishFramesRequest(settings={"stream": "scene", "session_id": "silent"})
    threading.Event().wait()
for answer in ingest_grpc.IngestServiceStub(grpc.insecure_channel(sys.argv[2])).PublishFrames(
        messages()):
    print(answer.WhichOneof("message"), flush=True)
"""


class Process:
    """A program whose standard error is kept in a file."""

    def __init__(self, folder, arguments):
        self.log = pathlib.Path(tempfile.mkstemp(dir=folder)[1])
        with self.log.open("w", encoding="utf-8") as log:
            self.process = subprocess.Popen(arguments, stdout=log, stderr=log)

    def said(self):
        return self.log.read_text(encoding="utf-8")

    def wait_for(self, pattern, start=0):
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline:
            text = self.said()
            match = re.compile(pattern).search(text, start)
            if match:
                return match
            time.sleep(0.02)
        raise AssertionError(f"{pattern!r} never came; it said: {self.said()[start:]}")

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.process.kill()
        return self.process.wait(PATIENCE_S)


class StreamSessions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        Image.radial_gradient("L").resize(SIZE_PX).convert("RGB").save(self.folder / "color.png")
        # A slope from 1.5 to 4 m, in millimetres.
        depth_mm = array.array("H", (1500 + 2500 * x // SIZE_PX[0] for _ in range(SIZE_PX[1])
                                     for x in range(SIZE_PX[0])))
        Image.frombytes("I;16", SIZE_PX, depth_mm.tobytes()).save(self.folder / "depth_mm.png")
        self.grpc = "127.0.0.1:0"

    def serve(self, *arguments):
        server = Process(self.folder, [PROGRAM, "serve", "--grpc.address", self.grpc,
                                       "--http.address", "127.0.0.1:0", *arguments])
        self.addCleanup(server.end)
        match = server.wait_for(r"grpc=(\S+) http=(\S+)")
        self.grpc, self.url = match.groups()
        return server

    def client(self, *arguments):
        process = Process(self.folder, [CLIENT, "--server", self.grpc, *arguments])
        self.addCleanup(process.end)
        return process

    def publish(self, *more):
        return self.client("publish", str(self.folder / "color.png"), "--depth",
                           str(self.folder / "depth_mm.png"), "--fov", "50", "--stream", "scene",
                           "--hold", *more)

    def wait_for_stream(self, is_wanted):
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline:
            listed = subprocess.run([CLIENT, "--server", self.grpc, "list", "streams", "--json"],
                                    capture_output=True, check=True, timeout=PATIENCE_S)
            streams = json.loads(listed.stdout).get("streams", [])
            if any(is_wanted(stream) for stream in streams if stream["name"] == "scene"):
                return
            time.sleep(0.1)
        raise AssertionError(f"not in time: {streams}")

    def wait_for_frames(self, count):
        self.wait_for_stream(lambda stream: int(stream["receivedCount"]) >= count)

    def focal_distance_m(self):
        """Of a quilt, and the atlas's count of defaults."""
        watched = subprocess.run(
            [CLIENT, "--server", self.grpc, "watch", "scene", "--columns", "4", "--rows", "2",
             "--size", "384x128", "--cone", "20", "--count", "1"], capture_output=True, text=True,
            check=True, timeout=PATIENCE_S)
        return float(re.search(r"focal plane at ([\d.]+) m", watched.stderr).group(1))

    def test_a_corrected_publish_shows_the_right_picture(self):
        self.serve()
        wrong = self.publish("--depth-scale", "1")
        self.wait_for_frames(1)
        self.assertGreater(self.focal_distance_m(), 1000)
        viewer = self.client("watch", "scene", "--columns", "4", "--rows", "2", "--size",
                             "384x128", "--cone", "20")
        viewer.wait_for("focal plane at [0-9]{4}")
        self.assertEqual(wrong.end(), 0)
        self.publish("--input", "sensor")
        self.wait_for_frames(2)
        plane = viewer.wait_for(r"the stream has a new publisher: focal plane at ([\d.]+) m")
        # Half of 1/1.5 + 1/4, per metre.
        self.assertAlmostEqual(float(plane.group(1)), 2 / (1 / 1.5 + 1 / 4), delta=0.15)
        self.assertAlmostEqual(self.focal_distance_m(), float(plane.group(1)), delta=0.01)

    def test_a_publisher_waits_for_a_live_one_and_takes_over_from_a_hung_one(self):
        self.serve()
        first = self.publish("--input", "sensor")
        self.wait_for_frames(1)
        second = self.publish("--input", "sensor")
        second.wait_for(r'stream "scene" has a publisher on this machine, for \d+ s now; waiting')
        time.sleep(7)
        self.assertNotIn("connected to", second.said(), "a live publisher was thrown out")
        self.assertIsNone(second.process.poll())
        first.process.send_signal(signal.SIGSTOP)
        second.wait_for("connected to")
        self.wait_for_frames(2)
        start = len(first.said())
        first.process.send_signal(signal.SIGCONT)
        first.wait_for("has a publisher on this machine", start)
        second.end()
        first.wait_for("connected to", start)

    def test_a_publisher_without_heartbeats_loses_its_name_with_its_connection(self):
        self.serve("--grpc.keepalive_s", "1")
        silent = Process(self.folder, [sys.executable, "-c", SILENT_PUBLISHER, STUBS, self.grpc])
        self.addCleanup(silent.process.kill)
        silent.wait_for("accepted")
        second = self.publish("--input", "sensor")
        second.wait_for("has a publisher on this machine")
        time.sleep(3)
        self.assertNotIn("connected to", second.said(), "it answers pings, and is alive")
        silent.process.send_signal(signal.SIGSTOP)
        second.wait_for("connected to")

    def test_everybody_is_back_soon_after_the_server(self):
        server = self.serve()
        publisher = self.publish("--input", "sensor")
        self.wait_for_frames(1)
        options = ("scene", "--columns", "4", "--rows", "2", "--size", "384x128")
        viewer = self.client("watch", *options)
        recorder = self.client("record", *options, "--out", str(self.folder / "scene.vlr"))
        clients = (publisher, viewer, recorder)
        for client in clients:
            client.wait_for("connected to")
        server.end()
        time.sleep(6)  # delays have grown to their limit
        starts = [len(client.said()) for client in clients]
        self.serve()
        begun = time.monotonic()
        for client, start in zip(clients, starts):
            client.wait_for("connected to", start)
        took_s = time.monotonic() - begun
        print(f"all were back {took_s:.2f} s after the server")
        # 2 s on a machine that does nothing else; an outage is what this tells apart.
        self.assertLess(took_s, 15)
        self.wait_for_frames(1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
