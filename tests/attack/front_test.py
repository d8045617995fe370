# SPDX-License-Identifier: Apache-2.0
"""The reference configurations of HAProxy and nginx, before a real server. Arguments: haproxy or
nginx, viewloomd. PYTHONPATH has the Python client and tests/web."""

import base64
import http.client
import json
import os
import ssl
import sys
import time
import unittest

import grpc
import numpy as np

import front
import message_floods
import viewloom
from healthy_pair import QUILT, source
from target import Server
from google.protobuf.json_format import ParseDict
from viewloom.frame_messages import frame_messages, settings_message
from viewloom.v1 import (catalog_service_pb2, catalog_service_pb2_grpc, display_service_pb2,
                         display_service_pb2_grpc, ingest_service_pb2_grpc)

KIND = sys.argv.pop(1)
PROGRAM = sys.argv.pop(1)
SILENCE_S = 7  # longer than the limits of requests
LARGE_PX = (2560, 3688)  # 66 MB: three bytes of colour and four of depth


class BehindAFront(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM, settings=front.SETTINGS).__enter__()
        cls.addClassCleanup(cls.server.__exit__)
        cls.front = front.Front(KIND, cls.server.address).__enter__()
        cls.addClassCleanup(cls.front.__exit__)
        cls.address = cls.front.address
        cls.direct = viewloom.connect(f"127.0.0.1:{cls.server.address.grpc_port}")
        cls.addClassCleanup(cls.direct.close)
        publisher = cls.direct.publish("scene")
        cls.addClassCleanup(publisher.close)
        publisher.send(source(1)).result(60)

    def fetch(self, path, host=front.HOST, method="GET", headers=None):
        context = ssl.create_default_context(cadata=self.address.certificate.decode())
        context.check_hostname = False
        connection = http.client.HTTPSConnection("127.0.0.1", self.address.http_port, timeout=30,
                                                 context=context)
        self.addCleanup(connection.close)
        connection.request(method, path, headers={"Host": host, **(headers or {})})
        return connection.getresponse()

    def test_serves_the_page_below_its_path(self):
        self.assertEqual(self.fetch("/viewloom").getheader("location"), "/viewloom/")
        page = self.fetch("/viewloom/")
        self.assertEqual(page.status, 200)
        self.assertIn(b'src="page.js"', page.read())
        self.assertEqual(self.fetch("/viewloom/page.js").status, 200)
        streams = json.loads(self.fetch("/viewloom/api/streams").read())["streams"]
        self.assertIn("scene", [stream["name"] for stream in streams])

    def test_redirects_of_stills_stay_below_it(self):
        reply = self.fetch("/viewloom/still/scene/portrait?width=84&height=112")
        self.assertEqual(reply.status, 302)
        self.assertEqual(reply.getheader("location").split("/")[:2], ["..", ".."])

    def test_opens_websockets_of_its_own_page_alone(self):
        key = base64.b64encode(os.urandom(16)).decode()
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Key": key,
                   "Sec-WebSocket-Version": "13"}
        path = "/viewloom/ws?stream=scene&width=84&height=112"
        for origin, status in ((f"https://{front.HOST}", 101), ("https://evil.example", 403)):
            reply = self.fetch(path, headers={**upgrade, "Origin": origin})
            self.assertEqual(reply.status, status, origin)

    def test_lets_the_page_sign_in_and_out(self):
        path = "/viewloom/api/session"
        for method, status in (("GET", 200), ("POST", 200), ("DELETE", 200),
                               ("PUT", {"haproxy": 405, "nginx": 403}[KIND])):
            with self.subTest(method=method):
                reply = self.fetch(path, method=method, headers={"Content-Length": "0"})
                self.assertEqual(reply.status, status)
        cookie = self.fetch(path, method="DELETE").getheader("set-cookie")
        self.assertIn("secure", cookie.lower())

    def test_refuses_other_names_paths_and_methods(self):
        for path, host, method, status in (
                ("/viewloom/", "evil.example", "GET", 421),
                ("/viewloom/", front.HOST, "POST", {"haproxy": 405, "nginx": 403}[KIND]),
                ("/", front.HOST, "GET", 404), ("/api/streams", front.HOST, "GET", 404),
                ("/viewloom/metrics", front.HOST, "GET", 404),
                ("/viewloom/%6detrics", front.HOST, "GET", 404),
                ("/viewloom/health%7A?a=b", front.HOST, "GET", 404),
                ("/viewloom/healthz", front.HOST, "GET", 404)):
            with self.subTest(path=path, host=host, method=method):
                self.assertEqual(self.fetch(path, host, method).status, status)

    def test_keeps_signed_links_out_of_its_log(self):
        reply = self.fetch("/viewloom/still/scene/portrait?link=1893456000.t.YQ.c2VjcmV0")
        self.assertEqual(reply.status, 400)
        self.assertNotIn("c2VjcmV0", self.front.logged())

    def test_carries_calls_and_large_frames(self):
        noise = np.random.default_rng(1).integers(0, 255, (*LARGE_PX, 3), np.uint8)
        large = viewloom.Source(noise, np.full(LARGE_PX, 2, np.float32), fov_y_rad=0.9)
        messages = [settings_message("large", ""),
                    *frame_messages(1, [large], capture_time_ns=1)]
        feed = message_floods.Feed(*messages)
        with self.address.channel() as channel:
            info = catalog_service_pb2_grpc.CatalogServiceStub(channel).GetServerInfo(
                catalog_service_pb2.GetServerInfoRequest(), timeout=30)
            self.assertTrue(info.version)
            call = ingest_service_pb2_grpc.IngestServiceStub(channel).PublishFrames(iter(feed))
            reports = (reply.report for reply in call if reply.WhichOneof("message") == "report")
            report = next(reports)
            self.assertEqual((report.number, report.reason), (1, ""))
            feed.close()

    def test_carries_a_viewer_through_a_long_silence(self):
        request = display_service_pb2.StreamAtlasesRequest()
        request.open.stream = "scene"
        ParseDict(QUILT, request.open.display)
        feed = message_floods.Feed(request)
        with self.address.channel() as channel:
            call = display_service_pb2_grpc.DisplayServiceStub(channel).StreamAtlases(iter(feed))
            kinds = (reply.WhichOneof("message") for reply in call)
            self.assertIn("end", kinds)
            time.sleep(SILENCE_S)
            change = display_service_pb2.StreamAtlasesRequest()
            ParseDict(QUILT, change.change.display)
            change.change.display.quilt.columns = 2
            feed.put(change)
            self.assertIn("end", kinds)
            feed.close()

    def test_refuses_compressed_messages(self):
        with self.address.channel() as channel:
            for compression in (grpc.Compression.Gzip, grpc.Compression.Deflate):
                request = display_service_pb2.StreamAtlasesRequest()
                request.open.stream = "0" * 100_000
                feed = message_floods.Feed(request)
                call = display_service_pb2_grpc.DisplayServiceStub(channel).StreamAtlases(
                    iter(feed), compression=compression, timeout=10)
                self.assertEqual(message_floods.found_in_refusal(call, compression), [])
                feed.close()


if __name__ == "__main__":
    if not front.program_of(KIND):
        print(f"skipped: there is no {KIND}; install it, or name it in VIEWLOOM_{KIND.upper()}")
        sys.exit(front.SKIPPED)
    unittest.main(verbosity=2)
