# SPDX-License-Identifier: Apache-2.0
"""The web port of a server that shows ray_scene.py: the page's files, and /ws for one or two
tracked eyes, with a latency that the test chooses. It shares no code with viewloom."""
import base64
import hashlib
import http.server
import io
import json
import math
import os
import struct
import threading
import time
import urllib.parse
import zlib

import numpy as np
from PIL import Image

import ray_scene

PAGE = os.path.join(os.path.dirname(__file__), "..", "..", "client", "web")
SHADERS = os.path.join(os.path.dirname(__file__), "..", "..", "shaders")
CODE_MAX = 4095
BAND_ROWS = 128
CONE_RAD = math.radians(40)
REFUSED = 1008  # close code
KEY_END = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css",
         ".svg": "image/svg+xml", ".json": "application/json"}
PORTRAIT = {"name": "portrait", "device": "Portrait", "kinds": ["quilt"], "note": "", "layout": {
    "size": {"width": 3360, "height": 3360}, "columns": 8, "rows": 6, "aspect": 0.75,
    "tile_size": {"width": 420, "height": 560}, "view_count": 48, "view_cone_rad": CONE_RAD}}
RANGES = {f"quilt.{name}": {"min": 1, "max": 16384}
          for name in ("columns", "rows", "size.width", "size.height", "aspect")}


def compact_depth(inv_z):
    """Bands of BAND_ENCODING_COMPACT_DEPTH, as proto/web.md describes them."""
    bands = []
    for first in range(0, inv_z.shape[0], BAND_ROWS):
        rows = inv_z[first:first + BAND_ROWS]
        height, width = rows.shape
        padded = np.pad(rows, ((0, height % 2), (0, width % 2)), mode="edge")
        blocks = padded.reshape(padded.shape[0] // 2, 2, padded.shape[1] // 2, 2).max((1, 3))
        step = np.float32(blocks.max() / CODE_MAX)
        codes = np.rint(blocks / step).astype(np.int64) if step > 0 else np.zeros_like(blocks, int)
        around = np.pad(codes, ((1, 0), (1, 0)))
        residual = (codes - (around[1:, :-1] + around[:-1, 1:] - around[:-1, :-1])) & 0xffff
        signed = np.where(residual >= 0x8000, residual - 0x10000, residual)
        written = np.where(signed < 0, -2 * signed - 1, 2 * signed)
        packed = struct.pack("<f", step) + zlib.compress(
            (written & 255).astype(np.uint8).tobytes() + (written >> 8).astype(np.uint8).tobytes())
        bands.append(({"first_row": first, "row_count": height, "bytes": len(packed)}, packed))
    return bands


class Viewer:
    """One WebSocket: a thread reads, another renders the newest poses."""

    def __init__(self, connection, display, with_depth, delay_s):
        self.connection = connection
        self.changed = threading.Condition()
        self.display, self.with_depth, self.delay_s = display, with_depth, delay_s
        self.poses, self.is_new, self.is_open = None, True, True
        self.texts, self.shown, self.sent, self.changes = [], 0, 0, 0
        self.sequence = 0

    def take(self, message):
        with self.changed:
            if "eye_poses" in message:
                self.poses = dict(message["eye_poses"], latched=time.monotonic_ns())
                self.is_new = True
                self.connection.server.poses.append(self.poses)
            elif "change" in message:
                self.display = message["change"].get("display", self.display)
                encoding = message["change"].get("encoding")
                self.with_depth = encoding.get("with_depth", False) if encoding is not None \
                    else self.with_depth
                self.changes += 1
                self.sequence = 0
                self.is_new = True
                self.connection.server.displays.append(self.display)
            elif "shown" in message:
                self.shown = message["shown"]
            elif "ping" in message:
                self.texts.append({"pong": message["ping"]})
            elif "clock_probe" in message:
                now = str(time.monotonic_ns())
                self.texts.append({"clock": {
                    "client_time_ns": message["clock_probe"]["client_time_ns"],
                    "server_received_ns": now, "server_sent_ns": now}})
            elif "presented" in message:
                self.connection.server.presented.append(message["presented"])
            self.changed.notify_all()

    def _next(self):
        """What to do: a text, or what is to be rendered."""
        with self.changed:
            self.changed.wait_for(lambda: not self.is_open or self.texts
                                  or (self.is_new and self.sent - self.shown < 2), 1)
            if self.texts:
                return self.texts.pop(0), None
            if self.is_open and self.is_new and self.sent - self.shown < 2:
                self.is_new = False
                return None, (self.poses, self.display, self.with_depth, self.changes)
            return None, None

    def run(self):
        try:
            while self.is_open:
                text, job = self._next()
                if text is not None:
                    self.connection.send_frame(1, json.dumps(text).encode())
                if job is not None:
                    self.connection.send_frame(2, self._render(*job))
        except OSError:
            pass

    def _render(self, poses, display, with_depth, changes):
        begun = time.monotonic()
        stereo = display["stereo"]
        width, height = stereo["eye_size"]["width"], stereo["eye_size"]["height"]
        count = 1 if stereo.get("layout") == "STEREO_LAYOUT_SINGLE" else 2
        if poses is not None and len(poses["eyes"]) == count:
            eyes = [ray_scene.Eye.of_message(eye, width, height) for eye in poses["eyes"]]
        else:
            poses = None
            eyes = [ray_scene.Eye.straight(0 if count == 1 else 0.063 * (i - 0.5), width, height)
                    for i in range(count)]
        views = [ray_scene.look(eye, width, height) for eye in eyes]
        colour = np.concatenate([view[0] for view in views], 1)
        jpeg = io.BytesIO()
        Image.fromarray(colour).save(jpeg, "JPEG", quality=92, subsampling=0)
        bands = compact_depth(np.concatenate([view[1] for view in views], 1)) if with_depth else []
        if poses is not None:
            time.sleep(max(0, self.delay_s - (time.monotonic() - begun)))
        self.sequence += 1
        self.sent += 1
        trace_ns = int((time.monotonic() - begun) * 1e9)
        header = {
            "sequence": self.sequence, "delivery": self.sent, "frame_number": "1",
            "capture_time_ns": "0", "shown_time_ns": "0", "present_at_ns": "0",
            "timing": "captured", "method": "walk", "defaults_count": 1,
            "defaults_reason": "first_frame", "change_count": changes, "dropped_count": 0,
            "mailbox_ns": 0, "shown_ns": 0, "views_outside": [],
            "jpeg_bytes": len(jpeg.getvalue()),
            "depth_bytes": sum(len(packed) for _, packed in bands),
            "encoding": {"jpeg_quality": 92, "chroma": "444"},
            "coverage": {"hit": 1, "hit_assumed": 0, "hidden": 0, "outside": 0, "empty": 0},
            "times": {"receive_ns": 0, "decode_ns": 0, "upload_ns": 0, "build_ns": 0,
                      "retime_ns": 0, "wait_ns": 0, "trace_ns": trace_ns, "encode_ns": 0,
                      "total_ns": trace_ns},
            "layout": {"size": {"width": count * width, "height": height}, "columns": count,
                       "rows": 1, "tile_size": {"width": width, "height": height},
                       "order": "TOP_LEFT", "aspect": width / height, "view_count": count,
                       "padding_right_px": 0, "padding_top_px": 0, "view_cone_rad": 0,
                       "cone_begin": 0, "cone_end": 0, "focal_distance_m": ray_scene.FOCAL_M,
                       "suffix": "", "views": [eye.message() for eye in eyes]}}
        if with_depth:
            header["depth_bands"] = [band for band, _ in bands]
        if poses is not None:
            header["eyes"] = {"time_ns": poses["time_ns"], "predicted_display_time_ns": "0",
                              "latched_ns": str(poses["latched"]), "age_ns": 0}
        text = json.dumps(header).encode()
        return b"".join([struct.pack("<I", len(text)), text, jpeg.getvalue(),
                         *(packed for _, packed in bands)])


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, format, *args):  # pylint: disable=redefined-builtin
        pass

    def do_GET(self):
        url = urllib.parse.urlsplit(self.path)
        if url.path == "/ws":
            return self._watch(dict(urllib.parse.parse_qsl(url.query)))
        return self._answer(*self._file(url.path))

    def _file(self, path):
        apis = {"/api/session": {}, "/api/presets": {"presets": [PORTRAIT]},
                "/api/fields": {"fields": RANGES},
                "/api/streams": {"streams": [{"name": "rays", "live": True}]}}
        if path in apis:
            return "application/json", json.dumps(apis[path]).encode()
        name = path.lstrip("/") or "index.html"
        folders = [*self.server.folders, PAGE, os.path.join(SHADERS, "shared")]
        for folder in folders:
            file = os.path.join(folder, os.path.normpath(name))
            if os.path.isfile(file):
                with open(file, "rb") as content:
                    return TYPES.get(os.path.splitext(name)[1], "text/plain"), content.read()
        return None, b"{}"

    def _answer(self, kind, body):
        self.send_response(404 if kind is None else 200)
        self.send_header("Content-Type", kind or "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def _watch(self, parameters):
        key = self.headers["Sec-WebSocket-Key"].encode() + KEY_END
        self.send_response(101)
        for name, value in (("Upgrade", "websocket"), ("Connection", "Upgrade"),
                            ("Sec-WebSocket-Accept",
                             base64.b64encode(hashlib.sha1(key).digest()).decode())):
            self.send_header(name, value)
        self.end_headers()
        self.lock = threading.Lock()
        display = json.loads(parameters["display"])
        encoding = json.loads(parameters.get("encoding", "{}"))
        self.server.displays.append(display)
        refusal = self.server.refusals.get(display["stereo"].get("layout"))
        if refusal is not None:
            self.send_frame(1, json.dumps({"error": refusal}).encode())
            self.send_frame(8, struct.pack("!H", REFUSED))
            self.close_connection = True
            return
        viewer = Viewer(self, display, encoding.get("with_depth", False), self.server.delay_s)
        self.server.viewers.append(viewer)
        threading.Thread(target=viewer.run, daemon=True).start()
        try:
            self._read(viewer)
        except (OSError, struct.error):
            pass
        viewer.is_open = False
        self.close_connection = True

    def _read(self, viewer):
        while True:
            first, second = self.rfile.read(2)
            size = second & 127
            if size == 126:
                (size,) = struct.unpack("!H", self.rfile.read(2))
            mask = self.rfile.read(4)
            data = bytes(byte ^ mask[i % 4] for i, byte in enumerate(self.rfile.read(size)))
            if first & 15 == 8:
                return
            if first & 15 == 1:
                viewer.take(json.loads(data))

    def send_frame(self, opcode, data):
        size = len(data)
        length = struct.pack("!B", size) if size < 126 else struct.pack("!BH", 126, size) \
            if size < 1 << 16 else struct.pack("!BQ", 127, size)
        with self.lock:
            self.wfile.write(bytes([0x80 | opcode]) + length + data)


class RayServer(http.server.ThreadingHTTPServer):
    """Serves until close(). folders: whose files come before those of the page."""
    daemon_threads = True

    def __init__(self, delay_s=0.0, folders=()):
        super().__init__(("127.0.0.1", 0), Handler)
        self.delay_s, self.folders = delay_s, folders
        self.poses, self.displays, self.presented = [], [], []  # as they came
        self.viewers = []  # one a connection
        self.refusals = {}  # {code, field, message} of an error, by layout
        self.url = f"http://127.0.0.1:{self.server_address[1]}/"
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def handle_error(self, request, client_address):
        """A browser that goes while it is answered is no fault."""

    def close(self):
        self.shutdown()
        self.server_close()
