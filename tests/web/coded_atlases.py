# SPDX-License-Identifier: Apache-2.0
"""Atlases as the web port sends them, made of views without a server; and a web server for them and
for the files of the page."""
import http.server
import io
import json
import os
import struct
import subprocess
import threading

import numpy as np
from PIL import Image

HERE = os.path.dirname(os.path.abspath(__file__))
PAGE = os.path.join(HERE, "..", "..", "client", "web")
SHARED = os.path.join(HERE, "..", "..", "shaders")
# Answers to the page over HTTP: one stream, "demo".
PAGE_ANSWERS = {
    "api/session": {}, "api/presets": {"presets": [
        {"name": "portrait", "device": "Portrait", "kinds": ["quilt"], "note": "", "layout": {
            "size": {"width": 3360, "height": 3360}, "columns": 8, "rows": 6, "aspect": 0.75}}]},
    "api/fields": {"fields": {f"quilt.{name}": {"min": 1, "max": 16384} for name in (
        "columns", "rows", "size.width", "size.height", "aspect")}},
    "api/streams": {"streams": [{"name": "demo", "live": True}]}}
TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css",
         ".svg": "image/svg+xml", ".json": "application/json"}


def layout_of(columns, rows, views, order="BOTTOM_LEFT", padding_right=0, padding_top=0):
    """AtlasLayout of views, uint8[view][y][x][3], as JSON of the web port."""
    count, height, width = views.shape[:3]
    return {"size": {"width": columns * width + padding_right,
                     "height": rows * height + padding_top},
            "columns": columns, "rows": rows, "tile_size": {"width": width, "height": height},
            "order": order, "aspect": width / height, "view_count": count,
            "padding_right_px": padding_right, "padding_top_px": padding_top,
            "view_cone_rad": 0.7, "cone_begin": 0, "cone_end": 0, "focal_distance_m": 2,
            "suffix": f"_qs{columns}x{rows}a{width / height:g}"}


def tile_origin(layout, view):
    row, column = divmod(view, layout["columns"])
    if layout["order"] == "BOTTOM_LEFT":
        row = layout["rows"] - 1 - row
    return (column * layout["tile_size"]["width"],
            layout["padding_top_px"] + row * layout["tile_size"]["height"])


def quilt_of(views, layout):
    """uint8[y][x][3]: the views where the layout has them; black elsewhere."""
    quilt = np.zeros((layout["size"]["height"], layout["size"]["width"], 3), np.uint8)
    for view, picture in enumerate(views):
        x, y = tile_origin(layout, view)
        quilt[y:y + picture.shape[0], x:x + picture.shape[1]] = picture
    return quilt


def message(header, payload):
    """A binary message of /ws: proto/web.md."""
    times = {f"{stage}_ns": 1000000 for stage in (
        "receive", "decode", "upload", "build", "retime", "wait", "trace", "encode", "total")}
    whole = {"sequence": 1, "delivery": 1, "frame_number": "1", "capture_time_ns": "0",
             "shown_time_ns": "0", "present_at_ns": "0", "timing": "captured", "method": "walk",
             "defaults_count": 1, "defaults_reason": "first_frame", "change_count": 0,
             "dropped_count": 0, "mailbox_ns": 0, "shown_ns": 0, "views_outside": [],
             "jpeg_bytes": 0, "depth_bytes": 0, "times": times,
             "coverage": {"hit": 1, "hit_assumed": 0, "hidden": 0, "outside": 0, "empty": 0},
             **header}
    text = json.dumps(whole).encode()
    return struct.pack("<I", len(text)) + text + payload


def code_stacks(program, atlases, qp, chained=False):
    """By OpenH264, of uint8[view][y][x][3] each: [(VideoStack as JSON, access units as coded)].

    chained: each atlas but the first refers to the one before. Every other one is backward: its
    pictures are coded from the last to the first."""
    count, height, width = atlases[0].shape[:3]
    numbers = [str(width), str(height), str(count), str(qp)]
    run = subprocess.run([program, *numbers, *(["chained"] if chained else [])], check=True,
                         input=b"".join(views.tobytes() for views in atlases),
                         stdout=subprocess.PIPE)
    output = io.BytesIO(run.stdout)
    coded = []
    for _ in atlases:
        header = json.loads(output.readline())
        coded.append((header["video"], [output.read(size) for size in header["picture_bytes"]]))
    return coded


def video_message(layout, video, units, reference_sequence=None, **header):
    """units: as coded. reference_sequence: of chained video; 0 = it needs no other."""
    chain = {} if reference_sequence is None else {"prediction": "ACROSS_ATLASES"}
    return message({"layout": {**layout, "video": video},
                    "encoding": {"color": "H264", "jpeg_quality": 85, "chroma": "420", **chain},
                    "reference_sequence": reference_sequence or 0,
                    "picture_bytes": [len(unit) for unit in units], **header}, b"".join(units))


def jpeg_message(layout, views, quality=85, **header):
    jpeg = io.BytesIO()
    Image.fromarray(quilt_of(views, layout)).save(jpeg, "JPEG", quality=quality, subsampling=2)
    return message({"layout": layout, "encoding": {"jpeg_quality": quality, "chroma": "420"},
                    "jpeg_bytes": len(jpeg.getvalue()), **header}, jpeg.getvalue())


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, format, *args):  # pylint: disable=redefined-builtin
        pass

    def do_GET(self):
        path = self.path.split("?")[0].lstrip("/") or "index.html"
        kind, body = self._found(path)
        self.send_response(404 if body is None else 200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body or b"")))
        self.end_headers()
        self.wfile.write(body or b"")

    def _found(self, path):
        if path in self.server.contents:
            content = self.server.contents[path]
            if isinstance(content, bytes):
                return "application/octet-stream", content
            return "application/json", json.dumps(content).encode()
        for folder in (HERE, PAGE, os.path.join(SHARED, "shared")):
            file = os.path.join(folder, os.path.normpath(path))
            if os.path.isfile(file):
                with open(file, "rb") as content:
                    return TYPES.get(os.path.splitext(path)[1], "text/plain"), content.read()
        return "text/plain", None


class PageFiles(http.server.ThreadingHTTPServer):
    """Serves the page's files, those beside this one, and `contents`, until close()."""
    daemon_threads = True

    def __init__(self, contents):
        super().__init__(("127.0.0.1", 0), Handler)
        self.contents = contents  # by path: bytes, or what becomes JSON
        self.url = f"http://127.0.0.1:{self.server_address[1]}/"
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def close(self):
        self.shutdown()
        self.server_close()
