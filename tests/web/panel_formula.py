# SPDX-License-Identifier: Apache-2.0
"""Which view each subpixel of a calibrated panel shows, in binary64, straight from the published
formula, sharing no code with the page: u = (x + 1/2) / W, v = (y + 1/2) / H from the bottom,
P = pitch W / DPI cos(atan(1 / slope)), T = H / (W slope), phase = (u + du + (v + dv) T) P - center,
z = fract(phase), the view at 1 - z, or at z where the order is not inverted."""
import numpy as np

PORTRAIT = {
    "configVersion": "3.0", "serial": "LKG-PORT-", "pitch": {"value": 52.594383239746094},
    "slope": {"value": -7.21152925491333}, "center": {"value": 0.40277382731437683},
    "viewCone": {"value": 40}, "invView": {"value": 1}, "verticalAngle": {"value": 0},
    "DPI": {"value": 324}, "screenW": {"value": 1536}, "screenH": {"value": 2048},
    "flipImageX": {"value": 0}, "flipImageY": {"value": 0}, "flipSubp": {"value": 0},
    "subpixelCells": [], "CellPatternMode": {"value": 0}}
CELLS = [
    {"ROffsetX": -0.31, "ROffsetY": 0.25, "GOffsetX": 0.28, "GOffsetY": 0.25, "BOffsetX": 0.0,
     "BOffsetY": -0.25},
    {"ROffsetX": -0.31, "ROffsetY": -0.25, "GOffsetX": 0.28, "GOffsetY": -0.25, "BOffsetX": 0.0,
     "BOffsetY": 0.25},
    {"ROffsetX": 0.1, "ROffsetY": 0.4, "GOffsetX": -0.2, "GOffsetY": 0.1, "BOffsetX": 0.35,
     "BOffsetY": -0.4},
    {"ROffsetX": 0.45, "ROffsetY": -0.3, "GOffsetX": 0.05, "GOffsetY": 0.33, "BOffsetX": -0.4,
     "BOffsetY": 0.2}]


def edited(calibration, **values):
    """The file with other values, wrapped as they were."""
    wrapped = {key: value if isinstance(value, list) else {"value": value}
               for key, value in values.items()}
    return {**calibration, **wrapped}


def cell_index(mode, x, y_up):
    return {0: 0 * (x + y_up), 1: (x + y_up) % 2, 2: x % 2 + 0 * y_up,
            3: (y_up + 2 * (x % 2)) % 4, 4: y_up % 2 + 0 * x}[mode]


def view_coordinates(calibration):
    """float64[height][width][3], top row first; 0..1 across the views, first to last."""
    def value(key):
        return calibration[key]["value"]
    width, height = int(value("screenW")), int(value("screenH"))
    lenses = value("pitch") * width / value("DPI") * np.cos(np.arctan(1 / value("slope")))
    direction = -1 if value("flipImageX") >= 0.5 else 1
    tilt = direction * height / (width * value("slope"))
    x = np.arange(width)[None, :]
    y_up = np.arange(height)[::-1, None]
    u, v = (x + 0.5) / width, (y_up + 0.5) / height
    cells = calibration["subpixelCells"]
    views = np.empty((height, width, 3))
    for channel in range(3):
        at = 2 - channel if value("flipSubp") else channel
        if cells:
            index = cell_index(value("CellPatternMode"), x, y_up) % len(cells)
            offsets = [(cell["RGB"[at] + "OffsetX"], cell["RGB"[at] + "OffsetY"])
                       for cell in cells]
            du = np.take([dx for dx, _ in offsets], index) / width
            dv = np.take([dy for _, dy in offsets], index) / height
        else:
            du, dv = direction * at / (3 * width), 0
        phase = (u + du + (v + dv) * tilt) * lenses - value("center")
        z = phase - np.floor(phase)
        views[..., channel] = 1 - z if value("invView") >= 0.5 else z
    return views
