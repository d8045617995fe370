# SPDX-License-Identifier: Apache-2.0
"""The policy of automatic detail against machines of known speed, in simulated time. The policy is
the page's own module, run in a browser that shows nothing."""
import json
import os
import sys
import unittest

from browser import CHROMIUM, Browser
from web_client import Server

SIMULATION = os.path.join(os.path.dirname(__file__), "simulated_machine.js")
WANTED_HZ = 8
SETTLED_S = 15  # from the first atlas on


def rate(atlases, begin_s, end_s):
    return sum(begin_s <= atlas["time_s"] < end_s for atlas in atlases) / (end_s - begin_s)


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class AutoDetail(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM)
        cls.addClassCleanup(cls.server.__exit__)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.browser.open(cls.server.url + "icon.svg")  # the page's origin without the page
        cls.browser.wait_for("location.href.endsWith('icon.svg')")
        with open(SIMULATION, encoding="utf-8") as file:
            cls.simulation = file.read()

    def simulate(self, seconds, **machine):
        """Details chosen, [(time in s, detail)], the first at 0 s; atlases shown."""
        result = self.browser.evaluate(
            f"import('/auto_detail.js').then(({{AutoDetail}}) => {{ {self.simulation}\n"
            f"return simulate(AutoDetail, {json.dumps(machine)}, {seconds}); }})")
        return [(one["time_s"], one["detail"]) for one in result["chosen"]], result["shown"]

    def test_a_slow_machine_steps_down_until_the_picture_moves(self):
        for full_ms in (1000, 2000, 4000, 6000):
            with self.subTest(full_ms=full_ms):
                chosen, shown = self.simulate(120, full_ms=full_ms, fixed_ms=20)
                self.assertLess(chosen[-1][0], SETTLED_S)
                self.assertGreaterEqual(rate(shown, SETTLED_S, 120), WANTED_HZ)

    def test_a_slow_machine_keeps_the_most_detail_that_moves(self):
        # 1280 ms at full detail: 80 ms at a quarter, 157 ms at the next more.
        chosen, _ = self.simulate(120, full_ms=1280, fixed_ms=5)
        self.assertEqual(chosen[-1][1], 0.25)

    def test_a_fast_machine_steps_up_to_full_detail(self):
        chosen, shown = self.simulate(60, full_ms=40)
        self.assertLess(chosen[-1][0], SETTLED_S)
        self.assertEqual(chosen[-1][1], 1)
        self.assertGreaterEqual(rate(shown, SETTLED_S, 60), WANTED_HZ)

    def test_a_noisy_rate_does_not_flap(self):
        for full_ms in (800, 1000, 1200, 1400, 1600):
            with self.subTest(full_ms=full_ms):
                chosen, shown = self.simulate(900, full_ms=full_ms, noise=0.5, stall=0.01)
                late = [time_s for time_s, _ in chosen if time_s > 60]
                self.assertLessEqual(len(late), 12, chosen)  # six tries in a quarter of an hour
                self.assertGreaterEqual(rate(shown, 60, 900), WANTED_HZ)

    def test_a_machine_that_was_busy_for_a_while_gets_its_detail_back(self):
        chosen, shown = self.simulate(
            150, full_ms=60, changes=[[30, {"full_ms": 3000}], [60, {"full_ms": 60}]])
        self.assertGreaterEqual(rate(shown, 30 + SETTLED_S, 60), WANTED_HZ)
        self.assertEqual(chosen[-1][1], 1)
        self.assertLess(chosen[-1][0], 90)

    def test_a_slow_publisher_does_not_cost_detail(self):
        for published_hz in (0.2, 1, 5):
            with self.subTest(published_hz=published_hz):
                chosen, _ = self.simulate(120, full_ms=60, published_hz=published_hz)
                self.assertEqual(chosen[-1][1], 1)
                self.assertEqual(len(chosen), 2, chosen)

    def test_a_picture_that_stands_still_is_shown_in_full_detail(self):
        for full_ms in (60, 1280, 6000):
            with self.subTest(full_ms=full_ms):
                chosen, shown = self.simulate(60, full_ms=full_ms, pause=[0.1, 1000])
                self.assertEqual(len(chosen), 2, chosen)
                self.assertEqual(chosen[-1][1], 1)
                self.assertLess(chosen[-1][0], 5)
                self.assertEqual(shown[-1]["detail"], 1)

    def test_a_picture_that_stands_is_sharp_within_2_s_whatever_was_tried_before(self):
        # Half a minute of a busy machine makes more detail fail, so that it is held for long.
        chosen, shown = self.simulate(
            400, full_ms=400, fixed_ms=20, pause=[300, 1000],
            changes=[[at, {"full_ms": full_ms}] for at in range(20, 300, 40)
                     for at, full_ms in ((at, 6000), (at + 20, 400))])
        raises = [time_s for time_s, detail in chosen if time_s > 300 and detail == 1]
        self.assertEqual(len(raises), 1, chosen)
        sharp = next(atlas["time_s"] for atlas in shown
                     if atlas["time_s"] > 300 and atlas["detail"] == 1)
        self.assertLess(sharp, 302)

    def test_who_moves_again_after_a_pause_gets_back_the_detail_that_moves(self):
        chosen, shown = self.simulate(120, full_ms=1280, pause=[40, 70])
        late = [(time_s, detail) for time_s, detail in chosen if time_s > 30]
        self.assertEqual([detail for _, detail in late], [1, 0.25], chosen)
        self.assertLess(late[0][0], 40 + 4)
        self.assertLess(late[1][0], 70 + 6)
        self.assertGreaterEqual(rate(shown, 80, 120), WANTED_HZ)

    def test_what_moved_before_a_still_picture_is_forgotten_once_more_detail_moves(self):
        chosen, _ = self.simulate(
            60, full_ms=60, pause=[0.1, 10], changes=[[30, {"full_ms": 160}]])
        late = [detail for time_s, detail in chosen if time_s > 10]
        self.assertEqual(late[:1], [0.7], chosen)

    def test_a_server_that_serves_others_between_is_not_taken_to_stand_still(self):
        # An atlas is made in 40 ms, and comes every 4 s.
        chosen, _ = self.simulate(120, full_ms=320, fixed_ms=20, others_ms=4000)
        self.assertLessEqual(len(chosen), 8, chosen)

    def test_detail_that_costs_nothing_is_not_given_away(self):
        # Whatever the detail, building takes too long for a moving picture.
        chosen, _ = self.simulate(60, full_ms=500, fixed_ms=300)
        self.assertEqual(chosen, [(0, 0.25)])


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
