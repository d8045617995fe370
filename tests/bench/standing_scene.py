#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How soon the viewer page is sharp when the portrait scene stands, and how many pictures a second
it shows while the scene and the pointer move: with publisher, server and browser on this machine,
as deploy/demo.sh has them. Arguments: viewloomd, viewloom. Prints one line a rest, and judges none.
"""

import argparse
import json
import math
import pathlib
import statistics
import sys
import time

import serving

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "web"))
from browser import Browser  # noqa: E402  (it lies beside the tests of the page)

LOOP_S = 20
MOVING_S = 15
# Log of the page's drawings: when, of which frame, how wide a view is, px, and whether the page
# calls them reduced.
WATCH = """
window.drawn = [];
const headers = new Map();
const parse = JSON.parse;
JSON.parse = (text) => {
  const value = parse(text);
  if (value?.layout) headers.set(String(value.sequence), value);
  return value;
};
let newest;
const sample = () => {
  const {sequence} = document.documentElement.dataset;
  const header = headers.get(sequence);
  if (header && newest !== sequence) {
    const {layout, frame_number} = header;
    drawn.push({time_ms: performance.timeOrigin + performance.now(), frame: Number(frame_number),
                width_px: layout.tile_size.width,
                is_sharp: document.getElementById('reduced').hidden});
    newest = sequence;
  }
  requestAnimationFrame(sample);
};
requestAnimationFrame(sample);"""


def move_until(browser, end_s):
    """The pointer to and fro over the picture, once every two seconds, and then it rests."""
    left, top, width, height = browser.evaluate(
        "(r => [r.x, r.y, r.width, r.height])"
        "(document.getElementById('stage').getBoundingClientRect())")
    while (now_s := time.time()) < end_s:
        share = 0.5 + 0.3 * math.sin(math.pi * now_s)
        browser.mouse(left + share * width, top + height / 2)
        time.sleep(1 / 60)


def one_rest(browser, begin_s, rest):
    """The pointer stops when the scene does. Seconds from then to the sharp picture."""
    stood_s = begin_s + rest * LOOP_S + MOVING_S
    time.sleep(max(0.0, stood_s - 8 - time.time()))
    browser.evaluate("drawn.length = 0")
    moving_s = time.time()
    move_until(browser, stood_s)
    time.sleep(max(0.0, stood_s + LOOP_S - MOVING_S - 0.5 - time.time()))
    drawn = browser.evaluate("drawn")
    moving = [one for one in drawn if one["time_ms"] / 1000 < stood_s]
    after = [one for one in drawn if one["time_ms"] / 1000 >= stood_s]
    sharp = [one for one in after if one["is_sharp"]]
    def since_s(one):
        return one["time_ms"] / 1000 - stood_s
    return {"pictures/s": len(moving) / (stood_s - moving_s),
            "moving width px": statistics.median([one["width_px"] for one in moving] or [0]),
            "sharp width px": sharp[0]["width_px"] if sharp else 0,
            "sharp after s": since_s(sharp[0]) if sharp else math.nan,
            "last change after s": since_s(after[-1]) if after else math.nan}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("viewloomd")
    parser.add_argument("viewloom")
    parser.add_argument("--frames", default="600x800", help="size of the frames")
    parser.add_argument("--rate", default="15", help="frames a second")
    parser.add_argument("--window", default="1280x800", help="size of the browser, px")
    parser.add_argument("--mirrors", action="store_true")
    parser.add_argument("--rests", type=int, default=3)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    server = serving.Server(arguments)
    browser = Browser(*map(int, arguments.window.split("x")))
    try:
        mirrors = ["--mirrors"] if arguments.mirrors else []
        begin_s = time.time()
        server.start("publish", "--synthetic", "--scene", "portrait", "--size", arguments.frames,
                     "--rate", arguments.rate, "--stream", "demo", *mirrors)
        browser.call("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
        effects = {"effects": {"reflection": {}}} if arguments.mirrors else {}
        display = json.dumps({"preset": "portrait", **effects})
        browser.open(f"{server.url}?stream=demo&display={display}")
        browser.wait_for("window.drawn?.length > 0")
        rests = [one_rest(browser, begin_s, rest) for rest in range(arguments.rests)]
    finally:
        browser.close()
        server.stop()
    if arguments.json:
        print(json.dumps(rests))
        return
    for one in rests:
        print("  ".join(f"{name} {value:.2f}" for name, value in one.items()))


if __name__ == "__main__":
    main()
