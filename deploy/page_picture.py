#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/page.jpg: the viewer page in headless Chromium, with the portrait scene that stands.

    deploy/page_picture.py build/release/server/viewloomd build/release/client/cli/viewloom \\
        deploy/page.jpg
"""

import pathlib
import sys

from studio import PORTRAIT, make_picture

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "tests" / "web"))
from browser import Browser  # noqa: E402  (the tests of the page drive the same browser)

WINDOW_PX = (1440, 900)
QUERY = "?stream=portrait&preset=portrait"
STILL = "document.getElementById('brief').textContent === 'still'"
SHARP = "document.getElementById('reduced').hidden"


def shot(studio):
    with Browser(*WINDOW_PX) as browser:
        browser.reduce_motion()  # the eye stands in the middle
        browser.open(studio.page + QUERY)
        browser.wait_for(f"{STILL} && {SHARP}")
        return browser.screenshot()


if __name__ == "__main__":
    make_picture(__doc__, {"portrait": PORTRAIT}, shot)
