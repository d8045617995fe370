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


def pick(stack, views):
    """From float64[views][h][w][3], each subpixel of the view that views[h][w][3] names."""
    return numpy.take_along_axis(stack, views[None], axis=0)[0]


def woven(calibration, views, is_blended):
    """Two pictures of float64[height][width][3]: what has to be shown, and what else may be."""
    width, height = panel_size_px(calibration)
    stack = numpy.stack([resized(view, width, height) for view in views])
    count = len(views)
    position = view_coordinates(calibration) * count
    if not is_blended:
        nearest = numpy.floor(position).astype(int) % count
        border = numpy.round(position)
        is_near = numpy.abs(position - border) < BORDER * count
        below, above = (border - 1).astype(int) % count, border.astype(int) % count
        other = numpy.where(is_near, numpy.where(nearest == below, above, below), nearest)
        return pick(stack, nearest), pick(stack, other)
    position = numpy.clip(position - 0.5, 0, count - 1)
    lower = numpy.minimum(position.astype(int), count - 1)
    upper = numpy.minimum(lower + 1, count - 1)
    share = position - lower
    shown = pick(stack, lower) * (1 - share) + pick(stack, upper) * share
    # From the last view to the first, where lens follows lens.
    coordinate = view_coordinates(calibration)
    is_near = numpy.minimum(coordinate, 1 - coordinate) < BORDER
    ends = numpy.where(coordinate < 0.5, count - 1, 0)
    return shown, numpy.where(is_near, pick(stack, ends), shown)


def wrong_subpixels(screen, shown, other, tolerance):
    """How many subpixels of the screen are neither what has to be shown nor what may be."""
    got = screen.astype(float)
    is_right = numpy.abs(got - shown) <= tolerance
    is_right |= numpy.abs(got - other) <= tolerance
    return int((~is_right).sum())
