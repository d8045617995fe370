# SPDX-License-Identifier: Apache-2.0
"""Watches one quilt of a stream; saves it, and one of its views, as pictures.

Needs python3-grpcio, python3-protobuf and python3-pil, and the modules that the build makes:

    PYTHONPATH=build/release/client/python \
        /usr/bin/python3 client/python/examples/watch_quilt.py --stream demo --view 24
"""

import argparse
import io
import sys

import grpc
from PIL import Image

from viewloom.v1 import atlas_pb2, display_pb2, display_service_pb2, display_service_pb2_grpc


def receive_quilt(address, stream, display):
    """One atlas: its layout, header and end, and its bands joined, which are one JPEG file.

    Only its end makes it whole: one that is abandoned, or that another header follows, is
    discarded.
    """
    request = display_service_pb2.StreamAtlasesRequest(
        open=display_service_pb2.OpenDisplay(
            stream=stream, display=display, count=1, wait_for_stream=True))
    with grpc.insecure_channel(address) as channel:
        stub = display_service_pb2_grpc.DisplayServiceStub(channel)
        layout, header, jpeg = None, None, bytearray()
        for message in stub.StreamAtlases(iter([request])):
            kind = message.WhichOneof("message")
            if kind == "layout":
                layout = message.layout
            elif kind == "header":
                header, jpeg = message.header, bytearray()
            elif kind == "band" and message.band.plane == atlas_pb2.ATLAS_PLANE_COLOR:
                jpeg += message.band.data
            elif kind == "abandoned":
                header, jpeg = None, bytearray()
            elif kind == "end" and header is not None:
                return layout, header, message.end, bytes(jpeg)
    raise RuntimeError("the server ended before an atlas was whole")


def cut_view(quilt, layout, view):
    """One view of a quilt, whose view 0 is at the bottom left."""
    row, column = divmod(view, layout.columns)
    left = column * layout.tile_size.width
    top = layout.padding_top_px + (layout.rows - 1 - row) * layout.tile_size.height
    return quilt.crop((left, top, left + layout.tile_size.width, top + layout.tile_size.height))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--server", default="127.0.0.1:50051")
    parser.add_argument("--stream", default="demo")
    parser.add_argument("--preset", default="portrait")
    parser.add_argument("--view", type=int, default=0)
    parser.add_argument("--out", default="quilt", help="how the names of the files begin")
    options = parser.parse_args()

    display = display_pb2.Display(preset=options.preset)
    print(f"waiting for a frame of {options.stream}", file=sys.stderr)
    try:
        layout, header, end, jpeg = receive_quilt(options.server, options.stream, display)
    except grpc.RpcError as error:
        sys.exit(f"watch_quilt: {options.server}: {error.code().name}: {error.details()}")
    quilt_file = f"{options.out}{layout.suffix}.jpg"
    with open(quilt_file, "wb") as file:
        file.write(jpeg)
    view_file = f"{options.out}_view{options.view:02d}.png"
    cut_view(Image.open(io.BytesIO(jpeg)), layout, options.view).save(view_file)
    print(f"frame {header.frame_number}: {layout.view_count} views, "
          f"{end.coverage.hidden:.1%} of the rays hidden; wrote {quilt_file} and {view_file}")


if __name__ == "__main__":
    main()
