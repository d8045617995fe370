# SPDX-License-Identifier: Apache-2.0
"""What a panel has to show, computed in binary64 from its calibration, without viewloom."""

import math

import numpy

# Two views share the border between them; a coordinate this near to one may round to either.
BORDER = 1e-5


def value(calibration, key, default=0.0):
    found = calibration.get(key, default)
    return found["value"] if isinstance(found, dict) else found


def panel_size_px(calibration):
    return int(value(calibration, "screenW")), int(value(calibration, "screenH"))


def offsets(calibration, columns, rows, channel):
    """Of a channel from the centre of its px, in widths and heights of the panel.

    rows count from the bottom.
    """
    width, height = panel_size_px(calibration)
    if value(calibration, "flipSubp") >= 0.5:
        channel = 2 - channel
    cells = calibration.get("subpixelCells", [])
    if not cells:
        flip = -1 if value(calibration, "flipImageX") >= 0.5 else 1
        return flip * channel / (3 * width), 0.0
    mode = int(value(calibration, "CellPatternMode"))
    index = [0 * columns + 0 * rows, (columns + rows) % 2, columns % 2 + 0 * rows,
             (rows + 2 * (columns % 2)) % 4, rows % 2 + 0 * columns][mode] % len(cells)
    name = "RGB"[channel]
    across = numpy.array([cell[name + "OffsetX"] for cell in cells])
    upwards = numpy.array([cell[name + "OffsetY"] for cell in cells])
    return across[index] / width, upwards[index] / height


def view_coordinates(calibration):
    """float64[height][width][3], top row first: where among the views each subpixel lies, 0..1."""
    width, height = panel_size_px(calibration)
    slope = value(calibration, "slope")
    lenses = value(calibration, "pitch") * width / value(calibration, "DPI") \
        * math.cos(math.atan(1 / slope))
    flip = -1 if value(calibration, "flipImageX") >= 0.5 else 1
    tilt = height / (width * slope) * flip
    columns = numpy.arange(width)[None, :]
    rows = numpy.arange(height)[::-1, None]
    across = (columns + 0.5) / width
    upwards = (rows + 0.5) / height
    coordinates = numpy.empty((height, width, 3))
    for channel in range(3):
        right, up = offsets(calibration, columns, rows, channel)
        phase = ((across + right) + (upwards + up) * tilt) * lenses - value(calibration, "center")
        z = phase - numpy.floor(phase)
        coordinates[:, :, channel] = 1 - z if value(calibration, "invView", 1) >= 0.5 else z
    return coordinates


def resized(view, width, height):
    """A view of float64[h][w][3] at the centres of width x height px, bilinear, borders go on."""
    def taps(count, size):
        at = numpy.clip((numpy.arange(count) + 0.5) / count * size, 0.5, size - 0.5) - 0.5
        lower = numpy.minimum(at.astype(int), size - 1)
        return lower, numpy.minimum(lower + 1, size - 1), at - lower

    left, right, share_x = taps(width, view.shape[1])
    top, bottom, share_y = taps(height, view.shape[0])
    share_x, share_y = share_x[None, :, None], share_y[:, None, None]
    along_rows = view[:, left] * (1 - share_x) + view[:, right] * share_x
    return along_rows[top] * (1 - share_y) + along_rows[bottom] * share_y


def pick(views, size_px, *choices):
    """For each choice[h][w][3] of views, each subpixel of the view that it names."""
    picked = [numpy.empty(choice.shape, numpy.float32) for choice in choices]
    for index, view in enumerate(views):
        picture = resized(view, *size_px)  # one at a time: a panel's 48 views would fill 10 GB
        for choice, into in zip(choices, picked):
            numpy.copyto(into, picture, where=choice == index, casting="same_kind")
    return picked


def woven(calibration, views, is_blended):
    """Two pictures of float[height][width][3]: what has to be shown, and what else may be."""
    size_px, count = panel_size_px(calibration), len(views)
    coordinates = view_coordinates(calibration)
    if not is_blended:
        position = coordinates * count
        border = numpy.round(position)
        is_near = numpy.abs(position - border) < BORDER * count
        nearest = numpy.floor(position).astype(int) % count
        below, above = (border - 1).astype(int) % count, border.astype(int) % count
        other = numpy.where(is_near, numpy.where(nearest == below, above, below), nearest)
        return pick(views, size_px, nearest, other)
    position = numpy.clip(coordinates * count - 0.5, 0, count - 1)
    lower = position.astype(int)
    upper = numpy.minimum(lower + 1, count - 1)
    # From the last view to the first, where lens follows lens.
    is_near = numpy.minimum(coordinates, 1 - coordinates) < BORDER
    ends = numpy.where(coordinates < 0.5, count - 1, 0)
    below, above, end = pick(views, size_px, lower, upper, ends)
    shown = below + (above - below) * (position - lower)
    return shown, numpy.where(is_near, end, shown)


def wrong_subpixels(screen, shown, other, tolerance):
    """How many subpixels of the screen are neither what has to be shown nor what may be."""
    is_wrong = numpy.abs(screen - shown) > tolerance
    is_wrong &= numpy.abs(screen - other) > tolerance
    return int(is_wrong.sum())
