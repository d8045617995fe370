# SPDX-License-Identifier: Apache-2.0
"""The page's modes and controls, by keyboard, touch, tilt and screen reader, in a real browser.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

from PIL import Image

from page_checks import LOW_CONTRASTS
from page_test import PageTest, SMALL, keep
from web_client import Server, WebSocket, asked, decode_code, quilt

# Touch targets that are too small: name and height in px.
SMALL_TARGETS = """[...document.querySelectorAll(
    'button, select, input:not([type=radio]):not([type=checkbox]), #modes label, label.check')]
  .filter(e => e.checkVisibility() && !e.disabled)
  .map(e => [e.id || e.innerText, e.getBoundingClientRect().height])
  .filter(([, height]) => height < 43.9)"""
# Controls that a screen reader could not name.
NAMELESS = """[...document.querySelectorAll('button, select, input, textarea, canvas')]
  .filter(e => !(e.labels?.length || e.getAttribute('aria-label') || e.innerText))
  .map(e => e.id)"""


class Modes(PageTest):
    def setUp(self):
        self.server = Server(PROGRAM, "--rate-hz", 5)
        self.addCleanup(lambda: self.server.__exit__())
        self.start_browser()

    def mode(self):
        return self.browser.evaluate("document.documentElement.dataset.mode")

    def view(self, number):
        self.browser.wait_for(f"document.getElementById('stage').dataset.view === '{number}'")

    def phone(self, width=360, height=780):
        self.browser.resize(width, height, scale=2, mobile=True)
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)

    def test_modes_are_one_group_of_radio_buttons_for_keys_and_screen_readers(self):
        self.open()
        tree = self.browser.call("Accessibility.getFullAXTree")["nodes"]
        named = [(node["role"]["value"], node["name"]["value"]) for node in tree
                 if "name" in node and not node["ignored"]]
        for name in ("Look around", "Single views", "Quilt", "Panel", "Lens simulator", "Depth"):
            self.assertIn(("radio", name), named)
        self.assertIn(("group", "Mode"), named)
        self.browser.evaluate("document.querySelector('#modes input').focus()")
        for expected in ("single", "quilt", "panel", "eye", "rgbd", "look"):
            self.browser.call("Input.dispatchKeyEvent", type="rawKeyDown", key="ArrowRight",
                              code="ArrowRight", windowsVirtualKeyCode=39)
            self.assertEqual(self.mode(), expected)
        for key, expected in (("4", "panel"), ("q", "quilt"), ("q", "look"), ("2", "single")):
            self.browser.key(key)
            self.assertEqual(self.mode(), expected)
        self.assertIn("mode=single", self.browser.evaluate("location.search"))
        self.assertEqual(self.browser.messages, [])

    def test_every_control_has_a_name_and_news_are_said(self):
        for mode in ("look", "single", "quilt", "panel", "eye"):
            self.open(f"{SMALL}&mode={mode}")
            self.browser.wait_for("document.getElementById('chart-rate').ariaLabel"
                                  "?.startsWith('Pictures a second')")
            self.assertEqual(self.browser.evaluate(NAMELESS), [], mode)
            self.browser.wait_for("document.getElementById('said').textContent"
                                  " === 'Live: painted, views: 48.'")

    def test_all_controls_are_reached_by_the_tab_key_and_show_it(self):
        self.browser.call("Emulation.setFocusEmulationEnabled", enabled=True)
        self.open()
        reached = []
        for _ in range(40):
            self.browser.call("Input.dispatchKeyEvent", type="rawKeyDown", key="Tab", code="Tab",
                              windowsVirtualKeyCode=9)
            name, outline = self.browser.evaluate(
                "(e => [e.id || e.value || e.tagName, getComputedStyle(e.name === 'mode' ? "
                "e.parentElement : e).outlineStyle])(document.activeElement)")
            reached.append(name)
            if name != "BODY":
                self.assertNotEqual(outline, "none", name)
        for name in ("stream", "preset", "detail", "custom-columns", "look", "stage", "view",
                     "focus", "follow", "cone", "command-watch", "copy-socket"):
            self.assertIn(name, reached)

    def test_single_views_stand_still_and_go_by_number(self):
        self.open(SMALL + "&mode=single")
        self.view(24)
        left, top, _, height = self.canvas()
        self.browser.mouse(left + 30, top + height / 2)
        self.browser.click("#single-on")
        self.view(25)
        self.assertEqual(decode_code(self.shown_picture()), 25)
        self.browser.evaluate("(n => { n.focus(); n.value = 6; "
                              "n.dispatchEvent(new Event('input')); })"
                              "(document.getElementById('single-view'))")
        self.view(6)
        self.browser.evaluate("document.getElementById('stage').focus()")
        self.browser.key("End")
        self.view(47)
        self.assertTrue(self.browser.evaluate("document.getElementById('single-on').disabled"))
        self.assertEqual(decode_code(self.shown_picture()), 47)

    def test_depth_stands_beside_the_colour_of_the_middle_view(self):
        self.open(SMALL + "&mode=single")
        self.browser.click("#modes label:last-child")
        self.browser.wait_for("document.getElementById('rgbd-range').textContent"
                              " === 'white: 1.00 m, black: 3.97 m'")
        self.browser.wait_for("document.getElementById('facts').innerText.includes('210 × 280')")
        left, top, width, height = self.canvas()
        shot = self.browser.screenshot().crop((left, top, left + width, top + height))
        # Both halves are views of aspect 0.75 and fill the height, less a margin of 2.5 %.
        half = 0.75 * 0.95 * height
        self.assertEqual(decode_code(shot.crop((int(width / 2 - half), int(0.025 * height),
                                                int(width / 2), int(0.975 * height)))), 0)
        for share in (0.1, 0.5, 0.9):  # 1/Z rises evenly to the right
            red, green, blue = shot.getpixel((int(width / 2 + share * half), int(height / 3)))
            self.assertTrue(red == green == blue)
            self.assertAlmostEqual(red / 255, share, delta=0.02)
        keep(self.browser.screenshot(), "rgbd")
        self.browser.click("#modes label:nth-of-type(2)")
        self.view(24)
        self.browser.wait_for("document.getElementById('facts').innerText.includes('1 × 1 = 1')")

    def test_tilting_the_device_looks_around(self):
        self.phone()
        self.browser.call("DeviceOrientation.setDeviceOrientationOverride",
                          alpha=0, beta=45, gamma=5)
        self.open()
        self.browser.wait_for("!document.getElementById('tilt').hidden")
        self.browser.call("DeviceOrientation.clearDeviceOrientationOverride")
        self.browser.evaluate("DeviceOrientationEvent.requestPermission &&= async () => 'granted'")
        self.browser.evaluate("document.getElementById('tilt').scrollIntoView()")
        self.browser.click("#tilt")
        self.browser.wait_for("document.getElementById('tilt').ariaPressed === 'true'")
        # From 5 degrees, in the middle: 10 of 40 with its right edge away look from further left.
        for gamma, expected in ((5, 24), (15, 12), (-5, 35), (60, 0)):
            self.browser.evaluate("dispatchEvent(new DeviceOrientationEvent('deviceorientation', "
                                  f"{{alpha: 0, beta: 45, gamma: {gamma}}}))")
            self.view(expected)

    def test_a_phone_has_room_for_everything_and_fingers_hit_it(self):
        self.phone()
        for mode in ("look", "single", "panel", "eye", "rgbd"):
            self.open(f"{SMALL}&mode={mode}")
            self.assertEqual(self.browser.evaluate("document.documentElement.scrollWidth"), 360)
            self.assertEqual(self.browser.evaluate(SMALL_TARGETS), [], mode)
            keep(self.browser.screenshot(), f"phone_{mode}")

    def test_a_custom_quilt_is_watched_as_asked(self):
        self.open("?stream=painted&preset=8_9_gen1&mode=quilt")
        self.fill("preset", "")
        fields = {"columns": 4, "rows": 3, "width": 400, "height": 480, "aspect": 1.25}
        for name, value in fields.items():
            self.assertNotEqual(
                self.browser.evaluate(f"document.getElementById('custom-{name}').value"), "")
            self.browser.evaluate(f"document.getElementById('custom-{name}').value = {value}")
        self.browser.click("#custom button")
        self.browser.wait_for("document.getElementById('facts').innerText.includes('4 × 3 = 12')")
        self.assertIn("400 × 480 px",
                      self.browser.evaluate("document.getElementById('facts').innerText"))

    @unittest.skipUnless(shutil.which("curl"), "there is no curl")
    def test_commands_fetch_what_is_shown(self):
        self.open(SMALL + "&mode=quilt")
        command = {name: self.browser.wait_for(f"document.getElementById('command-{name}').value")
                   for name in ("watch", "still", "socket")}
        self.assertIn("viewloom watch painted --display '{\"quilt\":", command["watch"])
        self.assertNotIn("focus_following", command["watch"])
        self.assert_curl_writes(command["still"], "painted_qs8x6a0.75.jpg", (1680, 1680))
        viewer = WebSocket(self.server.port, command["socket"].split(str(self.server.port), 1)[1])
        self.addCleanup(viewer.close)
        shown = json.loads(self.browser.evaluate(
            "fetch('/api/displays').then(r => r.text())"))["displays"]
        self.assertEqual(viewer.receive_atlas().header["layout"], shown[0]["layout"])
        self.assertEqual(len(shown), 1)

    def assert_curl_writes(self, command, name, size):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(shlex.split(command), cwd=folder, check=True, capture_output=True)
            self.assertEqual(os.listdir(folder), [name])
            with Image.open(os.path.join(folder, name)) as still:
                self.assertEqual(still.size, size)

    def test_commands_name_the_preset_and_never_what_is_asked_for_at_the_moment(self):
        for mode in ("look", "single", "quilt"):
            with self.subTest(mode):
                self.open(f"?stream=painted&mode={mode}")
                command = {name: self.browser.wait_for(
                    f"document.getElementById('command-{name}').value")
                    for name in ("watch", "still", "socket")}
                self.assertEqual(command["watch"],
                                 "viewloom watch painted --preset portrait --out atlases")
                self.assertEqual(command["still"],
                                 f"curl -L -O -J {self.server.url}still/painted/portrait")
                self.assertEqual(command["socket"],
                                 f"ws://127.0.0.1:{self.server.port}/ws?stream=painted&"
                                 "preset=portrait")

    def test_a_focal_plane_that_follows_does_so_in_the_commands_too(self):
        words = '"focus_following_s":0.5'
        for display in (quilt(8, 6, 1680, 1680), {"preset": "portrait"}):
            self.open("?" + asked({**display, "focus_following_s": 0.5}))
            watch = self.browser.wait_for("document.getElementById('command-watch').value")
            self.assertIn(words, watch)

    def test_the_depth_budget_is_shown_where_the_server_says_it(self):
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""
            const real = JSON.parse;
            JSON.parse = (text) => {
              const value = real(text);
              if (value?.coverage) value.depth_budget = {
                disparity_max_px: 9.25, beyond_fusing_share: 0.2, beyond_ghosting_share: 0.05,
                suggested_focal_distance_m: 1.5, suggested_view_cone_rad: 0.5235987755982988};
              return value;
            };""")
        self.open()
        self.browser.wait_for("!document.getElementById('budget').hidden")
        text = self.browser.evaluate("document.getElementById('budget').innerText")
        for words in ("9.3 px", "20.0 %", "5.0 %", "1.50 m", "30°"):
            self.assertIn(words, text)
        self.browser.evaluate("document.getElementById('budget-take').click()")
        self.browser.wait_for("document.getElementById('focus-value').textContent === '1.50 m'")
        self.browser.wait_for("document.getElementById('cone-value').textContent === '30°'")

    def test_views_that_look_past_the_source_are_told(self):
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""
            const real = JSON.parse;
            window.outside = [{first_view: 0, last_view: 6, share: 0.0301},
                              {first_view: 47, last_view: 47, share: 0.5}];
            JSON.parse = (text) => {
              const value = real(text);
              if (value?.coverage) value.views_outside = window.outside;
              return value;
            };""")
        self.open(f"{SMALL}&mode=quilt")
        self.browser.wait_for("!document.getElementById('outside').hidden")
        text = self.browser.evaluate("document.getElementById('outside').innerText")
        for words in ("views 0–6 by 4 %", "view 47 by 50 %"):
            self.assertIn(words, text)
        self.browser.evaluate("window.outside = []")
        self.browser.wait_for("document.getElementById('outside').hidden")

    def test_pages_are_dark_or_light_as_wished(self):
        for scheme, ground in (("dark", "rgb(10, 12, 16)"), ("light", "rgb(244, 246, 249)")):
            self.browser.call("Emulation.setEmulatedMedia",
                              features=[{"name": "prefers-color-scheme", "value": scheme},
                                        {"name": "prefers-reduced-motion", "value": "reduce"}])
            self.open()
            self.assertEqual(self.browser.evaluate(
                "getComputedStyle(document.documentElement).backgroundColor"), ground)
            self.assertEqual(self.browser.evaluate(LOW_CONTRASTS), [], scheme)
            keep(self.browser.screenshot(), scheme)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["Modes"])])
