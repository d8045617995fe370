# SPDX-License-Identifier: Apache-2.0
"""Access tokens from their making to their end, over gRPC and through the commands. Arguments:
viewloomd-without-engines (it needs no device), viewloom, folder of the Python package."""
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import viewloomd  # takes its argument

CLIENT = sys.argv.pop(1)
sys.path.insert(0, sys.argv.pop(1))

import grpc
from viewloom.v1 import catalog_service_pb2 as catalog
from viewloom.v1 import display_service_pb2 as display
from viewloom.v1 import frame_pb2 as frame
from viewloom.v1 import ingest_service_pb2 as ingest
from viewloom.v1.catalog_service_pb2_grpc import CatalogServiceStub
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub
from viewloom.v1.ingest_service_pb2_grpc import IngestServiceStub

Code = grpc.StatusCode
LISTS = ("ListStreams", "ListDisplays", "ListPresets", "GetServerInfo")
SMALL_LIMITS = "connections=2,streams=1,displays=1,pixels_per_s=1000000"
HELD_S = 30  # longest life of a call that nobody ends
NOTICED_S = 3  # a change of the token file, and the calls that it ends


class Access(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "tokens.jsonl"
        self.audit = self.folder / "audit.jsonl"
        self.tokens = {
            name: self.add(name, "--role", role, "--streams", streams, "--limits", limits)
            for name, role, streams, limits in (("camera", "publish", "room.*", ""),
                                                ("wall", "watch", "room.*", ""),
                                                ("other", "publish,watch", "hall", ""),
                                                ("metrics", "operate", "*", ""),
                                                ("small", "publish,watch", "room.*", SMALL_LIMITS),
                                                ("slow", "publish", "room.*", "bytes_per_s=1000"))}
        self.server = viewloomd.Viewloomd(options=("--access.token_file", self.file,
                                                   "--access.audit_file", self.audit))
        self.addCleanup(self.server.stop)
        self.channel = grpc.insecure_channel(self.server.address)
        self.addCleanup(self.channel.close)

    def token_command(self, *words):
        return subprocess.run([viewloomd.PROGRAM, "token", *words, "--access.token_file",
                               self.file], capture_output=True, text=True, check=False)

    def add(self, name, *options):
        done = self.token_command("add", name, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        token = done.stdout.strip()
        self.assertNotIn(token, done.stderr)
        self.assertNotIn(token, self.file.read_text(encoding="utf-8"))
        return token

    def metadata(self, token):
        return (("authorization", f"Bearer {token}"),) if token else ()

    def code(self, call):
        """The code with which a call ends; OK once it has answered."""
        try:
            if not isinstance(call, grpc.Call):
                return Code.OK  # a unary answer
            next(call)
            call.cancel()
            return Code.OK
        except StopIteration:
            return Code.OK
        except grpc.RpcError as error:
            return error.code()

    def open_calls(self, stream, token):
        """Codes of the two calls that stay."""
        held = threading.Event()

        def settings():
            yield ingest.PublishFramesRequest(settings={"stream": stream})
            held.wait()

        def opening():
            yield display.StreamAtlasesRequest(open={
                "stream": stream, "display": {"preset": "portrait"}, "wait_for_stream": True,
                "wants_heartbeats": True})
            held.wait()

        shown = self.metadata(token)
        publish = self.code(IngestServiceStub(self.channel).PublishFrames(settings(),
                                                                          metadata=shown))
        watch = self.code(DisplayServiceStub(self.channel).StreamAtlases(opening(), metadata=shown))
        held.set()
        return publish, watch

    def held(self, method, name, *messages):
        """A call of a token that stays open until the test ends, or it is cancelled."""
        done = threading.Event()
        self.addCleanup(done.set)

        def sent():
            yield from messages
            done.wait()

        return method(sent(), metadata=self.metadata(self.tokens[name]), timeout=HELD_S)

    def publishing(self, name, stream, *messages):
        return self.held(IngestServiceStub(self.channel).PublishFrames, name,
                         ingest.PublishFramesRequest(settings={"stream": stream}), *messages)

    def watching(self, name, **shown):
        opening = {"stream": "room.1", "display": shown, "wait_for_stream": True,
                   "wants_heartbeats": True}
        return self.held(DisplayServiceStub(self.channel).StreamAtlases, name,
                         display.StreamAtlasesRequest(open=opening))

    def opened(self, open_call):
        """A call that has answered. The server notices a moment later that others have ended."""
        end_s = time.monotonic() + NOTICED_S
        while True:
            call = open_call()
            try:
                next(call)
                return call
            except grpc.RpcError as error:
                if error.code() != Code.RESOURCE_EXHAUSTED or time.monotonic() > end_s:
                    raise
                time.sleep(0.1)

    def assert_exhausted(self, open_call, *parts):
        """Likewise a call that is refused, with these words."""
        end_s = time.monotonic() + NOTICED_S
        while True:
            with self.assertRaises(grpc.RpcError) as refused:
                for _ in open_call():
                    pass
            self.assertEqual(refused.exception.code(), Code.RESOURCE_EXHAUSTED)
            said = refused.exception.details()
            if all(part in said for part in parts):
                return
            self.assertLess(time.monotonic(), end_s, f"{parts} not in {said}")
            time.sleep(0.1)

    def list_codes(self, token):
        codes = set()
        for name in LISTS:
            try:
                getattr(CatalogServiceStub(self.channel), name)(
                    getattr(catalog, name + "Request")(), metadata=self.metadata(token))
                codes.add(Code.OK)
            except grpc.RpcError as error:
                codes.add(error.code())
        return codes

    def test_roles_and_streams_hold_for_each_rpc(self):
        denied, unknown = Code.PERMISSION_DENIED, Code.UNAUTHENTICATED
        for name, stream, publish, watch in (("camera", "room.1", Code.OK, denied),
                                             ("camera", "hall", denied, denied),
                                             ("wall", "room.1", denied, Code.OK),
                                             ("wall", "hall", denied, denied),
                                             ("other", "hall", Code.OK, Code.OK),
                                             ("other", "room.1", denied, denied),
                                             ("metrics", "room.1", denied, denied)):
            self.assertEqual(self.open_calls(stream, self.tokens[name]), (publish, watch),
                             (name, stream))
            self.assertEqual(self.list_codes(self.tokens[name]), {Code.OK})
        for token in ("", "viewloom_wrong", self.tokens["wall"][:-1] + "?"):
            self.assertEqual(self.open_calls("room.1", token), (unknown, unknown))
            self.assertEqual(self.list_codes(token), {unknown})

    def test_limits_hold_for_all_calls_of_a_token(self):
        quilt = {"columns": 4, "rows": 4, "size": {"width": 512, "height": 512}}
        other = {**quilt, "columns": 2}
        published = self.opened(lambda: self.publishing("small", "room.1"))
        self.assert_exhausted(lambda: self.publishing("small", "room.2"),
                              "settings.stream: a further", "accepted are 1 at a time",
                              '(limit streams of the access token of "small")')
        self.assert_exhausted(lambda: self.watching("small", preset="portrait"), "open.display: ",
                              "of 1000000 are left (limit pixels_per_s", "Such a display fits")
        watched = self.opened(lambda: self.watching("small", quilt=quilt))
        self.assert_exhausted(lambda: self.watching("small", quilt=quilt),
                              "accepted are 2 at a time (limit connections")
        published.cancel()
        self.assert_exhausted(lambda: self.watching("small", quilt=other),
                              "open.display: a further", "accepted are 1 at a time (limit displays")
        same = self.opened(lambda: self.watching("small", quilt=quilt))
        watched.cancel()
        same.cancel()
        self.opened(lambda: self.watching("small", quilt=other))
        self.assertIn("(limit displays", self.audit.read_text(encoding="utf-8"))

    def test_a_token_that_sends_too_much_loses_its_call(self):
        size = {"width": 64, "height": 64}
        planes = [frame.Plane(kind=frame.PLANE_KIND_COLOR, encoding=frame.PLANE_ENCODING_RGBA8,
                              size=size, bytes_count=64 * 64 * 4),
                  frame.Plane(kind=frame.PLANE_KIND_DEPTH, encoding=frame.PLANE_ENCODING_DEPTH_F32,
                              size=size, bytes_count=64 * 64 * 4,
                              depth={"meaning": frame.DEPTH_MEANING_PLANAR})]
        fov = {"angle_left_rad": -0.5, "angle_right_rad": 0.5, "angle_up_rad": 0.5,
               "angle_down_rad": -0.5}
        header = frame.FrameHeader(number=1, sources=[frame.Source(
            camera={"fov": fov}, layers=[frame.Layer(planes=planes)])])
        messages = (ingest.PublishFramesRequest(header=header),
                    ingest.PublishFramesRequest(chunk={"data": bytes(64 * 64 * 4)}))
        free = self.opened(lambda: self.publishing("camera", "room.1", *messages))
        self.assert_exhausted(lambda: self.publishing("slow", "room.2", *messages),
                              "16384 bytes were used within",
                              "accepted are 1000 a second (limit bytes_per_s")
        self.assertTrue(free.is_active())

    def test_health_needs_no_token(self):
        check = self.channel.unary_unary("/grpc.health.v1.Health/Check")
        self.assertEqual(check(b""), b"\x08\x01")  # SERVING

    def test_a_revoked_token_ends_its_calls(self):
        held = threading.Event()
        self.addCleanup(held.set)

        def settings():
            yield ingest.PublishFramesRequest(settings={"stream": "room.1"})
            held.wait()

        call = IngestServiceStub(self.channel).PublishFrames(
            settings(), metadata=self.metadata(self.tokens["camera"]))
        next(call)
        self.assertEqual(self.token_command("revoke", "camera").returncode, 0)
        revoked = time.monotonic()
        with self.assertRaises(grpc.RpcError) as ended:
            for _ in call:
                pass
        self.assertEqual(ended.exception.code(), Code.UNAUTHENTICATED)
        self.assertLess(time.monotonic() - revoked, NOTICED_S)
        self.assertEqual(self.list_codes(self.tokens["camera"]), {Code.UNAUTHENTICATED})

    def client(self, *words, token="", **more):
        environment = {**os.environ, "VIEWLOOM_TOKEN": token}
        return subprocess.run([CLIENT, "--server", self.server.address, *words],
                              capture_output=True, text=True, env=environment, check=False,
                              timeout=viewloomd.PATIENCE_S, **more)

    def test_the_commands_take_a_token(self):
        refused = self.client("list", "streams")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("--token-file or VIEWLOOM_TOKEN", refused.stderr)
        self.assertEqual(self.client("list", "streams", token=self.tokens["wall"]).returncode, 0)
        kept = self.folder / "token"
        kept.write_text(self.tokens["wall"] + "\n", encoding="utf-8")
        self.assertEqual(self.client("list", "streams", "--token-file", kept).returncode, 0)
        bad = self.folder / "bad"
        bad.write_text("two words", encoding="utf-8")
        wrong = self.client("list", "streams", "--token-file", bad)
        self.assertEqual(wrong.returncode, 2)
        self.assertNotIn("two words", wrong.stderr)

    def test_no_secret_is_in_a_log(self):
        self.open_calls("room.1", self.tokens["wall"])
        self.open_calls("room.1", "viewloom_wrong")
        audit = self.audit.read_text(encoding="utf-8")
        self.assertIn('"id":"wall"', audit)
        self.assertIn('"outcome":"refused"', audit)
        for secret in (*self.tokens.values(), "viewloom_wrong"):
            self.assertNotIn(secret, audit)

    def test_a_bad_file_leaves_the_old_one_in_force(self):
        self.file.write_text("nonsense\n", encoding="utf-8")
        time.sleep(NOTICED_S)
        self.assertEqual(self.list_codes(self.tokens["wall"]), {Code.OK})

    def test_a_bad_file_stops_the_start(self):
        self.file.write_text("nonsense\n", encoding="utf-8")
        done = subprocess.run([viewloomd.PROGRAM, "--access.token_file", self.file,
                               "--grpc.address", "127.0.0.1:0", "--http.address", "127.0.0.1:0"],
                              capture_output=True, text=True, check=False,
                              timeout=viewloomd.PATIENCE_S)
        self.assertEqual(done.returncode, 2)
        self.assertIn("tokens.jsonl:1: is no JSON object", done.stderr)


if __name__ == "__main__":
    unittest.main()
