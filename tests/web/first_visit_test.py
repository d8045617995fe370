# SPDX-License-Identifier: Apache-2.0
"""The page in the eyes of somebody new: what stands where, what it says about streams and displays
that are not there, and what its words mean.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import json
import sys
import time
import unittest

from page_checks import UNREASONED
from page_test import LIVE, PageTest, SMALL, keep
from web_client import Server, asked, quilt

STATE = "document.documentElement.dataset.state"
TROUBLE = "document.getElementById('trouble')"
BRIEF = "document.getElementById('brief').textContent"
# Lets time pass for all that asks the page's clock.
CLOCK = """const real = performance.now.bind(performance);
           window.later_ms = 0;
           performance.now = () => real() + later_ms;"""


class FirstVisit(PageTest):
    def setUp(self):
        self.server = Server(PROGRAM, "--rate-hz", 5)
        self.addCleanup(lambda: self.server.__exit__())
        self.start_browser()

    def text(self, name):
        return self.browser.evaluate(f"document.getElementById('{name}').innerText")

    def visit(self, query):
        self.browser.open(self.server.url + query)

    def new_document(self, source):
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source=source)

    def test_controls_come_before_figures_and_figures_are_folded_away(self):
        self.visit(SMALL)
        self.browser.wait_for(f"{LIVE} && {BRIEF}.includes('/s')")
        tops = [self.browser.evaluate(
            f"document.getElementById('{name}').getBoundingClientRect().top")
            for name in ("focus", "effort", "elsewhere", "diagnostics")]
        self.assertEqual(tops, sorted(tops))
        folded = "document.getElementById('chart-rate').checkVisibility()"
        self.assertFalse(self.browser.evaluate(folded))
        self.browser.key("i")
        self.browser.wait_for(folded)
        self.browser.key("i")
        self.browser.wait_for(f"!{folded}")

    def test_charts_have_scales(self):
        self.open()
        self.browser.wait_for("document.querySelectorAll('.plot').length === 4 && "
                              "Number(document.getElementById('rate').textContent) > 3")
        for name, unit, begin in (("rate", "", "1 min ago"), ("drops", "", "1 min ago"),
                                  ("latency", " ms", "120 pictures ago"),
                                  ("coverage", " %", "120 pictures ago")):
            labels = self.browser.wait_for(
                f"(p => p.querySelector('.plot-top').textContent && "
                f"[...p.querySelectorAll('span')].map(s => s.textContent))"
                f"(document.getElementById('chart-{name}').parentElement)")
            self.assertRegex(labels[0], rf"^(0\.)?0*[125]0*{unit}$")
            self.assertEqual(labels[1:], ["0", begin, "now"])
        self.assertEqual(self.browser.evaluate(
            "document.querySelector('#chart-coverage').parentElement.firstChild.textContent"),
            "100 %")

    def test_a_skipped_picture_is_no_alarm(self):
        self.open()
        self.browser.wait_for("document.getElementById('facts').innerText.includes("
                              "'for newer pictures')")
        bad = self.browser.evaluate(
            "getComputedStyle(document.documentElement).getPropertyValue('--bad')")
        self.browser.evaluate("document.getElementById('chart-drops').scrollIntoView()")
        self.assertNotIn(bad, self.browser.evaluate("document.getElementById('panel').innerHTML"))
        self.assertEqual(self.text("notice"), "")

    def test_views_count_from_0(self):
        self.open()
        for share, view in ((0, 0), (1, 47), (0.5, 24)):
            self.browser.evaluate(f"(v => {{ v.value = {share}; "
                                  "v.dispatchEvent(new Event('input')); })"
                                  "(document.getElementById('view'))")
            self.browser.wait_for(f"document.getElementById('ruler-view').textContent === "
                                  f"'view {view} of 0–47'")
        self.open(SMALL + "&mode=single")
        self.browser.wait_for("document.getElementById('single-count').textContent === 'of 0–47'")
        self.browser.evaluate("document.getElementById('stage').focus()")
        self.browser.key("Home")
        self.browser.wait_for("document.getElementById('single-view').value === '0' && "
                              "document.getElementById('stage').dataset.view === '0'")

    def test_a_still_says_still_and_a_moving_picture_its_latency(self):
        self.open()
        self.browser.wait_for(f"/^[0-9.]+\\/s, [0-9.]+ ms$/.test({BRIEF})")
        self.server.__exit__()
        self.server = Server(PROGRAM)
        self.open(SMALL)
        self.browser.wait_for(f"{BRIEF} === 'still'")
        self.assertEqual(self.text("latency"), "still")
        self.assertEqual(self.text("rate"), "–")
        # Other views of the frame that stands are no motion.
        self.browser.evaluate("(v => { v.value = 0.9; v.dispatchEvent(new Event('input')); })"
                              "(document.getElementById('view'))")
        time.sleep(0.6)
        self.assertEqual(self.text("latency"), "still")
        self.server.command("frame")
        self.browser.wait_for(f"{BRIEF}.includes('ms')")

    def test_a_stream_that_is_not_there_is_said_so_and_not_asked_for_for_ever(self):
        self.new_document(CLOCK + """
            window.asked = 0;
            const ask = window.fetch;
            window.fetch = (url, ...more) => { asked += url === 'api/streams';
                                               return ask(url, ...more); };""")
        self.visit("?stream=paintd")
        self.browser.wait_for(f"{STATE} === 'refused' && !{TROUBLE}.hidden")
        self.assertIn('There is no stream "paintd"', self.text("trouble"))
        self.assertIn("during one minute", self.text("trouble"))
        keep(self.browser.screenshot(), "no_such_stream")
        self.browser.evaluate("later_ms = 61000")
        self.browser.wait_for("!document.getElementById('trouble-again').hidden")
        before = self.browser.evaluate("asked")
        time.sleep(2.5)
        self.assertEqual(self.browser.evaluate("asked"), before)
        self.browser.click("#trouble-again")
        self.browser.wait_for(f"asked > {before} && {TROUBLE}.innerText.includes('one minute')")
        ways = self.browser.evaluate(
            "[...document.querySelectorAll('#trouble-ways a')].map(a => a.textContent)")
        self.assertEqual(ways, ["painted", "silent"])
        self.browser.click("#trouble-ways a")
        self.browser.wait_for(f"{LIVE} && {TROUBLE}.hidden")
        self.assertEqual(self.browser.messages, [])

    def test_a_preset_that_is_not_there_is_said_so_and_not_asked_for_at_all(self):
        self.new_document("""
            window.tries = 0;
            const Real = WebSocket;
            window.WebSocket = class extends Real { constructor(url) { super(url); ++tries; } };""")
        for query in ("?stream=painted&preset=portait",
                      "?" + asked({"quilt": {"preset": "portait"}})):
            self.visit(query)
            self.browser.wait_for(f"{STATE} === 'refused'")
            self.assertIn('no preset "portait"', self.text("trouble"))
            time.sleep(1.5)
            self.assertEqual(self.browser.evaluate("tries"), 0)
        keep(self.browser.screenshot(), "no_such_preset")
        self.browser.evaluate("[...document.querySelectorAll('#trouble-ways a')]"
                              ".find(a => a.textContent === 'portrait').click()")
        self.browser.wait_for(LIVE)
        self.assertIn("preset=portrait", self.browser.evaluate("location.search"))
        self.assertIn("stream=painted", self.browser.evaluate("location.search"))

    def test_an_address_that_is_no_display_leads_to_the_page_without_it(self):
        for query, words in (("?display={", "no JSON object"), ("?colour=red", "does not know")):
            self.visit(query)
            self.browser.wait_for(f"{STATE} === 'refused'")
            self.assertIn(words, self.text("trouble"))
            self.browser.click("#trouble-ways a")
            self.browser.wait_for(LIVE)

    def test_a_display_that_the_server_refuses_is_asked_for_once(self):
        self.new_document("""
            window.tries = 0;
            const Real = WebSocket;
            window.WebSocket = class extends Real { constructor(url) { super(url); ++tries; } };""")
        wide = quilt(8, 6, 1680, 1680, view_cone_rad=9)
        self.visit("?" + asked(wide, mode="quilt", detail="1"))
        self.browser.wait_for(f"{STATE} === 'refused'")
        self.assertIn("view_cone_rad", self.text("trouble"))
        time.sleep(1.5)
        self.assertEqual(self.browser.evaluate("tries"), 1)
        self.browser.click("#trouble-again")
        self.browser.wait_for("tries === 2")
        # An engine that gives a display up later is not asked for it again, either. Of one size: a
        # page that has just asked for another one would get that. A picture that came before may
        # still be decoded then.
        self.open(SMALL + "&mode=quilt&detail=1")
        self.browser.evaluate("tries = 0")
        self.server.command("refuse")
        self.browser.wait_for(f"{STATE} === 'refused'")
        self.assertIn("larger than the device", self.text("trouble"))

    def test_what_can_do_nothing_is_off_and_says_why(self):
        self.visit("?stream=silent")
        self.browser.wait_for(f"{STATE} === 'connecting'")
        self.assertTrue(self.browser.evaluate("document.getElementById('share').disabled"))
        self.assertEqual(self.browser.evaluate(UNREASONED), [])
        self.open("?" + asked({"rgbd": {"view_size": {"width": 320, "height": 180}}}))
        self.browser.wait_for("document.getElementById('focus').disabled")
        self.assertEqual(self.browser.evaluate(UNREASONED), [])
        reasons = {name: self.browser.evaluate(f"{place}.title") for name, place in (
            ("focus", "document.getElementById('focus')"),
            ("lens", "document.getElementById('lens')"),
            ("panel", "document.querySelector('[value=panel]')"))}
        self.assertIn("no focal plane", reasons["focus"])
        self.assertIn("sharp all over", reasons["lens"])
        self.assertIn("the views of a quilt", reasons["panel"])
        # A finger has no pointer that could rest on it.
        self.browser.click("#modes label:nth-of-type(4)")
        self.browser.wait_for(f"document.getElementById('notice').textContent === "
                              f"{json.dumps(reasons['panel'])}")
        self.open("?stream=painted&preset=near_eye_2013")
        self.assertIn("size of its panel",
                      self.browser.evaluate("document.getElementById('detail').title"))
        self.open(SMALL + "&mode=eye")
        self.browser.click("label:has(#eye-bare)")
        self.browser.wait_for("document.getElementById('eye-blur').disabled")
        self.assertEqual(self.browser.evaluate(UNREASONED), [])
        self.browser.click("label:has(#eye-bare)")
        self.browser.wait_for("!document.getElementById('eye-blur').disabled && "
                              "document.getElementById('eye-blur').title === ''")

    def test_the_reset_is_off_until_there_is_something_to_reset(self):
        self.open()
        self.browser.wait_for("document.getElementById('focus-value').textContent === '2.00 m'")
        off = "document.getElementById('reset').disabled"
        self.assertTrue(self.browser.evaluate(off))
        self.browser.evaluate("(f => { f.value = 1; f.dispatchEvent(new Event('input')); })"
                              "(document.getElementById('focus'))")
        self.browser.wait_for(f"!{off}")
        self.browser.evaluate("document.getElementById('reset').click()")
        self.browser.wait_for(f"{off} && document.getElementById('focus-value').textContent"
                              " === '2.00 m'")

    def test_a_question_mark_lists_the_shortcuts(self):
        self.open()
        dialog = "document.getElementById('keys')"
        self.browser.key("?")
        self.browser.wait_for(f"{dialog}.open")
        listed = self.text("key-list")
        for words in ("?", "1 – 6", "full screen", "diagnostics", "controls", "quilt"):
            self.assertIn(words, listed)
        keep(self.browser.screenshot(), "shortcuts")
        self.browser.key("2")  # behind the list nothing happens
        self.assertEqual(self.browser.evaluate("document.documentElement.dataset.mode"), "look")
        self.browser.key("?")
        self.browser.wait_for(f"!{dialog}.open")
        self.browser.click("#show-keys")
        self.browser.wait_for(f"{dialog}.open")
        self.browser.click("#keys-close")
        self.browser.wait_for(f"!{dialog}.open")


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["FirstVisit"])])
