# SPDX-License-Identifier: Apache-2.0
"""The page's picker and switches: colour with depth as a display, a focal plane that follows.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import json
import shlex
import sys
import unittest
from urllib.parse import parse_qsl, urlsplit

from modes_test import NAMELESS, SMALL_TARGETS
from page_test import LIVE, SMALL, PageTest, keep
from web_client import Server, asked, decode_code, quilt

OPEN_MODES = """[...document.querySelectorAll('#modes input')]
  .filter(e => !e.disabled).map(e => e.value)"""
DISPLAY_IDS = "fetch('/api/displays').then(r => r.json()).then(r => r.displays.map(d => d.id))"
FACTS = "document.getElementById('facts').innerText"
WATCH = "document.getElementById('command-watch').value"
# The display in the page's address; null where a preset's name says it all.
DISPLAY = "JSON.parse(new URLSearchParams(location.search).get('display'))"


class Choices(PageTest):
    def setUp(self):
        self.server = Server(PROGRAM, "--rate-hz", 5)
        self.addCleanup(lambda: self.server.__exit__())
        self.start_browser()

    def watch_views_of(self, width, height):
        for name, value in (("width", width), ("height", height), ("screen_m", 2)):
            self.browser.evaluate(f"document.getElementById('rgbd-{name}').value = {value}")
        self.browser.click("#rgbd button")

    def nodes(self):
        tree = self.browser.call("Accessibility.getFullAXTree")["nodes"]
        return {(node["role"]["value"], node["name"]["value"]): node for node in tree
                if "name" in node and not node["ignored"]}

    def codes(self, columns, rows):
        """What stands in the tiles of the picture, row by row from the top."""
        left, top, width, height = self.canvas()
        canvas = self.browser.screenshot().crop((left, top, left + width, top + height))
        margin = 0.025 * min(width, height)
        aspect = columns / rows * 320 / 180
        shown = min(width - 2 * margin, (height - 2 * margin) * aspect)
        side, line = shown / columns, shown / aspect / rows
        x, y = (width - shown) / 2, (height - shown / aspect) / 2
        return [decode_code(canvas.crop((int(x + c * side), int(y + r * line),
                                         int(x + (c + 1) * side), int(y + (r + 1) * line))))
                for r in range(rows) for c in range(columns)]

    def test_a_preset_of_colour_with_depth_is_watched_whole(self):
        self.open("?" + asked(quilt(8, 6, 1680, 1680, focal_distance_m=2,
                                    beside={"focus_following_s": 1}), mode="rgbd"))
        self.fill("preset", "wowvx")
        self.browser.wait_for(f"{FACTS}.includes('1920 × 540')")
        note = self.browser.evaluate("document.getElementById('rgbd-note').textContent")
        self.assertIn("header", note)
        self.assertIn("not published", note)
        self.watch_views_of(320, 180)
        self.browser.wait_for(f"{FACTS}.includes('640 × 180')")
        self.assertEqual(self.browser.evaluate("document.documentElement.dataset.mode"), "quilt")
        self.assertEqual(self.browser.evaluate(OPEN_MODES), ["single", "quilt"])
        self.assertEqual(self.codes(2, 1), [0, 1])
        for slider in ("focus", "follow", "cone"):
            self.assertTrue(self.browser.evaluate(f"document.getElementById('{slider}').disabled"))
        self.assertEqual(self.browser.evaluate(NAMELESS), [])
        keep(self.browser.screenshot(), "rgbd_display")
        words = shlex.split(self.browser.evaluate(WATCH))
        display = {"rgbd": {"preset": "wowvx", "screen_m": 2,
                            "view_size": {"width": 320, "height": 180}}}
        self.assertEqual(words[:4] + words[5:],
                         "viewloom watch painted --display --out atlases".split())
        self.assertEqual(json.loads(words[4]), display)
        still = self.browser.evaluate("document.getElementById('command-still').value")
        url = urlsplit(shlex.split(still)[-1])
        self.assertEqual(url.path, "/still/painted.jpg")
        self.assertEqual(json.loads(dict(parse_qsl(url.query))["display"]), display)

        self.open(self.browser.evaluate("location.search"))
        self.browser.wait_for(f"{FACTS}.includes('640 × 180')")
        self.assertEqual(self.browser.evaluate("document.getElementById('preset').value"), "wowvx")
        self.fill("preset", "portrait")
        self.browser.wait_for(f"{FACTS}.includes('8 × 6 = 48')")
        self.assertEqual(len(self.browser.evaluate(OPEN_MODES)), 6)
        self.assertTrue(self.browser.evaluate("document.getElementById('rgbd').hidden"))
        self.assertIn("preset=portrait", self.browser.evaluate("location.search"))
        self.assertNotIn("display", self.browser.evaluate("location.search"))
        self.assertEqual(self.browser.messages, [])

    def test_elemental_images_have_the_size_of_their_device(self):
        self.open("?" + asked(quilt(8, 6, 1680, 1680, focal_distance_m=2), mode="look"))
        self.fill("preset", "near_eye_2013")
        self.browser.wait_for(f"{FACTS}.includes('1280 × 720')")
        self.assertEqual(self.browser.evaluate(OPEN_MODES), ["single", "quilt"])
        self.assertTrue(self.browser.evaluate("document.getElementById('rgbd').hidden"))
        self.assertEqual(
            shlex.split(self.browser.evaluate(WATCH)),
            "viewloom watch painted --preset near_eye_2013 --out atlases".split())
        self.assertEqual(self.browser.messages, [])

    def test_two_layers_are_four_quadrants(self):
        self.open(SMALL + "&mode=quilt")
        self.fill("preset", "rgbd:RGBD_FORM_TWO_LAYERS")
        self.watch_views_of(320, 180)
        self.browser.wait_for(f"{FACTS}.includes('640 × 360')")
        self.assertEqual(self.codes(2, 2), [0, 1, 2, 3])
        self.assertIn('"form":"RGBD_FORM_TWO_LAYERS"', self.browser.evaluate(WATCH))
        self.assertIn("/still/painted.jpg?display=",
                      self.browser.evaluate("document.getElementById('command-still').value"))
        self.fill("preset", "")
        self.browser.wait_for(f"{FACTS}.includes('8 × 6 = 48')")

    def test_a_full_screen_shows_nothing_but_the_picture(self):
        self.open("?" + asked({"rgbd": {"view_size": {"width": 320, "height": 180}}}))
        self.browser.click("#fullscreen")
        self.browser.wait_for("document.fullscreenElement && innerWidth === "
                              "document.getElementById('stage').clientWidth")
        self.browser.wait_for("document.getElementById('stage').width === innerWidth")
        # Less the ring that shown_picture() leaves out; the margin would be 2.5 % of the height.
        self.assertGreaterEqual(self.shown_picture().width, self.canvas()[2] - 2 * 4 - 2)

    def test_the_focal_plane_follows_by_a_checkbox(self):
        self.browser.call("Emulation.setFocusEmulationEnabled", enabled=True)
        self.open(SMALL + "&mode=quilt")  # the focus of a single eye's view stands
        before = self.browser.evaluate(DISPLAY_IDS)
        self.browser.wait_for("!document.getElementById('follow').disabled")
        name = ("checkbox", "Focus follows the content")
        self.assertIn(name, self.nodes())
        self.browser.evaluate("document.getElementById('follow').focus()")
        for kind in ("keyDown", "keyUp"):
            self.browser.call("Input.dispatchKeyEvent", type=kind, key=" ", code="Space", text=" ",
                              windowsVirtualKeyCode=32)
        self.browser.wait_for(f"{DISPLAY}?.focus_following_s === 1")
        self.browser.wait_for(f"{WATCH}.includes('\"focus_following_s\":1')")
        # Another display to the server, as it is another picture.
        self.browser.wait_for(f"{DISPLAY_IDS}.then(ids => ids.length === 1 && "
                              f"ids[0] !== {before[0]})")
        self.browser.evaluate("document.getElementById('follow').scrollIntoView()")
        keep(self.browser.screenshot(), "focus_follows")
        self.open(self.browser.evaluate("location.search"))
        self.assertTrue(self.browser.evaluate("document.getElementById('follow').checked"))
        self.browser.evaluate("document.getElementById('follow').scrollIntoView()")
        self.browser.click("label.check:has(#follow)")
        self.browser.wait_for(f"!{DISPLAY}?.focus_following_s")
        self.browser.wait_for(f"!{WATCH}.includes('focus_following')")
        self.assertEqual(self.browser.messages, [])

    def test_reflections_are_asked_for_by_a_checkbox(self):
        self.open()
        self.assertIn(("checkbox", "Reflections"), self.nodes())
        for is_on in (True, False):
            before = self.browser.evaluate(DISPLAY_IDS)
            self.browser.evaluate("document.getElementById('reflections').scrollIntoView()")
            self.browser.click("label.check:has(#reflections)")
            no = "" if is_on else "!"
            self.browser.wait_for(f"{no}({DISPLAY}?.effects?.reflection?.bounces === 2)")
            self.browser.wait_for(f"{no}{WATCH}.includes('\"reflection\":{{\"bounces\":2}}')")
            # Another display to the server, as it is another picture.
            self.browser.wait_for(f"{DISPLAY_IDS}.then(ids => ids.length === 1 && "
                                  f"ids[0] !== {before[0]})")
            self.open(self.browser.evaluate("location.search"))
            self.assertEqual(
                self.browser.evaluate("document.getElementById('reflections').checked"), is_on)
        self.assertEqual(self.browser.messages, [])

    def test_a_lens_is_put_before_the_views_by_its_list(self):
        self.open()
        before = self.browser.evaluate(DISPLAY_IDS)
        self.browser.wait_for("!document.getElementById('lens').disabled")
        self.fill("lens", "0.03")
        self.browser.wait_for(f"{DISPLAY}?.effects.lens.aperture_radius_m === 0.03")
        self.browser.wait_for(f"{WATCH}.includes('\"aperture_radius_m\":0.03')")
        self.browser.wait_for(f"{DISPLAY_IDS}.then(ids => ids.length === 1 && "
                              f"ids[0] !== {before[0]})")
        self.open(self.browser.evaluate("location.search"))
        self.assertEqual(self.browser.evaluate("document.getElementById('lens').value"), "0.03")
        # It takes long: with the least detail, an eighth of each side, it comes soon.
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""
            window.opened = [];
            const Real = WebSocket;
            window.WebSocket = class extends Real {
              constructor(url) { super(url); window.opened.push(String(url)); }
            };""")
        lens = {"lens": {"aperture_radius_m": 0.03}}
        self.open("?" + asked({"preset": "portrait", "effects": lens}, mode="quilt"))
        opened = dict(parse_qsl(urlsplit(self.browser.evaluate("opened[0]")).query))
        self.assertEqual(json.loads(opened["display"])["quilt"]["size"],
                         {"width": 420, "height": 420})
        self.assertEqual(self.browser.messages, [])

    def test_atlases_between_frames_and_quality_are_chosen_by_their_lists(self):
        self.open()
        for name, value, address, command in (
                ("between", "interpolate", "effects?.temporal",
                 '"temporal":{"output_rate_hz":60,"mode":"TEMPORAL_MODE_INTERPOLATE"}'),
                ("effort", "draft", "quality", '"quality":"QUALITY_DRAFT"')):
            before = self.browser.evaluate(DISPLAY_IDS)
            for chosen in (value, ""):
                self.fill(name, chosen)
                if not chosen:
                    self.browser.wait_for(f"!{DISPLAY}?.{address}")
                    self.browser.wait_for(f"!{WATCH}.includes('{command}')")
                    continue
                self.browser.wait_for(f"{DISPLAY}?.{address}")
                self.browser.wait_for(f"{WATCH}.includes('{command}')")
                # Another display to the server, as it is another picture.
                self.browser.wait_for(f"{DISPLAY_IDS}.then(ids => ids.length === 1 && "
                                      f"ids[0] !== {before[0]})")
                self.open(self.browser.evaluate("location.search"))
                self.assertEqual(
                    self.browser.evaluate(f"document.getElementById('{name}').value"), value)
        self.assertEqual(self.browser.messages, [])

    def test_a_picture_that_is_long_in_coming_is_said_to_be(self):
        notice = "document.getElementById('notice').textContent"
        self.browser.open(self.server.url + "?stream=silent")
        self.browser.wait_for(f"{notice}.includes('Still waiting for the picture')")
        self.fill("stream", "painted")
        self.browser.wait_for(f"{LIVE} && {notice} === ''")

    def test_fingers_hit_the_fields_of_colour_with_depth_and_the_checkbox(self):
        self.browser.resize(360, 780, scale=2, mobile=True)
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        for query in ("?stream=painted&preset=wowvx&width=320&height=180", SMALL):
            self.open(query)
            self.assertEqual(self.browser.evaluate("document.documentElement.scrollWidth"), 360)
            self.assertEqual(self.browser.evaluate(SMALL_TARGETS), [])


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["Choices"])])
