# SPDX-License-Identifier: Apache-2.0
"""The few views around the eye that the page asks for: how many, how large, and how often.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import math
import re
import sys
import threading
import time
import unittest

from page_test import PageTest, keep
from web_client import Server, decode_code

PORTRAIT = "?stream=painted&preset=portrait"
LABEL = "document.getElementById('reduced')"
LAYOUT = ("fetch('/api/displays').then(r => r.json()).then("
          "r => r.displays.length === 1 && r.displays[0].layout)")
# Changes that were sent and not answered by an atlas: the most at once.
COUNT_CHANGES = """
window.changes = {sent: 0, answered: 0, most: 0};
const Real = WebSocket;
window.WebSocket = class extends Real {
  send(text) {
    if (text.startsWith('{"change"')) changes.sent++;
    changes.most = Math.max(changes.most, changes.sent - changes.answered);
    super.send(text);
  }
};
const parse = JSON.parse;
JSON.parse = (text) => {
  const value = parse(text);
  if (value?.layout) changes.answered = value.change_count;
  return value;
};"""


# An eye that goes fast and stops just before what lies ahead has come; then the first view asked
# for, and how many.
STOPPED = """
(async () => {
  const {EyeViews} = await import('/eye_views.js');
  const where = 30;
  const look = (ms) => views.look(where, ms);
  const views = new EyeViews(() => {}, () => look(performance.now()));
  views.spread(48, 5);
  const begin_ms = performance.now();
  views.look(10, begin_ms - 100);
  look(begin_ms);
  views.noteAsked(begin_ms);
  views.noteAnswered(begin_ms + 1);
  look(begin_ms + 1);
  const ahead = views.first;
  await new Promise(resolve => setTimeout(resolve, 1000));
  return [ahead, views.first, views.count];
})()"""


class EyeViewsTest(PageTest):
    def serve(self, *options):
        self.server = Server(PROGRAM, *options)
        self.addCleanup(self.server.__exit__)
        self.start_browser()

    def layout(self):
        return self.browser.wait_for(LAYOUT)

    def test_looking_around_asks_for_a_few_views_as_large_as_the_screen_shows_them(self):
        self.serve()
        for size, scale in (((1280, 800), 1), ((390, 844), 2)):
            self.browser.resize(*size, scale=scale)
            self.open(PORTRAIT)
            for share in (0.0, 0.3, 0.99):
                view = self.look(share)
                self.assertEqual(decode_code(self.shown_picture()), view)
            self.browser.wait_for(f"{LABEL}.hidden")  # what stands becomes sharp
            layout = self.layout()
            self.assertIn(layout["view_count"], range(1, 6))
            shown = scale * min(size[0], 0.75 * self.canvas()[3]) * 0.95
            self.assertGreaterEqual(layout["tile_size"]["width"], int(shown) - 2)
            self.assertLess(layout["tile_size"]["width"], 1.1 * shown + 32)

    def test_a_single_view_is_asked_for_alone(self):
        self.serve()
        self.open(PORTRAIT + "&mode=single")
        self.browser.click("#single-on")
        self.browser.wait_for("document.getElementById('stage').dataset.view === '25'")
        self.assertEqual(decode_code(self.shown_picture()), 25)
        layout = self.layout()
        self.assertEqual((layout["view_count"], layout["columns"]), (1, 1))
        self.assertAlmostEqual(layout["cone_begin"], 25 / 48)

    def test_other_modes_ask_for_all_views_and_depth_for_the_middle_one(self):
        self.serve()
        for mode, count in (("quilt", 48), ("eye", 48), ("rgbd", 1), ("look", 5)):
            self.open(f"{PORTRAIT}&detail=0.125&mode={mode}")
            self.browser.wait_for(f"{LAYOUT}.then(layout => layout.view_count === {count})")
        self.browser.key("q")
        self.browser.wait_for(f"{LAYOUT}.then(layout => layout.view_count === 48)")
        self.browser.key("q")
        self.browser.wait_for(f"{LAYOUT}.then(layout => layout.view_count === 5)")

    def test_a_fast_pointer_asks_for_one_change_at_a_time_and_arrives(self):
        self.serve("--ms-per-megapixel", 50)
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source=COUNT_CHANGES)
        self.open(PORTRAIT + "&detail=1")
        left, top, width, height = self.canvas()
        for step in range(60):
            share = 0.5 + 0.45 * math.sin(step / 3)
            self.browser.mouse(left + share * width, top + height / 2)
        self.look(0.9)
        changes = self.browser.evaluate("changes")
        self.assertEqual(changes["most"], 1)
        self.assertGreater(changes["sent"], 2)
        self.assertLess(changes["sent"], 60)
        self.assertEqual(len(self.browser.evaluate(
            "fetch('/api/displays').then(r => r.json()).then(r => r.displays)")), 1)

    def test_an_eye_that_stops_gets_the_views_around_it(self):
        self.serve()
        self.open(PORTRAIT)
        ahead, first, count = self.browser.evaluate(STOPPED)
        self.assertGreater(ahead, 30)
        self.assertIn(30, range(first, first + count))

    def test_views_on_a_slow_server_are_never_too_narrow_and_sharp_once_they_stand(self):
        self.serve("--ms-per-megapixel", 1500)
        is_moving = threading.Event()
        is_moving.set()

        def publish():
            while is_moving.is_set():
                self.server.command("frame")
                time.sleep(0.05)

        publisher = threading.Thread(target=publish)
        publisher.start()
        try:
            self.open(PORTRAIT)
            self.browser.wait_for(f"!{LABEL}.hidden")
            text = self.browser.evaluate(f"{LABEL}.textContent")
            keep(self.browser.screenshot(), "reduced_look")
            shown_px, full_px = map(int, re.findall(r"\d+", text))
            self.assertGreaterEqual(shown_px, 200)
            self.assertLess(shown_px, full_px)
        finally:
            is_moving.clear()
            publisher.join()
        self.browser.wait_for(f"{LABEL}.hidden")
        self.assertEqual(self.layout()["tile_size"]["width"], full_px)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["EyeViewsTest"])])
