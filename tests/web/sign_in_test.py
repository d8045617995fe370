# SPDX-License-Identifier: Apache-2.0
"""Access tokens on the web port: headers, cookies, WebSockets, links, and the page's form."""
import hashlib
import json
import os
import re
import secrets
import sys
import tempfile
import time
import unittest
from urllib.parse import quote

from browser import CHROMIUM, Browser
from web_client import Server, Stream, WebSocket, asked, fetch, request_bytes

PROGRAM = sys.argv.pop(1)
LIVE = "document.documentElement.dataset.state === 'live'"
ASKS = "!document.getElementById('sign-in').hidden"


class Tokens:
    """A token file."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "tokens.jsonl")
        self.lines = {}
        self._write()

    def add(self, name, roles, streams):
        token = "viewloom_" + secrets.token_urlsafe(32)
        self.lines[name] = json.dumps({"id": name, "roles": roles, "streams": streams,
                                       "sha256": hashlib.sha256(token.encode()).hexdigest()})
        self._write()
        return token

    def revoke(self, name):
        del self.lines[name]
        self._write()

    def _write(self):
        with open(self.path + ".new", "w", encoding="utf-8") as file:
            file.writelines(line + "\n" for line in self.lines.values())
        os.replace(self.path + ".new", self.path)


class TokenCase(unittest.TestCase):
    """A painted server that asks for tokens; self.watch may see the stream "painted"."""

    def setUp(self):
        self.tokens = Tokens()
        self.addCleanup(self.tokens.folder.cleanup)
        self.watch = self.tokens.add("watch", ["watch"], ["painted"])
        self.operate = self.tokens.add("operate", ["operate"], ["*"])
        os.environ["PAINTED_TOKEN_FILE"] = self.tokens.path
        self.server = Server(PROGRAM, "--timeout-ms", 3000)
        self.addCleanup(self.server.__exit__)


class SignInTest(TokenCase):
    def ask(self, target, token=None, method="GET", **headers):
        if token:
            headers["Authorization"] = f"Bearer {token}"
        if method == "POST":
            headers["Content-Length"] = "0"
        return fetch(self.server.port, target, method, headers)

    def status(self, *arguments, **headers):
        return self.ask(*arguments, **headers).status

    def test_only_health_and_the_page_are_open(self):
        for target in ("/", "/page.js", "/healthz"):
            self.assertEqual(self.status(target), 200, target)
        for target in ("/api/streams", "/api/displays", "/api/presets", "/api/fields", "/metrics",
                       "/api/session", "/api/link?target=/still/painted/portrait",
                       "/api/qr?target=/still/painted/portrait",
                       "/still/painted/portrait", "/stream/painted/portrait",
                       "/ws?stream=painted", "/api/streams?token=" + self.watch):
            reply = self.ask(target)
            self.assertEqual(reply.status, 401, target)
            self.assertEqual(reply.headers["www-authenticate"], "Bearer")
            self.assertEqual(reply.json()["error"]["code"], "UNAUTHENTICATED")

    def test_a_token_gives_its_role_and_its_streams(self):
        streams = self.ask("/api/streams", self.watch).json()["streams"]
        self.assertEqual([entry["name"] for entry in streams], ["painted"])
        self.assertEqual(self.status("/metrics", self.watch), 403)
        self.assertEqual(self.status("/metrics", self.operate), 200)
        self.assertEqual(self.status("/still/painted/portrait", self.operate), 403)
        for stream in ("silent", "unknown"):
            self.assertEqual(self.status(f"/still/{stream}/portrait", self.watch), 403, stream)

    def test_a_wrong_token_is_not_quoted(self):
        wrong = "viewloom_" + secrets.token_urlsafe(32)
        reply = self.ask("/api/streams", wrong)
        self.assertEqual(reply.status, 401)
        self.assertNotIn(wrong.encode(), reply.body)

    def test_a_cookie_is_as_good_until_the_token_is_revoked(self):
        reply = self.ask("/api/session", self.watch, "POST")
        self.assertEqual(reply.status, 200)
        self.assertIn("HttpOnly; SameSite=Strict", reply.headers["set-cookie"])
        cookie = reply.headers["set-cookie"].split(";")[0]
        self.assertEqual(self.status("/api/streams", Cookie=cookie), 200)
        self.tokens.revoke("watch")
        time.sleep(1.5)
        self.assertEqual(self.status("/api/streams", Cookie=cookie), 401)

    def test_another_site_signs_nobody_in(self):
        self.assertEqual(
            self.status("/api/session", self.watch, "POST", Origin="http://evil.example"), 403)
        self.assertEqual(self.status("/api/streams", self.watch, "POST"), 405)

    def test_a_link_shows_one_picture_for_a_while(self):
        target = quote("/still/painted/portrait?width=800&height=600")
        link = self.ask(f"/api/link?target={target}&seconds=60", self.watch).json()["url"]
        reply = self.ask(link)
        self.assertEqual((reply.status, reply.headers["content-type"]), (200, "image/jpeg"))
        self.assertEqual(self.status(link.replace("height=600", "height=601")), 401)
        self.assertIn(self.status(link[:-4] + "AAAA"), (400, 401))
        self.tokens.revoke("watch")
        time.sleep(1.5)
        self.assertEqual(self.status(link), 401)

    def link_to_player(self, seconds, extension):
        target = quote(f"/stream/painted_qs4x2a1.{extension}?width=320&height=160")
        return self.ask(f"/api/link?target={target}&seconds={seconds}", self.watch).json()["url"]

    def play_by_link(self, seconds, extension="mjpg"):
        link = self.link_to_player(seconds, extension)
        stream = Stream(self.server.port)
        self.addCleanup(stream.close)
        stream.send(request_bytes(self.server.port, link))
        self.assertEqual(stream.read_reply().status, 200)
        return stream

    def test_a_player_ends_with_its_link(self):
        # The picture stands: nothing is sent that would end it sooner.
        self.assertTrue(self.play_by_link(2).file.read().endswith(b"\r\n--viewloom--\r\n"))

    def test_a_player_ends_with_the_token_of_its_link(self):
        stream = self.play_by_link(3600)
        self.tokens.revoke("watch")
        self.assertTrue(stream.file.read().endswith(b"\r\n--viewloom--\r\n"))

    def test_a_video_ends_with_its_link(self):
        self.assertEqual(self.play_by_link(2, "mp4").file.read()[4:8], b"ftyp")

    def test_a_link_to_motion_jpeg_opens_no_video(self):
        link = self.link_to_player(60, "mjpg")
        self.assertEqual(self.status(link, method="HEAD"), 200)
        self.assertEqual(self.status(link.replace(".mjpg", ".mp4"), method="HEAD"), 401)
        self.assertEqual(self.status(self.link_to_player(60, "mp4"), method="HEAD"), 200)

    def test_a_code_leads_to_this_server_only(self):
        target = quote("/stream/painted/portrait?width=800&height=600")
        ask = f"/api/qr?seconds=60&target={target}"
        host = f"127.0.0.1:{self.server.port}"
        self.assertEqual(self.status(ask), 401)
        self.assertEqual(self.status(ask, self.operate), 403)
        for page in ("", f"http://{host}/", f"https://{host}/below/"):
            reply = self.ask(ask + (f"&page={quote(page, '')}" if page else ""), self.watch)
            self.assertEqual((reply.status, reply.headers["content-type"]), (200, "image/svg+xml"))
            begin = page or f"http://{host}/"
            link = re.search(r"<title>(.*)</title>", reply.body.decode()).group(1)
            link = link.replace("&amp;", "&")
            self.assertTrue(link.startswith(f"{begin}stream/painted_qs8x6"), link)
            path = "/" + link.removeprefix(begin)
            self.assertEqual(self.status(path, method="HEAD"), 200)
            self.assertIn(self.status(path[:-4] + "AAAA", method="HEAD"), (400, 401))
        for page in ("http://evil.example/", f"http://{host}.evil.example/", f"http://{host}",
                     f"http://{host}/a?b/", f"javascript://{host}/"):
            reply = self.ask(f"{ask}&page={quote(page, '')}", self.watch)
            self.assertEqual(reply.status, 400, page)
            self.assertEqual(reply.json()["error"]["field"], "page")
        display = quote('{"quilt": {"preset": "portrait"}}' + " " * 3000)
        reply = self.ask(f"/api/qr?target={quote('/stream/painted.mjpg?display=' + display)}",
                         self.watch)
        self.assertIn(reply.status, (400, 431))

    def upgrade(self, *protocols):
        socket = WebSocket(self.server.port,
                           "/ws?" + asked(preset="portrait", width=160, height=120),
                           {"Sec-WebSocket-Protocol": ", ".join(protocols)})
        socket.stream.close()
        return socket.reply

    def test_a_websocket_offers_its_token_as_a_protocol(self):
        reply = self.upgrade("viewloom", "bearer." + self.watch)
        self.assertEqual((reply.status, reply.headers["sec-websocket-protocol"]),
                         (101, "viewloom"))
        self.assertEqual(self.upgrade("viewloom", "bearer." + self.operate).status, 403)
        self.assertEqual(self.upgrade("viewloom").status, 401)


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class PageTest(TokenCase):
    def setUp(self):
        super().setUp()
        self.browser = Browser()
        self.addCleanup(self.browser.close)

    def test_the_page_asks_for_a_token(self):
        self.browser.open(self.server.url + "?preset=portrait&width=800&height=600")
        self.browser.wait_for(ASKS)
        self.enter("viewloom_wrong")
        self.browser.wait_for("document.getElementById('sign-in-problem').textContent !== ''")
        self.enter(self.watch)
        self.browser.wait_for(LIVE)
        self.assertEqual(self.browser.evaluate("document.cookie"), "")  # scripts cannot read it
        self.browser.open(self.server.url)
        self.browser.wait_for(LIVE)
        self.browser.evaluate("document.getElementById('sign-out').click()")
        self.browser.wait_for(ASKS)

    def test_a_link_with_a_token_signs_in(self):
        self.browser.open(self.server.url + "#token=" + self.watch)
        self.browser.wait_for(LIVE)
        self.assertEqual(self.browser.evaluate("location.hash"), "")

    def test_share_shows_a_link_that_needs_no_token(self):
        self.browser.open(self.server.url + "?preset=portrait&width=800&height=600#token=" +
                          self.watch)
        self.browser.wait_for(LIVE)
        self.browser.evaluate("document.getElementById('share').click()")
        self.browser.wait_for("!document.getElementById('shared').hidden && "
                              "document.getElementById('shared-code').naturalWidth > 0")
        link = self.browser.evaluate("document.getElementById('shared-link').value")
        self.assertTrue(link.startswith(self.server.url + "stream/painted_qs8x6"), link)
        path = "/" + link.removeprefix(self.server.url)
        self.assertEqual(fetch(self.server.port, path, "HEAD", {}).status, 200)
        self.assertEqual(fetch(self.server.port, path.split("&link=")[0], "HEAD", {}).status, 401)
        self.browser.evaluate("document.getElementById('shared-close').click()")
        self.assertEqual(
            self.browser.evaluate("document.getElementById('shared-link').value"), "")

    def enter(self, token):
        self.browser.evaluate(f"document.getElementById('token').value = {json.dumps(token)};"
                              "document.getElementById('sign-in-form').requestSubmit()")


if __name__ == "__main__":
    unittest.main()
