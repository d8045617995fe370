# SPDX-License-Identifier: Apache-2.0
"""Where panel mode gets a calibration from: the drop zone, a file, or the Bridge of this machine.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import json
import sys
import unittest

from browser import Browser
from fake_bridge import FakeBridge, MONITOR, PORTRAIT
from page_test import PageTest, SMALL, keep
from panel_formula import PORTRAIT as CALIBRATION
from panel_formula import edited
from web_client import Server, fetch

STATE = "document.getElementById('panel-state').textContent"
DROP = "document.getElementById('drop')"


def panel(name, **fields):
    return {**PORTRAIT, "hwid": name,
            "calibration": json.dumps(edited(CALIBRATION, serial=name, **fields))}


class BridgePanel(PageTest):
    def setUp(self):
        self.server = Server(PROGRAM)
        self.addCleanup(lambda: self.server.__exit__())
        self.bridge = FakeBridge(displays=(MONITOR, panel("LKG-P1")))
        self.addCleanup(lambda: self.bridge.ended.is_set() or self.bridge.stop())
        # The page asks at Bridge's own port, whatever else runs on this machine.
        port = self.bridge.server_address[1]
        self.browser = Browser(
            flags=(f"--host-resolver-rules=MAP localhost:33334 127.0.0.1:{port}",))
        self.addCleanup(self.browser.close)
        self.browser.reduce_motion()

    def open_panel(self):
        self.open(SMALL + "&mode=panel")
        self.browser.wait_for(f"!{DROP}.hidden")

    def ask(self):
        self.browser.click("#ask-bridge")
        self.browser.wait_for("!document.getElementById('ask-bridge').disabled")

    def state(self):
        return self.browser.evaluate(STATE)

    def test_the_drop_zone_says_where_the_file_is_and_takes_it(self):
        self.open_panel()
        text = self.browser.evaluate(f"{DROP}.innerText")
        for words in ("Drop visual.json here", "LKG_calibration", "USB", "Bridge"):
            self.assertIn(words, text)
        keep(self.browser.screenshot(), "drop_zone")
        self.browser.evaluate("document.dispatchEvent(new DragEvent('dragover'))")
        self.assertEqual(self.browser.evaluate("document.documentElement.dataset.drag"), "over")
        self.browser.evaluate("document.dispatchEvent(new DragEvent('dragleave'))")
        self.assertFalse(self.browser.evaluate("'drag' in document.documentElement.dataset"))
        self.browser.evaluate(
            "(file => { const drop = new DataTransfer(); drop.items.add(file); "
            "document.dispatchEvent(new DragEvent('drop', {dataTransfer: drop})); })"
            f"(new File([{json.dumps(json.dumps(CALIBRATION))}], 'visual.json'))")
        self.browser.wait_for(f"{DROP}.hidden && {STATE}.includes('Move this window')")
        self.browser.click("#other-panel")  # and another one can be dropped
        self.browser.wait_for(f"!{DROP}.hidden")

    def test_a_file_that_is_none_is_named(self):
        self.open_panel()
        self.browser.evaluate(
            "(file => { const drop = new DataTransfer(); drop.items.add(file); "
            "document.dispatchEvent(new DragEvent('drop', {dataTransfer: drop})); })"
            "(new File(['{}'], 'other.json'))")
        self.browser.wait_for(f"{STATE}.startsWith('other.json: pitch: is missing')")
        self.assertFalse(self.browser.evaluate(f"{DROP}.hidden"))

    def test_bridge_gives_the_calibration_and_is_left_again(self):
        self.open_panel()
        self.ask()
        self.browser.wait_for(f"{DROP}.hidden && {STATE}.includes('1536 × 2048')")
        self.assertEqual(self.bridge.names(), ["enter_orchestration", "available_output_devices",
                                               "exit_orchestration"])
        self.open(SMALL + "&mode=panel")  # it is kept for the next visit
        self.assertTrue(self.browser.evaluate(f"{DROP}.hidden"))
        self.assertEqual(self.browser.messages + self.browser.errors, [])

    def test_of_several_panels_each_can_be_chosen(self):
        self.bridge.displays = (panel("LKG-P1"), panel("LKG-P2", screenW=333, screenH=444, DPI=80))
        self.open_panel()
        self.ask()
        self.browser.wait_for(f"{STATE}.includes('1536 × 2048')")
        self.browser.evaluate(
            "(s => { s.selectedIndex = 1; s.dispatchEvent(new Event('change')); })"
            "(document.getElementById('bridge-panel'))")
        self.browser.wait_for(f"{DROP}.hidden && {STATE}.includes('333 × 444')")

    def test_says_in_one_sentence_what_keeps_bridge_from_it(self):
        self.open_panel()
        for answers, displays, words in (
                ({}, (MONITOR,), "Bridge finds no panel"),
                ({}, (panel("LKG-P1", pitch=0),), "LKG-P1: pitch: is 0"),
                ({"available_output_devices": b""}, (), "0 bytes that are no answer of Bridge"),
                ({"enter_orchestration": b"<html>"}, (), "6 bytes that are no answer of Bridge"),
                ({"enter_orchestration": (500, b"{}")}, (), "with status 500")):
            with self.subTest(words):
                self.bridge.answers, self.bridge.displays = answers, displays
                self.ask()
                self.assertIn(words, self.state())
        self.bridge.answers = {"enter_orchestration": None}  # silence
        self.ask()
        self.assertIn("No Bridge answers at http://localhost:33334", self.state())

    def test_without_a_bridge_the_file_is_asked_for(self):
        self.open_panel()
        self.bridge.stop()
        self.ask()
        self.assertIn("No Bridge answers at http://localhost:33334", self.state())
        self.assertIn("Drop visual.json", self.state())
        self.assertFalse(self.browser.evaluate(f"{DROP}.hidden"))

    def test_the_policy_names_bridge_and_no_other_address(self):
        policy = fetch(self.server.port, "/").headers["content-security-policy"]
        self.assertIn("connect-src 'self' http://localhost:33334;", policy)
        self.assertEqual(policy.count("http"), 1)
        self.open_panel()
        with self.assertRaises(RuntimeError):
            self.browser.evaluate("fetch('http://localhost:33335/')")


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["BridgePanel"])])
