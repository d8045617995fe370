# SPDX-License-Identifier: Apache-2.0
"""The whole page with atlases of H.264: what it accepts, what it shows, and how it goes back to
JPEG. The server is fake_socket.js. Argument: the program code_stack."""
import json
import os
import sys
import time
import unittest
from urllib.parse import parse_qs, urlencode, urlsplit

import numpy as np

import coded_atlases
from browser import CHROMIUM, Browser

HERE = os.path.dirname(os.path.abspath(__file__))
VIDEO, JPEG = "BAND_ENCODING_H264", "BAND_ENCODING_JPEG"
DISPLAY = {"quilt": {"columns": 4, "rows": 3, "size": {"width": 512, "height": 384},
                     "aspect": 4 / 3}}
STATE = "document.documentElement.dataset.state"
NO_VIDEO = "delete window.VideoDecoder;"


def coloured_views():
    """View v is one colour, brighter from view to view."""
    return np.stack([np.full((128, 128, 3), (20 * view, 128, 255 - 20 * view), np.uint8)
                     for view in range(12)])


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class VideoPage(unittest.TestCase):
    def setUp(self):
        self.views = coloured_views()
        layout = coded_atlases.layout_of(4, 3, self.views)
        ((video, units),) = coded_atlases.code_stacks(PROGRAM, [self.views], 20)
        broken = [units[0], *([bytes(40)] * (len(units) - 1))]
        self.files = coded_atlases.PageFiles({
            **coded_atlases.PAGE_ANSWERS,
            "video": coded_atlases.video_message(layout, video, units),
            "lost": coded_atlases.video_message(layout, video, units, reference_sequence=5,
                                                sequence=6),
            "alone": coded_atlases.video_message(layout, video, units, sequence=8, delivery=2,
                                                 change_count=1),
            "broken": coded_atlases.video_message(layout, video, broken, delivery=2),
            "jpeg": coded_atlases.jpeg_message(layout, self.views, sequence=7, delivery=3,
                                               change_count=1)})
        self.addCleanup(self.files.close)
        self.browser = Browser()
        self.addCleanup(self.browser.close)
        with open(os.path.join(HERE, "fake_socket.js"), encoding="utf-8") as script:
            self.inject(script.read())

    def inject(self, script):
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source=script)

    def open(self, *atlases, mode="quilt", encoding=None, host="127.0.0.1"):
        self.inject(f"window.wanted = {json.dumps(atlases)};")
        parameters = {"stream": "demo", "display": json.dumps(DISPLAY), "mode": mode,
                      "detail": "1"}
        if encoding:
            parameters["encoding"] = json.dumps(encoding)
        url = self.files.url.replace("127.0.0.1", host)
        self.browser.open(f"{url}?{urlencode(parameters)}")
        self.browser.wait_for("window.asked.length > 0")

    def asked(self):
        """Parameters of the first address of /ws."""
        query = parse_qs(urlsplit(self.browser.evaluate("asked[0]")).query)
        return {name: json.loads(query[name][0]) for name in ("accepted", "encoding")
                if name in query}

    def wait_for_picture(self, sequence):
        self.browser.wait_for(f"document.documentElement.dataset.sequence === '{sequence}'")

    def assert_quilt(self):
        """Each view stands in its tile on the stage."""
        colours = self.browser.evaluate("""(() => {
          const canvas = document.getElementById('stage');
          const context = canvas.getContext('2d');
          const margin = Math.round(Math.min(canvas.width, canvas.height) * 0.025);
          const width = Math.min(canvas.width - 2 * margin, (canvas.height - 2 * margin) * 4 / 3);
          const height = width * 3 / 4;
          const left = (canvas.width - width) / 2, top = (canvas.height - height) / 2;
          return Array.from({length: 12}, (_, view) => [...context.getImageData(
              left + width * (view % 4 + 0.5) / 4,
              top + height * (2 - Math.floor(view / 4) + 0.5) / 3, 1, 1).data].slice(0, 3));
        })()""")
        for view, colour in enumerate(colours):
            error = np.abs(np.array(colour) - self.views[view, 0, 0]).max()
            self.assertLessEqual(error, 4, f"view {view}: {colour}")

    def test_the_first_message_says_what_the_browser_accepts(self):
        self.open("video")
        accepted = self.asked()["accepted"]
        self.assertEqual([one["color"] for one in accepted], [JPEG, VIDEO])  # on loopback
        self.assertEqual(accepted[1]["picture_size_max"], {"width": 4096, "height": 2176})
        self.assertEqual(accepted[1]["level_max"], 51)
        self.assertNotIn("encoding", self.asked())

    def test_video_is_preferred_where_a_network_is_between(self):
        self.open("video", host="far.localhost")
        self.assertEqual([one["color"] for one in self.asked()["accepted"]], [VIDEO, JPEG])
        self.wait_for_picture(1)
        self.assert_quilt()

    def test_a_browser_without_webcodecs_accepts_jpeg_alone(self):
        self.inject(NO_VIDEO)
        self.open("jpeg", encoding={"color": VIDEO})
        self.assertEqual(self.asked(), {"accepted": [{"color": JPEG}],
                                        "encoding": {"color": JPEG}})
        self.wait_for_picture(7)
        self.assert_quilt()

    def test_a_quilt_of_video_is_shown(self):
        self.open("video", encoding={"color": VIDEO})
        self.assertEqual(self.asked()["encoding"], {"color": VIDEO})
        self.wait_for_picture(1)
        self.assert_quilt()
        self.browser.wait_for("document.getElementById('facts').textContent.includes('H.264')")
        self.assertEqual(self.browser.evaluate("said.filter(m => m.shown).at(-1)"), {"shown": 1})
        self.assertEqual(self.browser.messages, [])

    def test_a_picture_that_came_before_a_refusal_does_not_hide_it(self):
        self.open("video", encoding={"color": VIDEO})
        self.wait_for_picture(1)
        self.browser.evaluate("""socket.deliver().then(() => {
              socket.onmessage({data: JSON.stringify(
                  {error: {code: 'INVALID_ARGUMENT', message: 'no more of it'}})});
              socket.onclose({code: 1008});
            })""")
        self.assertEqual(self.browser.evaluate(STATE), "refused")
        time.sleep(2)  # the picture is decoded by then
        self.assertEqual(self.browser.evaluate(STATE), "refused")

    def test_views_around_the_eye_come_as_jpeg(self):
        self.open("jpeg", mode="look", encoding={"color": VIDEO})
        self.assertEqual(self.asked()["encoding"], {"color": JPEG})

    def test_a_decoder_that_fails_in_mid_stream_is_replaced_by_jpeg(self):
        self.inject("window.onChange = () => { window.wanted = ['jpeg']; };")
        self.open("video", encoding={"color": VIDEO})
        self.wait_for_picture(1)
        self.browser.evaluate("wanted = ['broken'], socket.deliver(), 1")
        self.wait_for_picture(7)
        (change,) = self.browser.evaluate("said.filter(m => m.change).map(m => m.change)")
        self.assertEqual(change, {"encoding": {"color": JPEG}})
        self.assertIn("JPEG pictures come from now on",
                      self.browser.evaluate("document.getElementById('notice').textContent"))
        self.assertIn({"shown": 2}, self.browser.evaluate("said"))  # there is room for another
        self.assert_quilt()

    def test_a_page_that_cannot_follow_a_chain_gets_pictures_that_come_alone(self):
        self.inject("window.onChange = () => { window.wanted = ['alone']; };")
        self.open("lost", encoding={"color": VIDEO, "prediction": "PREDICTION_ACROSS_ATLASES"})
        self.wait_for_picture(8)
        (change,) = self.browser.evaluate("said.filter(m => m.change).map(m => m.change)")
        self.assertEqual(change, {"encoding": {"color": VIDEO}})
        self.assertIn("comes alone",
                      self.browser.evaluate("document.getElementById('notice').textContent"))
        self.assert_quilt()

    def test_a_reconnection_after_a_failure_accepts_jpeg_alone(self):
        self.inject("window.onChange = () => { window.wanted = ['jpeg']; };")
        self.open("broken", encoding={"color": VIDEO})
        self.wait_for_picture(7)
        self.browser.evaluate("socket.readyState = 3, socket.onclose({code: 1006}), 1")
        self.browser.wait_for("asked.length > 1")
        query = parse_qs(urlsplit(self.browser.evaluate("asked.at(-1)")).query)
        self.assertEqual(json.loads(query["accepted"][0]), [{"color": JPEG}])
        self.assertEqual(json.loads(query["encoding"][0]), {"color": JPEG})


if __name__ == "__main__":
    PROGRAM = sys.argv.pop()
    unittest.main()
