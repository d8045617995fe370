# SPDX-License-Identifier: Apache-2.0
"""A request for more memory than is left is refused before the server takes any, and the refusal
says what would fit. Memory that clients have left goes back to the system. Arguments: viewloomd and
the Python stubs."""
import math
import pathlib
import queue
import re
import struct
import subprocess
import sys
import threading
import time
import unittest

import viewloomd  # takes its argument

sys.path.insert(0, sys.argv.pop(1))

import grpc

from viewloom.v1 import display_pb2 as display
from viewloom.v1 import display_service_pb2 as watching
from viewloom.v1 import display_service_pb2_grpc as watching_grpc
from viewloom.v1 import frame_pb2 as frame
from viewloom.v1 import ingest_service_pb2 as ingest
from viewloom.v1 import ingest_service_pb2_grpc as ingest_grpc

BUDGET_BYTES = 1_500_000_000
# Most that a refusal may cost: buffers of the libraries, not planes.
REFUSAL_BYTES_MAX = 48 << 20
RETURNED_WITHIN_S = 10
REST_SHARE = 1.05
NONE, ZSTD = frame.PLANE_COMPRESSION_NONE, frame.PLANE_COMPRESSION_ZSTD


def zstd_of_zeros(count):
    """A zstd frame (RFC 8878) of blocks that repeat one byte."""
    block_bytes_max = 128 << 10
    blocks = []
    for first in range(0, count, block_bytes_max):
        size = min(block_bytes_max, count - first)
        is_last = first + size == count
        blocks.append(struct.pack("<I", is_last | 1 << 1 | size << 3)[:3] + b"\0")
    return b"\x28\xb5\x2f\xfd\xe0" + struct.pack("<Q", count) + b"".join(blocks)


def header(side_px, layer_count, bytes_count, compression=NONE):
    size = {"width": side_px, "height": side_px}
    color = frame.Plane(kind=frame.PLANE_KIND_COLOR, encoding=frame.PLANE_ENCODING_RGBA8, size=size,
                        compression=compression, bytes_count=bytes_count)
    depth = frame.Plane(kind=frame.PLANE_KIND_DEPTH, encoding=frame.PLANE_ENCODING_DEPTH_F32,
                        size=size, compression=compression, bytes_count=bytes_count,
                        depth={"meaning": frame.DEPTH_MEANING_PLANAR})
    half_rad = math.atan(0.5)
    fov = {"angle_left_rad": -half_rad, "angle_right_rad": half_rad, "angle_up_rad": half_rad,
           "angle_down_rad": -half_rad}
    layers = [frame.Layer(planes=[color, depth]) for _ in range(layer_count)]
    return frame.FrameHeader(number=1, sources=[frame.Source(camera={"fov": fov}, layers=layers)])


class Publishing:
    """A call that stays open until close()."""

    def __init__(self, channel, stream):
        self._requests = queue.Queue()
        self.call = ingest_grpc.IngestServiceStub(channel).PublishFrames(
            iter(self._requests.get, None), timeout=viewloomd.PATIENCE_S)
        self.send(settings={"stream": stream})
        next(self.call)  # accepted

    def send(self, **message):
        self._requests.put(ingest.PublishFramesRequest(**message))

    def refusal(self):
        """The error that ends the call; None if a report or a wish comes first."""
        try:
            next(response for response in self.call if response.HasField("report"))
        except grpc.RpcError as error:
            return error
        return None

    def ends_within(self, duration_s):
        """Wishes are read meanwhile: a call is over once all before its end is read."""
        reader = threading.Thread(target=self.refusal, daemon=True)
        reader.start()
        reader.join(duration_s)
        return not reader.is_alive()

    def close(self):
        self.call.cancel()
        self._requests.put(None)


class MemoryBudget(unittest.TestCase):
    def setUp(self):
        self.server = viewloomd.Viewloomd(options=[
            "--memory.budget", str(BUDGET_BYTES), "--pipeline.warm_up", "false",
            "--limits.streams_max", "64"])
        self.addCleanup(self.server.stop)
        self.channel = grpc.insecure_channel(self.server.address)
        self.addCleanup(self.channel.close)

    def resident(self):
        status = pathlib.Path(f"/proc/{self.server.process.pid}/statm").read_text(encoding="ascii")
        return int(status.split()[1]) * 4096

    def publishing(self, stream):
        publishing = Publishing(self.channel, stream)
        self.addCleanup(publishing.close)
        return publishing

    def assert_says(self, error, *parts):
        self.assertIsNotNone(error)
        self.assertEqual(error.code(), grpc.StatusCode.RESOURCE_EXHAUSTED, error.details())
        for part in parts:
            self.assertIn(part, error.details())

    def test_refuses_a_bomb_by_its_header(self):
        rest = self.resident()
        plane = zstd_of_zeros(8192 * 8192 * 4)
        publishing = self.publishing("bomb")
        publishing.send(header=header(8192, 2, len(plane), ZSTD))
        self.assert_says(publishing.refusal(), "header: the frame (2 layers, 8192x8192 px) takes",
                         "memory.budget", "Such a frame fits with up to")
        self.assertLess(self.resident() - rest, REFUSAL_BYTES_MAX)

    def test_stops_where_a_plane_holds_more_than_was_declared(self):
        plane = zstd_of_zeros(64 * 64 * 4)
        longer = plane[:5] + struct.pack("<Q", 64 * 64 * 4) + zstd_of_zeros(1 << 28)[13:]
        publishing = self.publishing("longer")
        rest = self.resident()
        publishing.send(header=header(64, 1, len(longer), ZSTD))
        # The declared size of the file is that of the plane; the blocks behind it go on.
        for index in range(2):
            publishing.send(chunk={"plane_index": index, "offset_bytes": 0, "data": longer})
        report = next(r.report for r in publishing.call if r.HasField("report"))
        self.assertEqual(report.outcome, ingest.FRAME_OUTCOME_REFUSED)
        self.assertLess(self.resident() - rest, REFUSAL_BYTES_MAX)

    def test_counts_frames_that_never_end(self):
        rest = self.resident()
        side_px = 2048
        bytes_count = side_px * side_px * 4
        refused = 0
        unfinished = []
        for number in range(40):
            publishing = self.publishing(f"unfinished{number}")
            unfinished.append(publishing)
            publishing.send(header=header(side_px, 1, bytes_count))
            publishing.send(chunk={"plane_index": 0, "offset_bytes": 0, "data": b"\0" * (1 << 20)})
            publishing.send(heartbeat={})
            refused += publishing.ends_within(0.2)
        self.assertGreater(refused, 0)
        self.assertLess(refused, 40)
        self.assertLess(self.resident() - rest, BUDGET_BYTES)
        for publishing in unfinished:
            publishing.close()
        time.sleep(1)  # the server hears of it
        small = self.publishing("small")
        small.send(header=header(64, 1, 64 * 64 * 4))
        for index in range(2):
            small.send(chunk={"plane_index": index, "offset_bytes": 0,
                              "data": b"\0" * (64 * 64 * 4)})
        self.assertIsNone(small.refusal())

    def test_refuses_a_display_that_could_not_be_made(self):
        rest = self.resident()
        request = watching.StreamAtlasesRequest(open=watching.OpenDisplay(
            stream="later", wait_for_stream=True,
            display=display.Display(quilt={"columns": 8, "rows": 8,
                                           "size": {"width": 16384, "height": 16384},
                                           "view_cone_rad": 0.5, "focal_distance_m": 2}),
            encoding={"with_depth": True, "with_mask": True}))
        call = watching_grpc.DisplayServiceStub(self.channel).StreamAtlases(
            iter([request]), timeout=viewloomd.PATIENCE_S)
        with self.assertRaises(grpc.RpcError) as raised:
            next(call)
        self.assert_says(raised.exception, "the display (64 views, 16384x16384 px) takes",
                         "memory.budget", "Such a display fits with an atlas of up to")
        self.assertLess(self.resident() - rest, REFUSAL_BYTES_MAX)

    def publish_whole(self, side_px):
        publishing = self.publishing("large")
        plane = zstd_of_zeros(side_px * side_px * 4)
        publishing.send(header=header(side_px, 1, len(plane), ZSTD))
        for index in range(2):
            publishing.send(chunk={"plane_index": index, "offset_bytes": 0, "data": plane})
        self.assertIsNone(publishing.refusal())
        publishing.close()

    def test_returns_what_clients_have_left(self):
        self.publish_whole(256)
        time.sleep(RETURNED_WITHIN_S)
        rest = self.resident()
        self.publish_whole(2048)
        time.sleep(RETURNED_WITHIN_S)
        self.assertLess(self.resident(), REST_SHARE * rest)

    def test_says_at_start_what_the_smallest_budget_is(self):
        started = subprocess.run(
            [viewloomd.PROGRAM, "serve", "--grpc.address", "127.0.0.1:0", "--http.address",
             "127.0.0.1:0", "--memory.budget", "100000000"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False,
            timeout=viewloomd.PATIENCE_S)
        self.assertEqual(started.returncode, 2, started.stderr)
        self.assertIn("memory.budget is 100 MB", started.stderr)
        said = re.search(r"need a budget of at least (\d+) MiB", started.stderr)
        smallest_mib = int(said.group(1))
        # Three quarters of 512 MiB: the default of a small machine.
        self.assertLess(smallest_mib, 384)
        for budget_bytes in (smallest_mib << 20, 384 << 20):
            viewloomd.Viewloomd(options=["--memory.budget", str(budget_bytes), "--pipeline.warm_up",
                                         "false"]).stop()


if __name__ == "__main__":
    unittest.main()
