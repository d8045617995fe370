# SPDX-License-Identifier: Apache-2.0
"""A server that gives the atlases a test makes, and keeps what its client asks and reports."""

import queue
import threading
import time
from concurrent import futures

import grpc

from viewloom.v1 import atlas_pb2
from viewloom.v1 import catalog_service_pb2 as catalog
from viewloom.v1 import catalog_service_pb2_grpc as catalog_grpc
from viewloom.v1 import display_pb2 as display
from viewloom.v1 import display_service_pb2 as watching
from viewloom.v1 import display_service_pb2_grpc as watching_grpc

PIECE_BYTES_MAX = 1 << 20


class Atlas:
    """uint8[height][width][3], top row first, and how its views lie in it."""

    def __init__(self, picture, columns=1, rows=1, padding_top_px=0, padding_right_px=0,
                 order=display.TILE_ORDER_BOTTOM_LEFT, present_at_ns=0):
        self.picture = picture
        self.present_at_ns = present_at_ns
        height, width = picture.shape[:2]
        tile = {"width": (width - padding_right_px) // columns,
                "height": (height - padding_top_px) // rows}
        self.layout = atlas_pb2.AtlasLayout(
            size={"width": width, "height": height}, columns=columns, rows=rows, tile_size=tile,
            order=order, aspect=tile["width"] / tile["height"], view_count=columns * rows,
            padding_right_px=padding_right_px, padding_top_px=padding_top_px, view_cone_rad=0.7,
            focal_distance_m=2.0, encoding={"color": atlas_pb2.BAND_ENCODING_RAW})

    def messages(self, sequence):
        """Header, pieces of one band, end."""
        response = watching.StreamAtlasesResponse
        yield response(header=watching.AtlasHeader(
            sequence=sequence, frame_number=100 + sequence, capture_time_ns=time.time_ns(),
            present_at_ns=self.present_at_ns, band_count=1))
        data = self.picture.tobytes()
        for offset in range(0, len(data), PIECE_BYTES_MAX):
            piece = data[offset:offset + PIECE_BYTES_MAX]
            yield response(band=watching.Band(
                sequence=sequence, plane=atlas_pb2.ATLAS_PLANE_COLOR, first_row=0,
                row_count=self.picture.shape[0], encoding=atlas_pb2.BAND_ENCODING_RAW,
                offset_bytes=offset, last_piece=offset + len(piece) == len(data), data=piece))
        yield response(end=watching.AtlasEnd(sequence=sequence))


class FakeCatalog(catalog_grpc.CatalogServiceServicer):
    """Says what its server traces on."""

    def __init__(self, traces_on_cpu):
        self._info = catalog.GetServerInfoResponse(device="a device of the test",
                                                   traces_on_cpu=traces_on_cpu)

    def GetServerInfo(self, request, context):  # pylint: disable=invalid-name
        return self._info


class FakeDisplays(watching_grpc.DisplayServiceServicer):
    """answer(Display) gives the Atlas of a display; a grpc.StatusCode refuses it.

    see(EyePoses): the Atlas that those eyes see.
    traces_on_cpu: as the server says; None = it says nothing about itself.
    """

    def __init__(self, answer, address="127.0.0.1:0", see=None, traces_on_cpu=None):
        self._answer = answer
        self._see = see
        self.displays = queue.Queue()   # asked for: opened, then changed
        self.presented = queue.Queue()  # as the client reports
        self._server = grpc.server(futures.ThreadPoolExecutor(8),
                                   options=[("grpc.so_reuseport", 0)])
        watching_grpc.add_DisplayServiceServicer_to_server(self, self._server)
        if traces_on_cpu is not None:
            catalog_grpc.add_CatalogServiceServicer_to_server(FakeCatalog(traces_on_cpu),
                                                              self._server)
        self.address = f"127.0.0.1:{self._server.add_insecure_port(address)}"
        self._server.start()

    def stop(self):
        """Breaks every call off."""
        self._server.stop(grace=0).wait()

    def StreamAtlases(self, request_iterator, context):  # pylint: disable=invalid-name
        wanted = queue.Queue()
        reader = threading.Thread(target=self._read, args=(request_iterator, wanted), daemon=True)
        reader.start()
        sequence = 0
        while (asked := wanted.get()) is not None:
            is_eyes = isinstance(asked, watching.EyePoses)
            atlas = self._see(asked) if is_eyes else self._answer(asked)
            if isinstance(atlas, grpc.StatusCode):
                context.abort(atlas, "the test says so")
            sequence += 1
            yield watching.StreamAtlasesResponse(layout=atlas.layout)
            yield from atlas.messages(sequence)

    def _read(self, requests, wanted):
        try:
            for request in requests:
                if request.HasField("presented"):
                    self.presented.put(request.presented)
                    continue
                if request.HasField("clock_probe"):
                    continue
                if request.HasField("eye_poses"):
                    wanted.put(request.eye_poses)
                    continue
                asked = request.open.display if request.HasField("open") else request.change.display
                self.displays.put(asked)
                wanted.put(asked)
        except grpc.RpcError:
            pass  # the client broke off
        wanted.put(None)
