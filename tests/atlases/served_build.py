# SPDX-License-Identifier: Apache-2.0
"""The programs of one build folder: a server that is asked for atlases, and the client that
publishes to it. Needs the generated Python stubs, which a build has in client/python."""

import dataclasses
import json
import re
import subprocess
import threading

import grpc
from google.protobuf import json_format

from viewloom.v1 import atlas_pb2 as atlas
from viewloom.v1 import display_service_pb2 as service
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub
from viewloom.v1.ingest_service_pb2_grpc import IngestServiceStub

PATIENCE_S = 600
# Fields of an answer that name a moment or a load, not a picture.
TIMES = {"times", "stats", "sequence", "present_at_ns", "capture_time_ns", "shown_time_ns",
         "eye_poses_latched_ns", "eye_poses_age_ns", "band_count"}


@dataclasses.dataclass
class Answer:
    """What came of one request: bytes by (image, plane, packing), and what was said of them."""
    planes: dict
    words: dict


class ServedBuild:
    def __init__(self, folder):
        self._server = folder / "server" / "viewloomd"
        self._client = folder / "client" / "cli" / "viewloom"
        # Builds of older commits have the command in the server.
        client_help = subprocess.run([self._client, "--help"], capture_output=True, text=True,
                                     check=True).stdout
        self._renders = self._client if "\n  render " in client_help else self._server
        self._publishers = {}
        self._process = subprocess.Popen(
            [self._server, "serve", "--grpc.address", "127.0.0.1:0", "--http.address",
             "127.0.0.1:0"], stdout=subprocess.PIPE, text=True)
        self._address = re.search(r"grpc=(\S+)", self._process.stdout.readline()).group(1)
        self._channel = grpc.insecure_channel(
            self._address, options=[("grpc.max_receive_message_length", -1)])
        self._displays = DisplayServiceStub(self._channel)

    def publish(self, stream, arguments):
        """One frame, which then stands."""
        self._publishers[stream] = subprocess.Popen(
            [self._client, "publish", "--server", self._address, "--stream", stream, "--hold",
             "--quiet", *arguments])

    def ask(self, stream, display, encoding, eyes=None):
        """The first atlas of the stream; with eyes, the first that shows what they see."""
        if stream in self._publishers and self._publishers[stream].poll() is not None:
            raise RuntimeError(f"{self._client} does not publish {stream}")
        ended = threading.Event()
        opened = {"stream": stream, "display": display, "encoding": encoding,
                  "wait_for_stream": True}

        def messages():
            yield service.StreamAtlasesRequest(
                open=json_format.ParseDict(opened, service.OpenDisplay()))
            if eyes:
                yield service.StreamAtlasesRequest(eye_poses=json_format.ParseDict(
                    {"time_ns": 1, "eyes": eyes}, service.EyePoses()))
            ended.wait(PATIENCE_S)

        call = self._displays.StreamAtlases(messages(), timeout=PATIENCE_S)
        try:
            return _first_atlas(call, eyes is not None)
        except grpc.RpcError as error:
            return Answer({}, {"refused": f"{error.code().name}: {error.details()}"})
        finally:
            ended.set()
            call.cancel()

    def watch(self, stream, display, encoding, on_atlas):
        """Calls on_atlas() after each atlas, on a thread, until stop() of what it returns."""
        def on_message(message):
            if message.WhichOneof("message") == "end":
                on_atlas()

        return self.watch_messages(stream, display, encoding, on_message)

    def watch_messages(self, stream, display, encoding, on_message):
        """The same with each message that comes."""
        return Watching(self._displays, {"stream": stream, "display": display, "encoding": encoding,
                                         "wait_for_stream": True}, on_message)

    def send_frames(self, requests):
        """Publishes what the iterator gives, on a thread of gRPC."""
        return IngestServiceStub(self._channel).PublishFrames(requests)

    def render(self, folder, display, arguments):
        """The pictures that `viewloom render` writes, as planes."""
        folder.mkdir(parents=True)
        described = folder / "display.json"
        described.write_text(json.dumps(display), encoding="utf-8")
        run = subprocess.run(
            [self._renders, "render", "--display", described, "--out", folder / "out", *arguments],
            capture_output=True, text=True, timeout=PATIENCE_S)
        if run.returncode:
            return Answer({}, {"refused": run.stderr})
        return Answer({(0, path.name, "file"): path.read_bytes()
                       for path in sorted((folder / "out").iterdir())}, {})

    def stop(self):
        self._channel.close()
        for process in [*self._publishers.values(), self._process]:
            process.terminate()
            process.wait(PATIENCE_S)
        self._process.stdout.close()


class Watching:
    """A viewer that goes on."""

    def __init__(self, displays, opened, on_message):
        self._ended = threading.Event()
        self._call = displays.StreamAtlases(self._messages(opened))
        self._thread = threading.Thread(target=self._run, args=(on_message,))
        self._thread.start()

    def _messages(self, opened):
        yield service.StreamAtlasesRequest(
            open=json_format.ParseDict(opened, service.OpenDisplay()))
        self._ended.wait()

    def _run(self, on_message):
        try:
            for message in self._call:
                on_message(message)
        except grpc.RpcError as error:
            if not self._ended.is_set():
                raise RuntimeError(f"{error.code().name}: {error.details()}") from error

    def stop(self):
        self._ended.set()
        self._call.cancel()
        self._thread.join()


def _first_atlas(call, awaits_eyes):
    planes, words = {}, {}
    for message in call:
        kind = message.WhichOneof("message")
        content = getattr(message, kind)
        if kind == "band":
            plane = (content.image_index, atlas.AtlasPlane.Name(content.plane),
                     atlas.BandEncoding.Name(content.encoding))
            planes[plane] = planes.get(plane, b"") + content.data
        elif kind in ("layout", "header", "end"):
            if kind == "header":
                planes = {}
            words.update(json_format.MessageToDict(content, preserving_proto_field_name=True))
            if kind == "end" and (not awaits_eyes or "eye_poses_time_ns" in words):
                break
    return Answer(planes, {name: said for name, said in words.items() if name not in TIMES})
