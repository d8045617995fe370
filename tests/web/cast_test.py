# SPDX-License-Identifier: Apache-2.0
"""`viewloom cast` between the web server and a Bridge that has no display.

Arguments: painted_server, viewloom."""
import io
import json
import math
import signal
import socket
import subprocess
import sys
import time
import unittest
from urllib.parse import parse_qsl, urlsplit

from PIL import Image

from fake_bridge import MONITOR, PORTRAIT, TOKEN, FakeBridge
from web_client import TIMEOUT_S, Server, decode_view

PROGRAM, CLIENT = sys.argv.pop(1), sys.argv.pop(1)
DONE, FAILED, USAGE, NO_SERVER = 0, 1, 2, 3


def free_port():
    """A port where nobody listens."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


class CastTest(unittest.TestCase):
    still_timeout_ms = 60_000

    def setUp(self):
        self.server = Server(PROGRAM, "--timeout-ms", self.still_timeout_ms)
        self.addCleanup(self.server.__exit__)
        self.bridge = FakeBridge()
        self.addCleanup(self.bridge.stop)

    def command(self, *options, stream="painted", bridge=None, address=None):
        bridge = self.bridge.url if bridge is None else bridge
        address = self.server.url if address is None else address
        return [CLIENT, "cast", stream, f"--bridge={bridge}", f"--address={address}",
                *map(str, options)]

    def cast(self, *options, **others):
        return subprocess.run(self.command(*options, **others), capture_output=True, text=True,
                              timeout=TIMEOUT_S, check=False)

    def check_refusal(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertEqual(self.bridge.shown, [])


class Casting(CastTest):
    def test_the_display_is_shown_the_quilt_that_it_wants(self):
        result = self.cast()
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertEqual(self.bridge.names(),
                         ["enter_orchestration", "available_output_devices", "show_window",
                          "instance_playlist", "insert_playlist_entry", "play_playlist",
                          "exit_orchestration"])
        self.assertTrue(all(arguments["orchestration"] == TOKEN
                            for _, arguments in self.bridge.calls[1:]))
        entry = self.bridge.calls[4][1]
        uri = entry["uri"]
        self.assertTrue(uri.startswith(self.server.url + "still/painted_qs8x6a0.75.jpg?"), uri)
        asked = dict(parse_qsl(urlsplit(uri).query))
        self.assertEqual({name: json.loads(message) for name, message in asked.items()}, {
            "display": {"quilt": {"columns": 8, "rows": 6, "aspect": 0.75,
                                  "size": {"width": 336, "height": 336}}},
            "encoding": {"jpeg_quality": 85}})
        self.assertEqual([entry[key] for key in ("uri", "rows", "cols", "aspect", "view_count",
                                                 "isRGBD")], [uri, 6, 8, 0.75, 48, 0])
        self.assertEqual(self.bridge.calls[5][1]["head_index"], PORTRAIT["index"])
        self.assertEqual(result.stdout, f"LKG-P02283 shows {uri}\n")
        image = Image.open(io.BytesIO(self.bridge.shown[0]))
        layout = {"columns": 8, "rows": 6, "padding_top_px": 0,
                  "tile_size": {"width": 42, "height": 56}}
        self.assertEqual([decode_view(image, layout, view) for view in range(48)],
                         list(range(48)))

    def test_a_preset_overrides_what_the_display_wants(self):
        result = self.cast("--preset", "portrait", "--cone", 35, "--timeout", 60)
        self.assertEqual(result.returncode, DONE, result.stderr)
        uri = dict(self.bridge.calls)["insert_playlist_entry"]["uri"]
        self.assertIn("/still/painted_qs8x6a0.75.jpg?", uri)
        quilt = json.loads(dict(parse_qsl(urlsplit(uri).query))["display"])["quilt"]
        self.assertEqual(quilt["preset"], "portrait")
        self.assertAlmostEqual(quilt["view_cone_rad"], math.radians(35))
        self.assertEqual(Image.open(io.BytesIO(self.bridge.shown[0])).size, (3360, 3360))

    def test_another_spelling_of_what_the_display_wants(self):
        quilt = {"quiltWidth": 300, "quiltHeight": 200, "columns": 3, "rows": 2,
                 "renderAspect": 1.77778, "tileCount": 6}
        self.bridge.displays = [{**PORTRAIT, "defaultQuilt": json.dumps(quilt)}]
        self.assertEqual(self.cast().returncode, DONE)
        self.assertEqual(Image.open(io.BytesIO(self.bridge.shown[0])).size, (300, 200))

    def test_motion_hands_over_the_stream(self):
        self.assertEqual(self.cast("--motion").returncode, DONE)
        uri = dict(self.bridge.calls)["insert_playlist_entry"]["uri"]
        self.assertIn("/stream/painted_qs8x6a0.75.mjpg?", uri)
        self.assertTrue(self.bridge.shown[0].startswith(b"--viewloom\r\nContent-Type: image/jpeg"))

    def test_stills_are_handed_over_again_by_turns_until_interrupted(self):
        process = subprocess.Popen(self.command("--every", 0.1), stdout=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        deadline = time.monotonic() + TIMEOUT_S
        while len(self.bridge.shown) < 5:
            self.assertLess(time.monotonic(), deadline)
            self.server.command("frame")
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(TIMEOUT_S), DONE)
        names = [arguments["name"] for endpoint, arguments in self.bridge.calls
                 if endpoint == "play_playlist"]
        self.assertEqual(names[:4], ["viewloom_a", "viewloom_b"] * 2)
        self.assertGreater(len(set(self.bridge.shown)), 1, "the still never changed")
        self.assertEqual(self.bridge.names()[-1], "exit_orchestration")
        self.assertEqual(self.bridge.names().count("enter_orchestration"), 1)

    def test_the_display_named_is_the_one_that_shows(self):
        self.bridge.displays = [PORTRAIT, {**PORTRAIT, "index": 2, "hwid": "LKG-E00001"}]
        result = self.cast("--head", 2)
        self.assertEqual(dict(self.bridge.calls)["play_playlist"]["head_index"], 2)
        self.assertIn("LKG-E00001 shows", result.stdout)


class Refusals(CastTest):
    still_timeout_ms = 1000

    def test_answers_that_no_bridge_gives(self):
        status = {"name": "x", "payload": {"value": "a"}, "status": {"value": "Failure"}}
        for endpoint in ("enter_orchestration", "available_output_devices", "show_window",
                         "instance_playlist", "insert_playlist_entry", "play_playlist"):
            for answer, words in ((b"", ("empty body", "update Looking Glass Bridge")),
                                  (b"<html>\r\n", ("<html>", "check that --bridge")),
                                  (b"[]", ("[]", "check that --bridge")),
                                  (b"{}", ("instead of Completion", "start Bridge again")),
                                  (json.dumps(status).encode(), ("Failure", "Completion")),
                                  ((404, b"gone"), ("HTTP status 404", "check that --bridge"))):
                with self.subTest(endpoint, answer=answer):
                    self.bridge.calls.clear()
                    self.bridge.answers = {endpoint: answer}
                    self.check_refusal(self.cast(), FAILED, endpoint, *words)
                    entered = endpoint != "enter_orchestration"
                    self.assertEqual("exit_orchestration" in self.bridge.names(), entered)

    def test_a_bridge_that_hangs(self):
        for endpoint in ("enter_orchestration", "insert_playlist_entry"):
            with self.subTest(endpoint):
                self.bridge.answers = {endpoint: None}
                self.check_refusal(self.cast("--timeout", 0.5), FAILED, endpoint,
                                   "no answer within 500 ms", "--timeout")

    def test_a_bridge_that_speaks_no_http(self):
        with socket.create_server(("127.0.0.1", 0)) as listener:
            listener.settimeout(TIMEOUT_S)
            command = self.command(bridge=f"http://127.0.0.1:{listener.getsockname()[1]}")
            process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
            peer, _ = listener.accept()
            with peer:
                peer.recv(4096)
                peer.sendall(b"\x16\x03\x01 hello\r\n\r\n")
                _, error = process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(process.returncode, FAILED)
        self.assertIn("answered no HTTP", error)

    def test_options_of_tls_want_https(self):
        self.check_refusal(self.cast("--fingerprint", 32 * "00"), USAGE, "--fingerprint is given",
                           "write it as https://HOST:PORT")

    def test_nobody_there(self):
        nobody = f"http://127.0.0.1:{free_port()}"
        self.check_refusal(self.cast(bridge=nobody), NO_SERVER, "no Bridge at " + nobody,
                           "start Looking Glass Bridge", "--bridge http://HOST:PORT")
        self.check_refusal(self.cast(address=nobody), NO_SERVER,
                           "no page of viewloomd at " + nobody, "viewloomd serve", "--address")

    def test_no_light_field_display(self):
        for displays in ((), (MONITOR,)):
            self.bridge.displays = displays
            self.check_refusal(self.cast(), FAILED, "no light-field display", "connect its USB")

    def test_a_display_that_does_not_say_what_it_wants(self):
        for quilt in ("", "{", "[]", '{"tileX": 8}',
                      json.dumps({"quiltX": 1e99, "quiltY": 9, "tileX": 8, "tileY": 6,
                                  "quiltAspect": 1}),
                      json.dumps({"quiltX": -5, "quiltY": "9", "tileX": 8, "tileY": 6,
                                  "quiltAspect": None})):
            with self.subTest(quilt):
                self.bridge.displays = [{**PORTRAIT, "defaultQuilt": quilt}]
                self.check_refusal(self.cast(), FAILED, "LKG-P02283", "--preset")

    def test_a_display_that_is_not_there(self):
        self.check_refusal(self.cast("--head", 7), USAGE, "--head 7", "It has 1 (LKG-P02283)")

    def test_a_token_or_a_list_of_another_kind(self):
        envelope = {"name": "x", "status": {"value": "Completion"}}
        for endpoint, value, words in (("enter_orchestration", 17, "without a token"),
                                       ("enter_orchestration", "", "without a token"),
                                       ("available_output_devices", 5, "no light-field display"),
                                       ("available_output_devices", [None, {"value": 3}],
                                        "no light-field display")):
            with self.subTest(endpoint, value=value):
                answer = json.dumps({**envelope, "payload": {"value": value}}).encode()
                self.bridge.answers = {endpoint: answer}
                self.check_refusal(self.cast(), FAILED, words)

    def test_what_the_server_does_not_have(self):
        self.check_refusal(self.cast(stream="none"), FAILED, 'there is no stream "none"')
        self.check_refusal(self.cast("--preset", "none"), FAILED, "none")
        self.check_refusal(self.cast(stream="silent"), FAILED, "was ready within 1000 ms")
        self.check_refusal(self.cast(stream="a b"), USAGE, "stream", "letters")
        self.check_refusal(self.cast("--preset", "a/b"), FAILED, 'there is no preset "a/b"')

    def test_a_page_that_is_none(self):
        self.check_refusal(self.cast(address=self.bridge.url), FAILED, self.bridge.url,
                           "--address names the page of a viewloomd")

    def test_addresses_that_are_none(self):
        for address in ("localhost", "http://", "http://a b", "http://a:0", "http://a:99999",
                        "http://a:b", "http://a/b", "http://[::1", "http://[g]/", "http://u@a"):
            with self.subTest(address):
                for option in ("bridge", "address"):
                    self.check_refusal(self.cast(**{option: address}), USAGE, "--" + option,
                                       "accepted is http://HOST")
        self.check_refusal(self.cast(bridge="https://localhost"), USAGE, "--bridge",
                           "accepted is http://HOST")

    def test_an_address_that_the_bridge_cannot_reach(self):
        self.check_refusal(self.cast(bridge="http://192.0.2.7"), USAGE, "192.0.2.7",
                           "--http.address")


if __name__ == "__main__":
    unittest.main()
