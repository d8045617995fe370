# SPDX-License-Identifier: Apache-2.0
"""Files of the reader's own that documents name, such as render.exr: a ball before a wall."""

import base64
import io
import json

import numpy as np
from PIL import Image

import exr_files

WIDTH_PX, HEIGHT_PX = 160, 120
# Millimetres in the first and in the last row of each depth of photo.png.
PHOTO_MM = {"photo_depth.png": (2647, 1500), "photo_mm.png": (3900, 1150)}
# A panel as Looking Glass describes it, with the size of the monitor of the tests.
SCREEN_PX = (1536, 2048)


def ball():
    """uint8[height][width][3] and metres."""
    y, x = np.mgrid[0:HEIGHT_PX, 0:WIDTH_PX]
    is_ball = np.hypot(x - WIDTH_PX / 2, y - HEIGHT_PX / 2) < HEIGHT_PX / 4
    color = np.stack([np.where(is_ball, 220, 60), 40 + y, 220 - x], axis=-1).astype(np.uint8)
    return color, np.where(is_ball, 1.5, 3).astype(np.float32)


def write_png(path, array):
    Image.fromarray(array).save(path)


def write_pfm(path, depth_m):
    height, width = depth_m.shape
    path.write_bytes(b"Pf\n%d %d\n-1.0\n" % (width, height)
                     + depth_m[::-1].astype("<f4").tobytes())


def write_render(path):
    color, depth_m = ball()
    light = (color / 255.0) ** 2.2
    exr_files.write_flat(path, {"R": light[..., 0], "G": light[..., 1], "B": light[..., 2],
                                "Z": depth_m})


def write_deep_render(path):
    """Six panes of glass before a wall, so that four layers have to merge some."""
    planes = {name: np.zeros((HEIGHT_PX, WIDTH_PX, 7)) for name in "RGBAZ"}
    for sample in range(7):
        alpha = 1.0 if sample == 6 else 0.3
        planes["A"][..., sample] = alpha
        planes["Z"][..., sample] = 1 + 0.4 * sample
        planes["RGB"[sample % 3]][..., sample] = alpha
    exr_files.write_deep(path, planes)


def write_portrait_photo(path):
    """JPEG with a depth map inside (GDepth), under the name that phones give."""
    color, depth_m = ball()
    near_m, far_m = depth_m.min(), depth_m.max()
    code = np.round(255 * (depth_m - near_m) / (far_m - near_m)).astype(np.uint8)
    picture, inside = io.BytesIO(), io.BytesIO()
    Image.fromarray(color).save(picture, "JPEG")
    Image.fromarray(code).save(inside, "PNG")
    name = "http://ns.google.com/photos/1.0/depthmap/"
    data = base64.b64encode(inside.getvalue()).decode()
    xmp = ("http://ns.adobe.com/xap/1.0/\0<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
           "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description "
           f"xmlns:GDepth=\"{name}\" GDepth:Format=\"RangeLinear\" GDepth:Near=\"{near_m}\" "
           f"GDepth:Far=\"{far_m}\" GDepth:Mime=\"image/png\" GDepth:Data=\"{data}\"/>"
           "</rdf:RDF></x:xmpmeta>").encode()
    jpeg = picture.getvalue()
    path.write_bytes(jpeg[:2] + b"\xff\xe1" + (len(xmp) + 2).to_bytes(2, "big") + xmp + jpeg[2:])


def write_manifests(folder):
    """FRAME.json, DISPLAY.json and TRUTH.json of `viewloom render`."""
    camera = {"intrinsics": {"focalXPx": 160, "focalYPx": 160, "principalXPx": WIDTH_PX / 2,
                             "principalYPx": HEIGHT_PX / 2}}
    layer = {"color": {"file": "frames/color_0.png"}, "depth": {
        "file": "frames/depth_0.pfm", "depth": {"meaning": "DEPTH_MEANING_PLANAR"}}}
    files = {
        "FRAME.json": {"sources": [{"camera": camera, "layers": [layer]}]},
        "DISPLAY.json": {"cameras": {"tileSize": {"width": WIDTH_PX, "height": HEIGHT_PX},
                                     "cameras": [camera]}},
        "TRUTH.json": {"views": [{"viewIndex": 0, "color": {"file": "frames/color_0.png"}}]}}
    for name, content in files.items():
        (folder / name).write_text(json.dumps(content), encoding="utf-8")


def write_calibration(path):
    values = {"pitch": 52.58, "slope": -7.15, "center": 0.5, "viewCone": 40, "invView": 1,
              "DPI": 324, "screenW": SCREEN_PX[0], "screenH": SCREEN_PX[1], "flipImageX": 0,
              "flipImageY": 0, "flipSubp": 0}
    path.write_text(json.dumps({"configVersion": "3.0", "serial": "LKG-P02283", **{
        name: {"value": value} for name, value in values.items()}}), encoding="utf-8")


def write_all(folder):
    """Everything into the folder in which a document's commands start."""
    color, depth_m = ball()
    for name in ("frames", "renders"):
        (folder / name).mkdir()
    for name in ("render.exr", "render.0001.exr", "frame.exr", "renders/shot.0001.exr"):
        write_render(folder / name)
    write_deep_render(folder / "comp.exr")
    write_portrait_photo(folder / "IMG_0001.HEIC")
    for name, ends in PHOTO_MM.items():
        ramp_mm = np.linspace(*ends, 480).round().astype(np.uint16)
        write_png(folder / name, np.repeat(ramp_mm[:, None], 640, axis=1))
    grey = np.random.default_rng(1).integers(0, 256, (480, 640, 1), np.uint8)
    write_png(folder / "photo.png", np.repeat(grey, 3, axis=2))
    for number in ("", "_0", "_1", "_2"):
        write_png(folder / f"color{number}.png", color)
        write_png(folder / f"depth{number}.png", (1000 * depth_m).astype(np.uint16))
    for number in range(2):
        write_png(folder / "frames" / f"color_{number}.png", color)
        for place in (folder, folder / "frames"):
            write_pfm(place / f"depth_{number}.pfm", depth_m)
    write_manifests(folder)
    write_calibration(folder / "visual.json")
    (folder / "tracked.json").write_text(json.dumps({"stereo": {
        "eyeSize": {"width": 320, "height": 180}, "focalDistanceM": 0.6, "tracked": True}}),
        encoding="utf-8")
