# SPDX-License-Identifier: Apache-2.0
"""Calibrations of real devices and of none, and quilts whose every px is known."""

import numpy

from viewloom.v1 import display_pb2 as display

from fake_displays import Atlas

PORTRAIT = {
    "configVersion": "3.0", "serial": "LKG-PORT-", "pitch": {"value": 52.594383239746094},
    "slope": {"value": -7.21152925491333}, "center": {"value": 0.40277382731437683},
    "viewCone": {"value": 40}, "invView": {"value": 1}, "DPI": {"value": 324},
    "screenW": {"value": 1536}, "screenH": {"value": 2048}, "flipImageX": {"value": 0},
    "flipSubp": {"value": 0}, "subpixelCells": [], "CellPatternMode": {"value": 0}}
THIRD_GENERATION = {
    "configVersion": "3.0", "serial": "LKG-J00332", "pitch": {"value": 44.75058319896644},
    "slope": {"value": -6.874565686767793}, "center": {"value": 0.16935753461833172},
    "viewCone": {"value": 50.0}, "DPI": {"value": 283.0}, "screenW": {"value": 3840.0},
    "screenH": {"value": 2160.0}, "CellPatternMode": {"value": 2.0},
    "subpixelCells": [
        {"ROffsetX": -0.31, "ROffsetY": 0.25, "GOffsetX": 0.28, "GOffsetY": 0.25,
         "BOffsetX": 0.0, "BOffsetY": -0.25},
        {"ROffsetX": -0.31, "ROffsetY": -0.25, "GOffsetX": 0.28, "GOffsetY": -0.25,
         "BOffsetX": 0.0, "BOffsetY": 0.25}]}
# No device: small, with every switch turned the other way.
SMALL = dict(THIRD_GENERATION, serial="small", screenW=320, screenH=200, DPI=100, invView=0,
             flipImageX=1, flipSubp=1, CellPatternMode=3, slope=5.04)


def paint_views(count, width, height, seed=0):
    """float64[height][width][3] for each view: no two alike, every px its own."""
    x, y = numpy.meshgrid(numpy.arange(width), numpy.arange(height))
    views = []
    for view in range(count):
        red = view * 180 // count + x * 30 // width + y * 20 // height
        green = 250 - view * 170 // count - y * 50 // height
        blue = (view * 53 + seed) % 200 + x * 40 // width
        views.append(numpy.stack([red, green, blue], axis=2).astype(float))
    return views


def quilt_of(views, columns, padding_top_px=0, padding_right_px=0,
             order=display.TILE_ORDER_BOTTOM_LEFT):
    rows = len(views) // columns
    height, width = views[0].shape[:2]
    picture = numpy.full((rows * height + padding_top_px, columns * width + padding_right_px, 3),
                         255, numpy.uint8)
    for index, view in enumerate(views):
        row = index // columns
        if order == display.TILE_ORDER_BOTTOM_LEFT:
            row = rows - 1 - row
        top, left = padding_top_px + row * height, index % columns * width
        picture[top:top + height, left:left + width] = view
    return Atlas(picture, columns, rows, padding_top_px, padding_right_px, order)
