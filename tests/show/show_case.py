# SPDX-License-Identifier: Apache-2.0
"""Set-up and clean-up of every test of `viewloom show`."""

import json
import pathlib
import tempfile
import unittest

from fake_displays import FakeDisplays
from reference_weave import wrong_subpixels
from screen import Screen, Show, wait_for

# Tolerance in 8-bit codes: the expected value, rounded.
EXACT = 0.5


class ShowTest(unittest.TestCase):
    """Starts screens, servers and `viewloom show`, and ends what it started."""

    viewloom = None  # the program

    def start_screen(self, size_px):
        screen = Screen(*size_px)
        self.addCleanup(screen.close)
        return screen

    def start_server(self, answer, **options):
        server = FakeDisplays(answer, **options)
        self.addCleanup(server.stop)
        return server

    def start_show(self, screen, server, *arguments, **options):
        show = Show(self.viewloom, screen, server.address if server else "127.0.0.1:1", *arguments,
                    **options)
        self.addCleanup(show.close)
        return show

    def calibration_file(self, calibration):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name) / "visual.json"
        path.write_text(calibration if isinstance(calibration, str) else json.dumps(calibration))
        return path

    def expect_screen(self, screen, shown, other=None, tolerance=EXACT, first_row=0):
        """The newest picture on the screen, once the window system has put it there."""
        other = shown if other is None else other
        left = [shown.size]

        def is_shown():
            left[0] = wrong_subpixels(screen.picture()[first_row:], shown, other, tolerance)
            return left[0] == 0
        try:
            wait_for(is_shown, "the picture")
        except AssertionError:
            self.fail(f"{left[0]} of {shown.size} subpixels are wrong")

    @staticmethod
    def wait_for(condition, what):
        wait_for(condition, what)
