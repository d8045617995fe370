#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How fast the page decodes and uploads Portrait atlases as H.264 and as JPEG, both in one run, in
headless Chromium. Decoding is done in the page's worker, uploading where the page draws. And how
many atlases a second the whole page shows if they come as fast as it takes them.
Arguments: viewloomd, viewloom, code_stack. Prints the figures, as text or with --json, and judges
none. With --quilts it takes pictures of 8x6 views instead of the built-in scene."""

import argparse
import base64
import io
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import urllib.parse

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngImageFile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "web"))
import coded_atlases  # noqa: E402  (it lies beside the tests of the page)
from browser import Browser  # noqa: E402

COLUMNS, ROWS = 8, 6
LIVE_S = 4
LUMA = np.array([0.299, 0.587, 0.114])


def record(arguments, folder):
    """Lossless quilts of the built-in scene, as PNG files."""
    server = subprocess.Popen(
        [arguments.viewloomd, "serve", "--http.enabled", "false", "--grpc.address", "127.0.0.1:0"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    publisher = None
    try:
        grpc = re.search(r"grpc=(\S+)", server.stdout.readline()).group(1)
        publisher = subprocess.Popen(
            [arguments.viewloom, "--server", grpc, "publish", "--synthetic", "--moving-camera",
             "--stream", "demo", "--size", "720x960", "--layers", "2", "--quiet"])
        subprocess.run(
            [arguments.viewloom, "--server", grpc, "watch", "demo", "--preset", "portrait",
             "--lossless", "--format", "png", "--count", str(arguments.atlases), "--out", folder],
            check=True, stdout=subprocess.DEVNULL, timeout=300)
    finally:
        for process in (publisher, server):
            if process is not None:
                process.terminate()
                process.wait()
        server.stdout.close()
    return sorted(pathlib.Path(folder).glob("*.png"))


def views_of(file):
    """uint8[view][y][x][3] of a quilt whose view 0 is at the bottom left."""
    # Not by Image.open, which takes large pictures for an attack.
    with open(file, "rb") as content:
        quilt = np.asarray(PngImageFile(io.BytesIO(content.read())).convert("RGB"))
    height, width = quilt.shape[0] // ROWS, quilt.shape[1] // COLUMNS
    tiles = quilt[quilt.shape[0] - ROWS * height:, :COLUMNS * width]
    tiles = tiles.reshape(ROWS, height, COLUMNS, width, 3).swapaxes(1, 2)[::-1]
    return np.ascontiguousarray(tiles.reshape(COLUMNS * ROWS, height, width, 3))


def psnr_luma(shown, quilt):
    error = (shown.astype(np.float32) - quilt) @ LUMA.astype(np.float32)
    return 10 * np.log10(255 ** 2 / float(np.mean(error ** 2)))


def pixels(browser, path, way, layout):
    data = base64.b64decode(browser.evaluate(f"picture({path!r}, {way!r})"))
    size = layout["size"]
    return np.frombuffer(data, np.uint8).reshape(size["height"], size["width"], 4)[..., :3]


def summary(rounds):
    times = [one for measured in rounds for one in measured["times"]]
    decode = statistics.median(one["decode_ms"] for one in times)
    upload = statistics.median(one["upload_ms"] for one in times)
    return {"decode ms": decode, "upload ms": upload, "one after the other, Hz":
            1000 / (decode + upload),
            "pipelined, Hz": statistics.median(measured["rate_hz"] for measured in rounds)}


def shown_hz(files, paths):
    """Atlases a second that the page shows, drawn."""
    socket = pathlib.Path(coded_atlases.HERE, "fake_socket.js").read_text(encoding="utf-8")
    with Browser() as browser:
        browser.call("Page.addScriptToEvaluateOnNewDocument", source=socket +
                     f"window.isFlood = true; window.wanted = {json.dumps(paths)};")
        color = "BAND_ENCODING_H264" if paths[0].startswith("video") else "BAND_ENCODING_JPEG"
        asked = urllib.parse.urlencode({"stream": "demo", "preset": "portrait", "mode": "quilt",
                                        "detail": "1", "encoding": json.dumps({"color": color})})
        browser.open(f"{files.url}?{asked}")
        # Both ways of uploading are measured with the first atlases.
        browser.wait_for("window.said.filter(m => m.shown).length > 8")
        return browser.evaluate(f"""new Promise((resolve) => {{
          const begun_ms = performance.now();
          const before = said.filter(m => m.shown).length;
          setTimeout(() => resolve(1000 * (said.filter(m => m.shown).length - before) /
                                   (performance.now() - begun_ms)), {1000 * LIVE_S});
        }})""")


def measure(arguments, atlases):
    layout = coded_atlases.layout_of(COLUMNS, ROWS, atlases[0])
    coded = coded_atlases.code_stacks(arguments.code_stack, atlases, arguments.qp)
    contents = dict(coded_atlases.PAGE_ANSWERS)
    for index, (views, (video, units)) in enumerate(zip(atlases, coded)):
        contents[f"video{index}"] = coded_atlases.video_message(layout, video, units)
        contents[f"jpeg{index}"] = coded_atlases.jpeg_message(layout, views)
    files = coded_atlases.PageFiles(contents)
    try:
        with Browser() as browser:
            browser.open(files.url + "video_harness.html")
            browser.wait_for("window.isReady")
            figures = {}
            quilt = coded_atlases.quilt_of(atlases[0], layout)
            for kind, way in (("JPEG", "jpeg"), ("H.264", "planes")):
                path = "jpeg0" if way == "jpeg" else "video0"
                shown = pixels(browser, path, way, layout)
                figures[kind] = {"KB": len(contents[path]) / 1000,
                                 "PSNR of luma, dB": psnr_luma(shown, quilt)}
            # The first round finds the faster way of uploading.
            rounds = {"JPEG": [], "H.264": []}
            for number in range(arguments.rounds + 1):
                for kind, name in (("JPEG", "jpeg"), ("H.264", "video")):
                    paths = json.dumps([f"{name}{index}" for index in range(len(atlases))])
                    measured = browser.evaluate(
                        f"measure({paths}, {arguments.count})")
                    if number > 0:
                        rounds[kind].append(measured)
            for kind, measured in rounds.items():
                figures[kind].update(summary(measured))
            figures["H.264"]["uploaded by"] = rounds["H.264"][-1]["times"][-1]["upload"]
        for kind, name in (("JPEG", "jpeg"), ("H.264", "video")):
            paths = [f"{name}{index}" for index in range(len(atlases))]
            figures[kind]["page, whole quilt, Hz"] = shown_hz(files, paths)
        return figures
    finally:
        files.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("viewloomd")
    parser.add_argument("viewloom")
    parser.add_argument("code_stack")
    parser.add_argument("--quilts", nargs="*", help="PNG files of 8x6 views")
    parser.add_argument("--atlases", type=int, default=3)
    parser.add_argument("--qp", type=int, default=24, help="24 has the error of JPEG 85")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--count", type=int, default=8, help="atlases of a round")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        names = arguments.quilts or record(arguments, folder)
        atlases = [views_of(name) for name in names]
    figures = measure(arguments, atlases)
    if arguments.json:
        print(json.dumps(figures))
        return
    for kind, values in figures.items():
        for name, value in values.items():
            text = value if isinstance(value, str) else f"{value:.1f}"
            print(f"{kind:8} {name:26} {text:>10}")


if __name__ == "__main__":
    main()
