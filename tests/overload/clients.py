# SPDX-License-Identifier: Apache-2.0
"""Clients that take little CPU time themselves, which the server and the healthy pair need: they
make their messages beforehand, and do not unpack what comes."""

import functools
import itertools
import math
import threading
import time

import grpc
import numpy as np
from google.protobuf import json_format

import viewloom
from viewloom.frame_messages import frame_messages
from viewloom.v1 import display_service_pb2 as display_service
from viewloom.v1 import ingest_service_pb2 as ingest_service

PUBLISH = "/viewloom.v1.IngestService/PublishFrames"
WATCH = "/viewloom.v1.DisplayService/StreamAtlases"
# First byte of an answer: the number of its field, and 2 for a message.
ATLAS_END, SKIPPED, WANTED = b"\x22", b"\x2a", b"\x1a"
RATE_MIN_HZ = 0.1
POSE_COUNT = 256
BYTES_UNLIMITED = (("grpc.max_receive_message_length", -1), ("grpc.max_send_message_length", -1))


def source(width_px, height_px, layer_count=1, shade=0, **more):
    """A square before a wall. Another shade is another picture. more: fields of viewloom.Source."""
    y, x = np.mgrid[0:height_px, 0:width_px]
    is_square = (abs(x * 2 - width_px) * 3 < width_px) & (abs(y * 2 - height_px) * 2 < height_px)
    color = np.empty((height_px, width_px, 3), np.uint8)
    color[..., 0], color[..., 1], color[..., 2] = x & 255, y & 255, shade
    colors = [color] + [color // 2] * (layer_count - 1)
    front_m = np.where(is_square, 2.0, 4.0).astype(np.float32)
    depths_m = [front_m + layer for layer in range(layer_count)]
    return viewloom.Source(colors, depths_m, fov_y_rad=0.9, pose=np.eye(4), **more)


class Frames:
    """Frames of one stream, by turns, as bytes. The camera moves to and fro. Thread-safety: none,
    each stream has its own."""

    def __init__(self, sources, zstd_level=0):
        self._frames = [frame_messages(1, one, capture_time_ns=0, zstd_level=zstd_level)
                        for one in sources]
        self._chunks = [[chunk.SerializeToString() for chunk in messages[1:]]
                        for messages in self._frames]

    def replace_first_plane(self, encoding, side_px, data):
        """Sends these bytes, at most 1 MiB, as the colour of each frame."""
        for messages, chunks in zip(self._frames, self._chunks):
            plane = messages[0].header.sources[0].layers[0].planes[0]
            plane.encoding, plane.bytes_count = encoding, len(data)
            plane.size.width = plane.size.height = side_px
            chunk = ingest_service.PublishFramesRequest(
                chunk=ingest_service.FrameChunk(plane_index=0, data=data))
            chunks[0] = chunk.SerializeToString()

    def messages(self, number):
        which = number % len(self._frames)
        request = self._frames[which][0]
        request.header.number = number
        request.header.capture_time_ns = time.time_ns()
        request.header.sources[0].camera.pose.position.x = 0.02 * math.sin(number / 5)
        return [request.SerializeToString(), *self._chunks[which]]


def scene(width_px=320, height_px=180, layer_count=1):
    return Frames([source(width_px, height_px, layer_count, shade) for shade in (0, 90)])


def mirrors(width_px=320, height_px=180):
    """All that is seen mirrors, and is rough."""
    surface = np.full((height_px, width_px), 0.5, np.float32)
    return Frames([source(width_px, height_px, shade=shade, specular=surface, roughness=surface)
                   for shade in (0, 90)])


class Stream:
    """Publishes at a steady rate. obeys: no faster than the server can use frames."""

    def __init__(self, channel, metadata, name, frames, rate_hz, obeys=True):
        self.sent = 0
        self.ended = ""  # why the call ended before it was told to
        self._frames, self._rate_hz, self._obeys = frames, rate_hz, obeys
        self._stopping = threading.Event()
        self._call = channel.stream_stream(PUBLISH)(self._requests(name), metadata=metadata)
        threading.Thread(target=self._read, daemon=True).start()

    def _requests(self, name):
        settings = ingest_service.PublishFramesRequest()
        settings.settings.stream = name
        yield settings.SerializeToString()
        next_s = time.monotonic()
        while not self._stopping.wait(max(0.0, next_s - time.monotonic())):
            self.sent += 1
            yield from self._frames.messages(self.sent)
            next_s = max(next_s + 1 / self._rate_hz, time.monotonic() - 1 / self._rate_hz)

    def _read(self):
        fastest_hz = self._rate_hz
        try:
            for message in self._call:
                if self._obeys and message[:1] == WANTED:
                    wanted_hz = ingest_service.PublishFramesResponse.FromString(
                        message).wanted.rate_hz
                    self._rate_hz = min(fastest_hz, max(wanted_hz or fastest_hz, RATE_MIN_HZ))
        except grpc.RpcError as error:
            if not self._stopping.is_set():
                self.ended = f"{error.code().name}: {error.details()}"

    def stop(self):
        self._stopping.set()
        self._call.cancel()


@functools.lru_cache
def eye_poses(seed):
    """Poses of eyes that move and lean, in a circle, as messages."""
    return [eye_pose(seed, step) for step in range(POSE_COUNT)]


def eye_pose(seed, step):
    turn = 2 * math.pi * step / POSE_COUNT + seed
    lean = 0.1 * math.sin(3 * turn)
    place = {"y": 0.03 * math.cos(2 * turn), "z": 0.1 * math.sin(turn)}
    eyes = [{"pose": {"position": {"x": x + 0.1 * math.cos(turn), **place},
                      "orientation": {"z": math.sin(lean), "w": math.cos(lean)}}}
            for x in (-0.03, 0.03)]
    return json_format.ParseDict({"eyePoses": {"timeNs": step + 1, "eyes": eyes}},
                                 display_service.StreamAtlasesRequest()).SerializeToString()


class Viewer:
    """Reads the atlases of a display. poses_hz: how often a tracked one is told where its eyes
    are. count: of atlases after which the call ends; 0 = none."""

    def __init__(self, channel, metadata, stream, display, encoding=None, *, poses_hz=0, count=0):
        self.atlases = self.skipped = 0
        self.ended = ""  # why the call ended before it was told to
        self.done = threading.Event()
        self._stopping = threading.Event()
        self._poses_hz = poses_hz
        opened = {"stream": stream, "display": display, "encoding": encoding or {},
                  "wait_for_stream": True, "count": count}
        self._open = json_format.ParseDict(
            {"open": opened}, display_service.StreamAtlasesRequest()).SerializeToString()
        self._call = channel.stream_stream(WATCH)(self._requests(), metadata=metadata)
        threading.Thread(target=self._read, daemon=True).start()

    def _requests(self):
        yield self._open
        if self._poses_hz:
            for pose in itertools.cycle(eye_poses(id(self) % 7)):
                if self._stopping.wait(1 / self._poses_hz):
                    return
                yield pose
        self._stopping.wait()

    def _read(self):
        try:
            for message in self._call:
                kind = message[:1]
                self.atlases += kind == ATLAS_END
                if kind == SKIPPED:
                    self.skipped += display_service.StreamAtlasesResponse.FromString(
                        message).skipped.count
        except grpc.RpcError as error:
            if not self._stopping.is_set():
                self.ended = f"{error.code().name}: {error.details()}"
        self.done.set()

    def stop(self):
        self._stopping.set()
        self._call.cancel()


class Session:
    """One client: a connection with its token, a stream of its own, and what it watches."""

    def __init__(self, address, token, name):
        self.name = name
        self.stopping = threading.Event()
        self._metadata = (("authorization", f"Bearer {token}"),) if token else ()
        self._channel = address.channel(**dict(BYTES_UNLIMITED))
        self._streams, self._viewers, self._threads = [], [], []

    def publish(self, frames, rate_hz=10, name="", obeys=True):
        self._streams.append(Stream(self._channel, self._metadata, name or self.name, frames,
                                    rate_hz, obeys))

    def watch(self, display, encoding=None, stream="", **options):
        viewer = Viewer(self._channel, self._metadata, stream or self.name, display, encoding,
                        **options)
        self._viewers.append(viewer)
        return viewer

    def watch_in_turn(self, requests, patience_s=20):
        """One atlas of each (display, encoding), on a thread. Returns the thread."""
        def run():
            for display, encoding in requests:
                if self.stopping.is_set():
                    return
                self.watch(display, encoding, count=1).done.wait(patience_s)

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        self._threads.append(thread)
        return thread

    def atlases(self):
        return sum(viewer.atlases for viewer in self._viewers)

    def sent(self):
        return sum(stream.sent for stream in self._streams)

    def refusals(self):
        """What the server said to calls that it ended, each once."""
        return sorted({one.ended for one in self._streams + self._viewers if one.ended})

    def close(self):
        self.stopping.set()
        for one in self._streams + self._viewers:
            one.stop()
        self._channel.close()
        for thread in self._threads:
            thread.join(5)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
