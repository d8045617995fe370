#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How soon the viewer page shows a sharp picture, and how many a second while the pointer moves:
with publisher, server and browser on this machine, as a new user has them.
Arguments: viewloomd, viewloom. Prints the figures, as text or with --json, and judges none."""

import argparse
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "web"))
from browser import Browser  # noqa: E402  (it lies beside the tests of the page)

SIZES = {"desktop": (1280, 800, 1, False), "phone": (390, 844, 2, True)}
SHARP_PX = 360  # of a view's width
# Log of the page's drawings: when, how many px a view has, and which view it is.
WATCH = """
window.drawn = [];
const sample = () => {
  const canvas = document.getElementById('stage');
  const sequence = document.documentElement.dataset.sequence;
  const view = canvas?.dataset.view;
  const last = drawn.at(-1);
  if (sequence && (last?.sequence !== sequence || last?.view !== view)) {
    drawn.push({time_ms: performance.now(), sequence, view, width_px: window.tile_px ?? 0});
  }
  requestAnimationFrame(sample);
};
requestAnimationFrame(sample);
const parse = JSON.parse;
JSON.parse = (text) => {
  const value = parse(text);
  if (value?.layout) window.tile_px = value.layout.tile_size.width;
  return value;
};"""


class Server:
    def __init__(self, arguments):
        self.process = subprocess.Popen(
            [arguments.viewloomd, "serve", "--http.address", "127.0.0.1:0", "--grpc.address",
             "127.0.0.1:0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        line = self.process.stdout.readline()
        grpc, self.url = re.search(r"grpc=(\S+) http=(\S+)", line).groups()
        # Small frames, such as a slow machine keeps.
        self.publisher = subprocess.Popen(
            [arguments.viewloom, "--server", grpc, "publish", "--synthetic", "--stream", "demo",
             "--size", "480x270", "--fps", "15", "--quiet"])
        time.sleep(2)

    def stop_publisher(self):
        if self.publisher.poll() is None:
            self.publisher.terminate()
            self.publisher.wait()

    def stop(self):
        self.stop_publisher()
        self.process.terminate()
        self.process.wait()
        self.process.stdout.close()


def drawn(browser):
    return browser.evaluate("drawn")


def move(browser, seconds):
    """The pointer to and fro over the picture, once every two seconds; pictures drawn meanwhile."""
    left, top, width, height = browser.evaluate(
        "(r => [r.x, r.y, r.width, r.height])"
        "(document.getElementById('stage').getBoundingClientRect())")
    browser.evaluate("drawn.length = 0")
    begin = time.monotonic()
    while (passed := time.monotonic() - begin) < seconds:
        share = 0.5 + 0.4 * math.sin(math.pi * passed)
        browser.mouse(left + share * width, top + height / 2)
        time.sleep(1 / 60)
    pictures = drawn(browser)
    return {"pictures/s": len(pictures) / passed,
            "width px": min((one["width_px"] for one in pictures), default=0)}


def sharp_s(pictures):
    times = [one["time_ms"] / 1000 for one in pictures if one["width_px"] >= SHARP_PX]
    return times[0] if times else math.nan


def one_round(arguments, size):
    width, height, scale, mobile = SIZES[size]
    server = Server(arguments)
    browser = Browser(width, height)
    try:
        browser.resize(width, height, scale=scale, mobile=mobile)
        browser.call("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
        browser.open(server.url + "?stream=demo")
        browser.wait_for("window.drawn?.length > 0")
        time.sleep(arguments.seconds)
        figures = {"sharp after s": sharp_s(drawn(browser))}
        moving = move(browser, arguments.seconds)
        figures.update({f"moving stream, {name}": value for name, value in moving.items()})
        browser.evaluate("drawn.length = 0; window.left_ms = performance.now()")
        server.stop_publisher()
        time.sleep(4)
        stood = [one["time_ms"] / 1000 for one in drawn(browser)]
        left = browser.evaluate("left_ms") / 1000
        figures["standing, last change after s"] = stood[-1] - left if stood else 0.0
        figures["standing, width px"] = browser.evaluate("tile_px")
        moving = move(browser, arguments.seconds)
        figures.update({f"standing stream, {name}": value for name, value in moving.items()})
        return figures
    finally:
        browser.close()
        server.stop()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("viewloomd")
    parser.add_argument("viewloom")
    parser.add_argument("--size", choices=sorted(SIZES), default="desktop")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=6, help="of each part of a round")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    rounds = [one_round(arguments, arguments.size) for _ in range(arguments.rounds)]
    medians = {name: statistics.median(one[name] for one in rounds) for name in rounds[0]}
    if arguments.json:
        print(json.dumps(medians))
        return
    for name, value in medians.items():
        print(f"{name:40} {value:8.2f}")


if __name__ == "__main__":
    main()
