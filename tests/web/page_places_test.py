# SPDX-License-Identifier: Apache-2.0
"""The page in other places than the root of its own server: below a path of a reverse proxy, and in
a frame of another server's page."""
import http.server
import sys
import threading
import time
import unittest

from page_test import LIVE, PageTest, SMALL
from reverse_proxy import ReverseProxy
from web_client import Server, decode_code, fetch

PREFIX = "/light/field"
WAIT_S = 30


class FramePage(http.server.ThreadingHTTPServer):
    """A page of another server that shows the viewer page in a frame."""

    def __init__(self):
        super().__init__(("127.0.0.1", 0), FrameAnswer)
        self.html = ""
        threading.Thread(target=self.serve_forever, daemon=True).start()

    @property
    def origin(self):
        return f"http://127.0.0.1:{self.server_address[1]}"

    def stop(self):
        self.shutdown()
        self.server_close()


class FrameAnswer(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        body = self.server.html.encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


class PagePlaces(PageTest):
    def start(self, *options):
        self.server = Server(PROGRAM, "--rate-hz", 5, *options)
        self.addCleanup(lambda: self.server.__exit__())
        self.start_browser()

    def test_below_a_path_of_a_proxy_all_of_it_works(self):
        self.start()
        proxy = ReverseProxy(self.server.port, PREFIX)
        self.addCleanup(proxy.stop)
        self.browser.open(proxy.url + SMALL)
        self.browser.wait_for(LIVE)
        view = self.look(0.25)
        self.assertEqual(decode_code(self.shown_picture()), view)
        self.browser.key("5")  # fetches the shaders
        self.browser.wait_for("document.getElementById('woven').width > 300")
        self.browser.wait_for("document.getElementById('command-still').value"
                              f".includes('{PREFIX}/still/painted')")
        still = self.browser.evaluate("document.getElementById('command-still').value")
        self.assertIn(proxy.url, still)
        self.browser.click("#share")
        self.browser.wait_for("document.getElementById('shared-link').value"
                              f".startsWith('{proxy.url}stream/painted')")
        self.assertEqual([target for target in proxy.targets
                          if not target.startswith(PREFIX + "/")], [])
        self.assertEqual(self.browser.messages + self.browser.errors, [])

    def test_behind_a_proxy_the_page_comes_back_with_the_server(self):
        self.start()
        proxy = ReverseProxy(self.server.port, PREFIX)
        self.addCleanup(proxy.stop)
        self.browser.open(proxy.url + SMALL)
        self.browser.wait_for(LIVE)
        self.assertEqual(self.server.stop(), 0)
        self.browser.wait_for("document.documentElement.dataset.state === 'reconnecting'")
        self.server = Server(PROGRAM, "--rate-hz", 5, "--port", proxy.port_behind)
        self.browser.wait_for(LIVE)

    def viewer_count(self):
        displays = fetch(self.server.port, "/api/displays").json()["displays"]
        return sum(display["subscriber_count"] for display in displays)

    def show_in_a_frame(self, frame_page):
        frame_page.html = f'<iframe src="{self.server.url}{SMALL}" width="800" height="600">'
        self.browser.open(frame_page.origin + "/")
        self.browser.wait_for("document.readyState === 'complete'")

    def test_a_page_of_an_allowed_origin_may_show_it_in_a_frame(self):
        frame_page = FramePage()
        self.addCleanup(frame_page.stop)
        self.start("--allow-origin", frame_page.origin)
        policy = fetch(self.server.port, "/").headers["content-security-policy"]
        self.assertTrue(policy.endswith(f"frame-ancestors {frame_page.origin}"), policy)
        self.show_in_a_frame(frame_page)
        deadline = time.monotonic() + WAIT_S
        while self.viewer_count() == 0 and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertEqual(self.viewer_count(), 1)
        self.assertEqual(self.browser.errors, [])

    def test_no_other_page_may(self):
        frame_page = FramePage()
        self.addCleanup(frame_page.stop)
        self.start()
        policy = fetch(self.server.port, "/").headers["content-security-policy"]
        self.assertTrue(policy.endswith("frame-ancestors 'none'"), policy)
        self.show_in_a_frame(frame_page)
        time.sleep(2)
        self.assertEqual(self.viewer_count(), 0)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["PagePlaces"])])
