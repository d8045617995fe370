# SPDX-License-Identifier: Apache-2.0
"""A foreign client: Python publishes a frame, receives a quilt of it and decodes it.

Uses nothing of viewloom but its protos: grpcio, stubs from protoc, Pillow.
"""

import array
import io
import math
import pathlib
import queue
import subprocess
import sys
import unittest

SERVER, STUBS = sys.argv.pop(1), sys.argv.pop(1)
sys.path.insert(0, STUBS)

import grpc
from PIL import Image

from viewloom.rpc import error_details_pb2, status_pb2
from viewloom.v1 import catalog_service_pb2 as catalog
from viewloom.v1 import catalog_service_pb2_grpc as catalog_grpc
from viewloom.v1 import display_pb2 as display
from viewloom.v1 import display_service_pb2 as watching
from viewloom.v1 import display_service_pb2_grpc as watching_grpc
from viewloom.v1 import frame_pb2 as frame
from viewloom.v1 import ingest_service_pb2 as ingest
from viewloom.v1 import ingest_service_pb2_grpc as ingest_grpc

PATIENCE_S = 120

# A wall at 2 m, red on the left of the axis and blue on the right, 160x120 px.
WIDTH_PX, HEIGHT_PX = 160, 120
HALF_WIDTH_TAN, HALF_HEIGHT_TAN = 0.8, 0.6
DEPTH_M = 2.0
RED, BLUE = (220, 40, 30), (30, 60, 210)
# The seam runs between two columns of pixels; JPEG blurs it over a block of 8.
SEAM_TOLERANCE_PX = 2.0
# Baseline JPEG at quality 95 of flat colour.
COLOR_TOLERANCE = 8


def header():
    plane_size = {"width": WIDTH_PX, "height": HEIGHT_PX}
    color = frame.Plane(kind=frame.PLANE_KIND_COLOR, encoding=frame.PLANE_ENCODING_RGB8,
                        size=plane_size, bytes_count=WIDTH_PX * HEIGHT_PX * 3)
    depth = frame.Plane(kind=frame.PLANE_KIND_DEPTH, encoding=frame.PLANE_ENCODING_DEPTH_F32,
                        size=plane_size, bytes_count=WIDTH_PX * HEIGHT_PX * 4,
                        depth={"meaning": frame.DEPTH_MEANING_PLANAR})
    half_width_rad, half_height_rad = math.atan(HALF_WIDTH_TAN), math.atan(HALF_HEIGHT_TAN)
    fov = {"angle_left_rad": -half_width_rad, "angle_right_rad": half_width_rad,
           "angle_up_rad": half_height_rad, "angle_down_rad": -half_height_rad}
    source = frame.Source(camera={"fov": fov}, layers=[frame.Layer(planes=[color, depth])])
    return frame.FrameHeader(number=1, capture_time_ns=77, sources=[source])


def plane_bytes():
    row = bytes(RED) * (WIDTH_PX // 2) + bytes(BLUE) * (WIDTH_PX // 2)
    depth_m = array.array("f", [DEPTH_M]) * (WIDTH_PX * HEIGHT_PX)
    return [row * HEIGHT_PX, depth_m.tobytes()]


class Publisher:
    """Publishes one frame and stays, so that the stream is live."""

    def __init__(self, channel, stream):
        self._requests = queue.Queue()
        self._requests.put(ingest.PublishFramesRequest(settings={"stream": stream}))
        self.responses = ingest_grpc.IngestServiceStub(channel).PublishFrames(
            iter(self._requests.get, None), timeout=PATIENCE_S)

    def send_frame(self):
        self._requests.put(ingest.PublishFramesRequest(header=header()))
        for index, data in enumerate(plane_bytes()):
            self._requests.put(ingest.PublishFramesRequest(
                chunk={"plane_index": index, "offset_bytes": 0, "data": data}))

    def next_report(self):
        return next(r.report for r in self.responses if r.HasField("report"))


def quilt(columns, rows, focal_distance_m):
    size = {"width": WIDTH_PX * columns, "height": HEIGHT_PX * rows}
    return display.Display(quilt={"columns": columns, "rows": rows, "size": size,
                                  "view_cone_rad": 0.5, "focal_distance_m": focal_distance_m})


def receive_still(channel, stream, what):
    """The layout, header, end and decoded picture of one atlas."""
    request = watching.StreamAtlasesRequest(open=watching.OpenDisplay(
        stream=stream, display=what, count=1, encoding={"jpeg_quality": 95}))
    responses = watching_grpc.DisplayServiceStub(channel).StreamAtlases(
        iter([request]), timeout=PATIENCE_S)
    layout, head, pieces, end = None, None, [], None
    for response in responses:
        kind = response.WhichOneof("message")
        if kind == "layout":
            layout = response.layout
        elif kind == "header":
            head = response.header
        elif kind == "band":
            pieces.append(response.band)
        elif kind == "end":
            end = response.end
    assert end.sequence == head.sequence and responses.code() == grpc.StatusCode.OK
    assert len({piece.first_row for piece in pieces}) == head.band_count
    picture = Image.open(io.BytesIO(b"".join(piece.data for piece in pieces)))
    picture.load()
    return layout, head, end, picture


def tile(picture, layout, view):
    """The picture of one view; view 0 stands at the bottom left."""
    column, row_up = view % layout.columns, view // layout.columns
    left = column * layout.tile_size.width
    top = picture.height - (row_up + 1) * layout.tile_size.height
    return picture.crop((left, top, left + layout.tile_size.width, top + layout.tile_size.height))


def seam_px(picture):
    """Where red turns to blue in the middle row, px from the left."""
    row = picture.height // 2
    return sum(1 for x in range(picture.width)
               if picture.getpixel((x, row))[0] > picture.getpixel((x, row))[2])


class PythonClient(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen(
            [SERVER, "serve", "--grpc.address", "127.0.0.1:0", "--http.enabled", "false"],
            stdout=subprocess.PIPE, text=True)
        words = cls.server.stdout.readline().split()
        address = next(word[len("grpc="):] for word in words if word.startswith("grpc="))
        cls.channel = grpc.insecure_channel(address)
        cls.publisher = Publisher(cls.channel, "wall")
        cls.publisher.send_frame()
        cls.report = cls.publisher.next_report()

    @classmethod
    def tearDownClass(cls):
        cls.channel.close()
        cls.server.terminate()
        assert cls.server.wait(PATIENCE_S) == 0, "the server did not drain"
        cls.server.stdout.close()

    def test_the_frame_is_reported_built(self):
        self.assertEqual(self.report.number, 1)
        self.assertEqual(self.report.outcome, ingest.FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY)
        self.assertEqual(self.report.stats.bad_samples_count, 0)
        # Bounds are rounded outwards.
        self.assertGreaterEqual(self.report.stats.inv_z_max, 1 / DEPTH_M)
        self.assertAlmostEqual(self.report.stats.inv_z_max, 1 / DEPTH_M, delta=1e-4)

    def test_the_bands_of_a_quilt_are_one_jpeg(self):
        layout, head, end, picture = receive_still(self.channel, "wall", quilt(4, 2, DEPTH_M))
        self.assertEqual(picture.format, "JPEG")
        self.assertEqual(picture.size, (4 * WIDTH_PX, 2 * HEIGHT_PX))
        self.assertEqual((layout.columns, layout.rows, layout.view_count), (4, 2, 8))
        self.assertEqual((head.frame_number, head.capture_time_ns), (1, 77))
        self.assertGreater(end.coverage.hit, 0.8)

    def test_what_lies_on_the_focal_plane_stands_still(self):
        layout, _, _, picture = receive_still(self.channel, "wall", quilt(4, 2, DEPTH_M))
        for view in range(8):
            seen = tile(picture, layout, view)
            self.assertAlmostEqual(seam_px(seen), WIDTH_PX / 2, delta=SEAM_TOLERANCE_PX)
            for x, expected in ((WIDTH_PX // 4, RED), (WIDTH_PX * 3 // 4, BLUE)):
                pixel = seen.getpixel((x, HEIGHT_PX // 2))
                for got, want in zip(pixel, expected):
                    self.assertLessEqual(abs(got - want), COLOR_TOLERANCE, f"view {view} at {x}")

    def test_what_lies_behind_it_moves_with_the_eye(self):
        focal_m = 1.0
        layout, _, _, picture = receive_still(self.channel, "wall", quilt(4, 2, focal_m))
        for view in range(8):
            eye_m = layout.views[view].pose.position.x
            # The wall's middle, x = 0 at 2 m, against the middle of the focal plane as this eye
            # sees them: tangents -eye / depth and -eye / focal distance.
            shift_tan = eye_m / focal_m - eye_m / DEPTH_M
            expected_px = WIDTH_PX / 2 * (1 + shift_tan / HALF_WIDTH_TAN)
            self.assertAlmostEqual(seam_px(tile(picture, layout, view)), expected_px,
                                   delta=SEAM_TOLERANCE_PX, msg=f"view {view}")
        self.assertLess(layout.views[0].pose.position.x, 0, "view 0 is the leftmost")

    def test_refusals_name_the_field(self):
        with self.assertRaises(grpc.RpcError) as refused:
            receive_still(self.channel, "wall", quilt(0, 2, DEPTH_M))
        self.assertEqual(refused.exception.code(), grpc.StatusCode.INVALID_ARGUMENT)
        details = dict(refused.exception.trailing_metadata())["grpc-status-details-bin"]
        detail = status_pb2.Status.FromString(details).details[0]
        self.assertEqual(detail.TypeName(), "google.rpc.BadRequest")
        bad_request = error_details_pb2.BadRequest.FromString(detail.value)
        self.assertEqual(bad_request.field_violations[0].field, "open.display.quilt.columns")

    def test_the_catalogue_knows_the_stream(self):
        stub = catalog_grpc.CatalogServiceStub(self.channel)
        streams = stub.ListStreams(catalog.ListStreamsRequest(), timeout=PATIENCE_S).streams
        self.assertEqual([(s.name, s.live, s.frame_number) for s in streams], [("wall", True, 1)])
        presets = stub.ListPresets(catalog.ListPresetsRequest(), timeout=PATIENCE_S).presets
        self.assertIn("portrait", [preset.name for preset in presets])


if __name__ == "__main__":
    assert pathlib.Path(SERVER).is_file(), SERVER
    unittest.main(verbosity=2)
