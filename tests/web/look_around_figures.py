# SPDX-License-Identifier: Apache-2.0
"""Measures what tests/performance.md keeps about looking around, with the built-in scene:

    look_around_figures.py VIEWLOOMD VIEWLOOM [--seconds 10] [--gpu]

pictures a second, their height and motion to picture while the pointer moves sideways, and while it
turns about the scene; the height of the first picture, and how soon one that stands is sharp; bytes
of compact depth; and pictures a second of the least size that one viewer gets in free motion where
no browser takes time. Prints JSON. --gpu: lets the browser use one, and reprojection with it."""
import argparse
import json
import math
import re
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import browser as chromium
from web_client import WebSocket, asked

WARM_UP_MAX_S = 120
STAGE = "document.getElementById('stage')"
# Every picture that came to be seen: when, and how high.
RECORD = """
window.pictures = [];
const Real = WebSocket;
window.WebSocket = class extends Real {
  send(text) {
    if (text.startsWith('{"shown"')) pictures.push({ms: performance.now(), height: lastHeight});
    super.send(text);
  }
};
const parse = JSON.parse;
window.lastHeight = 0;
JSON.parse = (text) => {
  const value = parse(text);
  if (value?.layout?.tile_size) window.lastHeight = value.layout.tile_size.height;
  return value;
};"""


class Live:
    def __init__(self, server, client):
        self.log = tempfile.NamedTemporaryFile("w+")
        self.server = subprocess.Popen(
            [server, "serve", "--http.address", "127.0.0.1:0", "--grpc.address", "127.0.0.1:0"],
            stdout=subprocess.PIPE, stderr=self.log, text=True)
        line = self.server.stdout.readline()
        grpc, self.url, port = re.search(r"grpc=\S+:(\d+) http=(\S+:(\d+)/)", line).groups()
        self.port = int(port)
        self.publisher = subprocess.Popen(
            [client, "publish", "--synthetic", "--stream", "demo", "--server",
             f"127.0.0.1:{grpc}"], stdout=subprocess.DEVNULL)

    def __enter__(self):
        return self

    def wait_until_warm(self):
        """Until the server has compiled the kernels of likely displays, or that took too long."""
        end = time.monotonic() + WARM_UP_MAX_S
        while "compiled" not in Path(self.log.name).read_text() and time.monotonic() < end:
            time.sleep(0.5)

    def __exit__(self, *_):
        for process in (self.publisher, self.server):
            process.terminate()
            process.wait()
        self.log.close()


class Page:
    def __init__(self, page, url):
        self.page = page
        page.call("Page.addScriptToEvaluateOnNewDocument", source=RECORD)
        page.reduce_motion()
        page.open(url + "?stream=demo")
        page.wait_for("window.pictures?.length > 0")
        self.first_height = page.evaluate("pictures[0].height")
        self.box = page.evaluate(f"(r => [r.x, r.y, r.width, r.height])"
                                 f"({STAGE}.getBoundingClientRect())")

    def point(self, share, height_share=0.5):
        left, top, width, height = self.box
        return left + share * width, top + height_share * height

    def move(self, seconds, at, **mouse):
        """Moves the pointer along at(time_s), 60 times a second; the pictures meanwhile."""
        self.page.evaluate("pictures.length = 0")
        begin = time.monotonic()
        while (now := time.monotonic() - begin) < seconds:
            self.page.mouse(*self.point(*at(now)), **mouse)
            time.sleep(1 / 60)
        heights = self.page.evaluate("pictures.map(({height}) => height)")
        return {"pictures_per_s": round(len(heights) / seconds, 1),
                "median_height_px": statistics.median(heights) if heights else None,
                "least_height_px": min(heights, default=None),
                "motion_to_picture": self.latency()}

    def turn(self, seconds):
        """Turns about the scene; what move() gives."""
        self.page.mouse(*self.point(0.5), kind="mousePressed", button="left", buttons=1,
                        clickCount=1)
        moved = self.move(seconds, lambda s: (0.5 + 0.2 * math.sin(2 * math.pi * 0.3 * s),
                                              0.5 + 0.1 * math.sin(2 * math.pi * 0.4 * s)),
                          button="left", buttons=1)
        self.page.mouse(*self.point(0.5), kind="mouseReleased", button="left", clickCount=1)
        return moved

    def warm_up(self):
        """Turns until the server has compiled what else that needs; then the eye is back."""
        end = time.monotonic() + WARM_UP_MAX_S
        while self.turn(2)["pictures_per_s"] < 3 and time.monotonic() < end:
            pass
        self.page.evaluate(f"{STAGE}.focus()")
        self.page.key("0")
        time.sleep(1)

    def latency(self):
        text = self.page.evaluate("document.getElementById('facts').textContent")
        found = re.search(r"\d+ ms: \d+ to the server, .* back", text)
        return found.group() if found else "unknown"

    def sharp_after_ms(self):
        """From now until a picture of full height is seen."""
        begin = self.page.evaluate("performance.now()")
        full = f"pictures.find(p => p.ms >= {begin} && p.height >= {self.first_height})"
        sharp = self.page.evaluate(f"pictures.at(-1).height >= {self.first_height}")
        return 0 if sharp else round(self.page.wait_for(f"({full})?.ms") - begin)


def eye_viewer(port, width, height):
    display = {"stereo": {"layout": "STEREO_LAYOUT_SINGLE", "tracked": True,
                          "eye_size": {"width": width, "height": height}}}
    encoding = {"with_depth": True, "planes": "BAND_ENCODING_COMPACT_DEPTH"}
    return WebSocket(port, "/ws?" + asked(display, encoding, stream="demo"))


def send_pose(viewer, pose):
    viewer.send_json({"eye_poses": {"time_ns": str(time.monotonic_ns()), "eyes": [{"pose": pose}]}})


def free_alone(port, seconds):
    """The floor of free motion: a view of 360 px of height, and nobody beside the server."""
    viewer = eye_viewer(port, 640, 360)
    viewer.shown(viewer.receive_atlas())
    begin, traced_ms = time.monotonic(), []
    while (now := time.monotonic() - begin) < seconds:
        yaw = 0.3 * math.sin(2 * math.pi * 0.3 * now)
        send_pose(viewer, {"position": {"x": 2 * math.sin(yaw), "z": 1 - math.cos(yaw)},
                           "orientation": {"w": math.cos(yaw / 2), "y": math.sin(yaw / 2)}})
        atlas = viewer.receive_atlas()
        viewer.shown(atlas)
        traced_ms.append(atlas.header["times"]["trace_ns"] * 1e-6)
    viewer.close()
    return {"pictures_per_s": round(len(traced_ms) / seconds, 1),
            "trace_ms": round(statistics.median(traced_ms))}


def depth_figures(port):
    viewer = eye_viewer(port, 1280, 720)
    sizes = []
    for index in range(10):
        atlas = viewer.receive_atlas()
        viewer.shown(atlas)
        sizes.append((len(atlas.depth), len(atlas.jpeg)))
        send_pose(viewer, {"position": {"x": 0.02 * index}})
    viewer.close()
    depth, jpeg = (statistics.mean(column) for column in zip(*sizes))
    return {"size": "1280x720", "depth_bytes": round(depth), "jpeg_bytes": round(jpeg),
            "depth_mbit_per_s_at_20_hz": round(depth * 8 * 20 / 1e6, 2)}


def measure(arguments):
    if arguments.gpu:
        chromium.FLAGS = tuple(flag for flag in chromium.FLAGS if flag != "--disable-gpu")
    with Live(arguments.server, arguments.client) as live, \
            chromium.Browser(1440, 900) as page:
        live.wait_until_warm()
        page.open(live.url + "api/streams")
        page.wait_for("fetch('/api/streams').then(r => r.json()).then("
                      "j => j.streams.some(s => s.frame_number > 0))")
        shown = Page(page, live.url)
        figures = {"first_height_px": shown.first_height}
        shown.warm_up()
        figures["sideways"] = shown.move(
            arguments.seconds, lambda s: (0.5 + 0.4 * math.sin(2 * math.pi * 0.3 * s),))
        figures["sharp_after_ms"] = shown.sharp_after_ms()
        figures["free"] = shown.turn(arguments.seconds)
        figures["free_sharp_after_ms"] = shown.sharp_after_ms()
        page.open("about:blank")
        figures["free_without_a_browser"] = free_alone(live.port, arguments.seconds)
        figures["depth"] = depth_figures(live.port)
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("server")
    parser.add_argument("client")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--gpu", action="store_true")
    print(json.dumps(measure(parser.parse_args()), indent=2))


if __name__ == "__main__":
    main()
