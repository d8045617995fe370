#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/page.jpg: the viewer page in headless Chromium, with the portrait scene that stands.

    deploy/page_picture.py build/release/server/viewloomd build/release/client/cli/viewloom \\
        deploy/page.jpg
"""

import argparse
import pathlib
import sys
import tempfile

from studio import Studio

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "tests" / "web"))
from browser import Browser  # noqa: E402  (the tests of the page drive the same browser)

WINDOW_PX = (1440, 900)
SCENE = ["--synthetic", "--scene", "portrait", "--size", "1440x1920", "--layers", "4"]
QUERY = "?stream=portrait&preset=portrait"
STILL = "document.getElementById('brief').textContent === 'still'"
SHARP = "document.getElementById('reduced').hidden"


def shot(url):
    with Browser(*WINDOW_PX) as browser:
        browser.reduce_motion()  # the eye stands in the middle
        browser.open(url + QUERY)
        browser.wait_for(f"{STILL} && {SHARP}")
        return browser.screenshot()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("viewloomd", "viewloom", "picture"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        studio = Studio(arguments, folder)
        studio.publish("portrait", *SCENE, "--seconds", "0.05", "--hold")
        try:
            picture = shot(studio.page)
        finally:
            studio.close()
    picture.save(arguments.picture, quality=85, optimize=True)


if __name__ == "__main__":
    main()
