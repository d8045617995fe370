# SPDX-License-Identifier: Apache-2.0
"""The viewer page in a real browser: what it shows is compared with what was painted.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import os
import signal
import sys
import time
import unittest

from browser import CHROMIUM, Browser
from page_checks import LOW_CONTRASTS
from web_client import Server, asked, decode_code, quilt

SMALL = "?" + asked(quilt(8, 6, 1680, 1680, aspect=0.75))
GROUND = (10, 12, 16)
LIVE = "document.documentElement.dataset.state === 'live'"


def keep(image, name):
    if (folder := os.environ.get("VIEWLOOM_SCREENSHOTS")):
        image.save(os.path.join(folder, name + ".png"))


def picture_box(image):
    """Where the canvas's picture stands: everything in it that is not the page's ground."""
    points = [(x, y) for x in range(0, image.width, 2) for y in range(0, image.height, 2)
              if max(abs(a - b) for a, b in zip(image.getpixel((x, y)), GROUND)) > 12]
    xs, ys = zip(*points)
    return min(xs), min(ys), max(xs) + 1, max(ys) + 1


# Opens all that is folded away at first.
UNFOLD = "document.querySelectorAll('details').forEach(part => { part.open = true; })"


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class PageTest(unittest.TestCase):
    """A browser in front of self.server."""
    view_count = 48

    def start_browser(self):
        self.browser = Browser()
        self.addCleanup(self.browser.close)
        self.browser.reduce_motion()  # no sway, and the eye goes where it is put at once

    def open(self, query=SMALL):
        self.browser.open(self.server.url + query)
        self.browser.wait_for(LIVE)
        self.browser.evaluate(UNFOLD)

    def fill(self, name, value):
        """Gives a field its value, as a visitor does."""
        self.browser.evaluate(
            f"(s => {{ s.value = {value!r}; s.dispatchEvent(new Event('change')); }})"
            f"(document.getElementById('{name}'))")

    def canvas(self):
        left, top, width, height = self.browser.evaluate(
            "(r => [r.x, r.y, r.width, r.height])"
            "(document.getElementById('stage').getBoundingClientRect())")
        return left, top, width, height

    def shown_picture(self):
        scale = self.browser.evaluate("devicePixelRatio")  # screenshots are in px of the device
        left, top, width, height = (scale * side for side in self.canvas())
        edge = 4 * scale  # where the focus ring is
        shot = self.browser.screenshot().crop(
            (left + edge, top + edge, left + width - edge, top + height - edge))
        return shot.crop(picture_box(shot))

    def look(self, share):
        left, top, width, height = self.canvas()
        self.browser.mouse(left + share * width, top + height / 2)
        view = round(share * (self.view_count - 1))
        self.browser.wait_for(f"document.getElementById('stage').dataset.view === '{view}'")
        return view


class Page(PageTest):
    def setUp(self):
        self.server = Server(PROGRAM, "--rate-hz", 5)
        self.addCleanup(lambda: self.server.__exit__())
        self.start_browser()

    def test_shows_the_view_under_the_pointer(self):
        self.open()
        for share in (0.02, 0.3, 0.5, 0.77, 0.98):
            view = self.look(share)
            picture = self.shown_picture()
            self.assertEqual(decode_code(picture), view)
            self.assertAlmostEqual(picture.width / picture.height, 0.75, delta=0.01)
        keep(self.browser.screenshot(), "painted")

    def test_arrow_keys_and_the_slider_look_around(self):
        self.open()
        self.look(0.5)
        self.browser.evaluate("document.getElementById('stage').focus()")
        self.browser.key("Home")
        self.browser.wait_for("document.getElementById('stage').dataset.view === '0'")
        self.browser.key("ArrowRight")
        self.browser.wait_for("document.getElementById('stage').dataset.view === '1'")
        self.assertEqual(decode_code(self.shown_picture()), 1)
        self.browser.evaluate("(v => { v.value = 1; v.dispatchEvent(new Event('input')); })"
                              "(document.getElementById('view'))")
        self.browser.wait_for("document.getElementById('stage').dataset.view === '47'")

    def test_a_finger_drags_the_scene(self):
        self.browser.resize(390, 844, scale=2, mobile=True)
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        self.open()
        left, top, width, height = self.canvas()
        middle = (left + width / 2, top + height / 2)
        self.browser.touch("touchStart", middle)
        self.browser.touch("touchMove", (middle[0] - width / 4, middle[1]))
        self.browser.touch("touchEnd")
        self.browser.wait_for("document.getElementById('stage').dataset.view === '35'")
        keep(self.browser.screenshot(), "phone")

    def test_shows_the_whole_quilt_and_its_figures(self):
        self.open()
        self.browser.key("q")
        self.browser.wait_for("document.getElementById('panel').innerText.includes('8 × 6 = 48')")
        picture = self.shown_picture()
        self.assertAlmostEqual(picture.width / picture.height, 1, delta=0.01)
        tile_width, tile_height = picture.width / 8, picture.height / 6
        for view in (0, 7, 40, 47):
            left, top = view % 8 * tile_width, (5 - view // 8) * tile_height
            tile = picture.crop((left, top, left + tile_width, top + tile_height))
            self.assertEqual(decode_code(tile), view)
        self.browser.wait_for("Number(document.getElementById('rate').textContent) > 0.5")
        panel = self.browser.evaluate("document.getElementById('panel').innerText")
        for words in ("70.0", "90.0", "8 × 6 = 48", "1680 × 1680 px"):
            self.assertIn(words, panel)
        keep(self.browser.screenshot(), "quilt")

    def test_focus_goes_to_the_server_and_back(self):
        self.open()
        self.browser.wait_for("document.getElementById('focus-value').textContent === '2.00 m'")
        self.browser.evaluate("(f => { f.value = 1; f.dispatchEvent(new Event('input')); })"
                              "(document.getElementById('focus'))")
        self.browser.wait_for("fetch('/api/displays').then(r => r.json()).then("
                              "j => j.displays[0].layout?.focal_distance_m === 4)")

    def test_takes_less_detail_from_a_server_that_is_slow(self):
        self.server.__exit__()
        # A quarter, 840 x 840 px, would take 350 ms; an eighth takes 88 ms and what painting takes.
        self.server = Server(PROGRAM, "--rate-hz", 30, "--ms-per-megapixel", 500)
        self.open("?stream=painted&mode=quilt")
        self.browser.wait_for(
            "document.getElementById('panel').innerText.includes('420 × 420 px')")

    def test_takes_the_detail_that_the_address_names_and_automatic_for_one_unknown(self):
        for detail, quilt in (("0.125", "420 × 420 px"), ("0.3", "840 × 840 px")):
            self.open(f"?stream=painted&mode=quilt&detail={detail}")
            self.browser.wait_for(
                f"document.getElementById('panel').innerText.includes('{quilt}')")

    def test_comes_back_after_a_restart_of_the_server(self):
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""
            window.delays = [];
            window.tries = 0;
            const Real = WebSocket;
            window.WebSocket = class extends Real { constructor(url) { super(url); ++tries; } };
            const wait = setTimeout;
            window.setTimeout = (action, time_ms) => { delays.push(time_ms);
                                                       return wait(action, time_ms); };""")
        self.open()
        view = self.look(0.25)
        port = self.server.port
        self.assertEqual(self.server.stop(), 0)
        self.browser.wait_for("document.documentElement.dataset.state === 'reconnecting'")
        self.browser.wait_for(
            "document.getElementById('notice').textContent.includes('Trying again')")
        keep(self.browser.screenshot(), "reconnecting")
        # However long the server is away, the next try is never far.
        self.browser.evaluate("delays.length = tries = 0")
        self.browser.wait_for("tries > 5")
        self.assertLessEqual(self.browser.evaluate("Math.max(...delays)"), 1000)
        self.server = Server(PROGRAM, "--rate-hz", 5, "--port", port)
        self.browser.wait_for(LIVE)
        # The first picture of a connection shows the middle; the eye stays where it was.
        deadline = time.monotonic() + 10
        while decode_code(self.shown_picture()) != view and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertEqual(decode_code(self.shown_picture()), view)
        view = self.look(0.75)
        self.assertEqual(decode_code(self.shown_picture()), view)

    def test_notices_a_connection_that_is_dead_and_keeps_a_quiet_one(self):
        self.server.__exit__()
        self.server = Server(PROGRAM)  # its picture stands
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""
            const real = performance.now.bind(performance);
            window.later_ms = 0;
            performance.now = () => real() + later_ms;""")
        self.open()
        for _ in range(3):
            self.browser.evaluate("later_ms += 9000")
            time.sleep(1.5)  # for the page to ask, and the server to answer
            self.assertTrue(self.browser.evaluate(LIVE))
        self.server.process.send_signal(signal.SIGSTOP)
        self.browser.evaluate("later_ms += 11000")
        self.browser.wait_for("document.documentElement.dataset.state === 'reconnecting'")
        self.server.process.send_signal(signal.SIGCONT)
        self.browser.wait_for(LIVE)

    def test_labels_reduced_detail_and_nothing_else(self):
        label = "document.getElementById('reduced')"
        self.open("?stream=painted&mode=quilt&detail=0.25")
        self.browser.wait_for(f"{label}.textContent === 'Reduced detail, as chosen: "
                              "105 of 420 px wide' && !{0}.hidden".replace("{0}", label))
        keep(self.browser.screenshot(), "reduced")
        self.open("?" + asked(quilt(8, 6, 640, 480), mode="quilt"))
        self.assertTrue(self.browser.evaluate(f"{label}.hidden"))

    def test_says_how_to_start_a_stream_when_there_is_none(self):
        self.browser.open(self.server.url + "icon.svg")  # the page's origin, before the page
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source=(
            "const real = fetch; window.fetch = (url, ...more) => url === 'api/streams' ? "
            "Promise.resolve(new Response('{\"streams\": []}')) : real(url, ...more);"))
        self.browser.open(self.server.url)
        self.browser.wait_for("document.documentElement.dataset.state === 'no-stream'")
        self.assertIn("viewloom publish --synthetic",
                      self.browser.evaluate("document.getElementById('welcome').innerText"))
        for scheme in ("dark", "light"):
            self.browser.call("Emulation.setEmulatedMedia",
                              features=[{"name": "prefers-color-scheme", "value": scheme}])
            self.assertEqual(self.browser.evaluate(LOW_CONTRASTS), [], scheme)
            keep(self.browser.screenshot(), f"no-stream-{scheme}")

    def test_runs_without_an_error_on_its_console(self):
        self.open()
        self.look(0.5)
        self.browser.wait_for("Number(document.documentElement.dataset.sequence) > 3")
        self.assertEqual(self.browser.messages, [])


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
