# SPDX-License-Identifier: Apache-2.0
"""What is asked for: the fields of an OpenDisplay, by name. Every kind of display, every effect
and every way of packing an atlas."""

TILE = {"width": 120, "height": 68}
QUILT = {"columns": 3, "rows": 2, "size": {"width": 360, "height": 136}}
# A small panel whose lenses lean to the left, in the words of a visual.json.
CALIBRATION = """{"configVersion": "3.0", "serial": "LKG-TEST",
 "pitch": {"value": 49.0}, "slope": {"value": -6.0}, "center": {"value": 0.2},
 "viewCone": {"value": 40.0}, "invView": {"value": 1}, "verticalAngle": {"value": 0},
 "DPI": {"value": 100.0}, "screenW": {"value": 240}, "screenH": {"value": 160},
 "flipImageX": {"value": 0}, "flipImageY": {"value": 0}, "flipSubp": {"value": 0}}"""
PANEL = {"calibration_json": CALIBRATION}
INTEGRAL = {"panel_size": {"width": 192, "height": 120}, "pixel_pitch_m": 1e-5,
            "lens_pitch_m": 1.2e-4, "focal_length_m": 3.3e-4, "scale": 4}
RGBD = {"view_size": TILE}
LENS = {"aperture_radius_m": 0.03}
REFLECTION = {"bounces": 2}

# Color as it was traced, with depth and the classes of rays beside it: what is compared by number.
LOSSLESS = {"color": "BAND_ENCODING_RAW", "with_depth": True, "with_mask": True,
            "planes": "BAND_ENCODING_RAW"}


def _pose(x=0.0, y=0.0, z=0.0, turn=(0.0, 0.0, 0.0, 1.0)):
    return {"position": {"x": x, "y": y, "z": z},
            "orientation": dict(zip("xyzw", turn))}


def _camera(*place, **turned):
    return {"pose": _pose(*place, **turned), "fov": _FOV}


_FOV = {"angle_left_rad": -0.4, "angle_right_rad": 0.4,
        "angle_up_rad": 0.24, "angle_down_rad": -0.24}
_TURNED = (0.0, 0.0499792, 0.0, 0.9987503)  # by 0.1 rad to the left
_ROLLED = (0.0, 0.0, 0.0998334, 0.9950042)  # by 0.2 rad
_EYES = [_camera(-0.03), _camera(0.03)]
_GRID = {"columns": 2, "rows": 2, "spacing_x_m": 0.05, "spacing_y_m": 0.05}


def _quilt(**fields):
    return {"quilt": {**QUILT, **fields}}


def _grid(**fields):
    return {"cameras": {"grid": _GRID, "tile_size": TILE, **fields}}


def _lens(display, **fields):
    return {**display, "effects": {"lens": {**LENS, **fields}}}


def _mirror(display, **fields):
    return {**display, "effects": {"reflection": {**REFLECTION, **fields}}}


DISPLAYS = {
    "quilt": _quilt(),
    "quilt-core": _quilt(convention="CAMERA_CONVENTION_CORE"),
    "quilt-bridge": _quilt(convention="CAMERA_CONVENTION_BRIDGE", depthiness=1.5),
    "quilt-top-left": _quilt(order="TILE_ORDER_TOP_LEFT", view_count=5),
    "quilt-wide": _quilt(view_cone_rad=1.2, focal_distance_m=2.0, aspect=0.75),
    "quilt-draft": {**_quilt(), "quality": "QUALITY_DRAFT"},
    "quilt-best": {**_quilt(), "quality": "QUALITY_BEST"},
    "quilt-filtered": {**_quilt(), "filter": {"sample_count": 4}},
    "quilt-background": {**_quilt(fov_y_rad=1.2), "outside_fill": "OUTSIDE_FILL_BACKGROUND",
                         "background_rgb": 0x204080},
    "quilt-in-world": {**_quilt(), "world_pose": _pose(0.1, 0.05, 0.0, turn=_TURNED)},
    "quilt-following": {**_quilt(), "focus_following_s": 0.5},
    "stereo": {"stereo": {"eye_size": TILE}},
    "stereo-over": {"stereo": {"eye_size": TILE, "layout": "STEREO_LAYOUT_TOP_BOTTOM"}},
    "stereo-separate": {"stereo": {"eye_size": TILE, "layout": "STEREO_LAYOUT_SEPARATE"}},
    "stereo-eyes": {"stereo": {"eye_size": TILE, "eyes": _EYES}},
    "grid": _grid(),
    "grid-row": _grid(arrangement="TILE_ARRANGEMENT_ROW"),
    "grid-quad": _grid(arrangement="TILE_ARRANGEMENT_QUAD_2X2"),
    "grid-separate": _grid(arrangement="TILE_ARRANGEMENT_SEPARATE_VIEWS"),
    "cameras": {"cameras": {"tile_size": TILE, "cameras": [
        _camera(), _camera(0.05, 0.02, -0.3), _camera(turn=_TURNED), _camera(turn=_ROLLED)]}},
    "lenticular": {"lenticular": PANEL},
    "lenticular-views": {"lenticular": {**PANEL, "view_count": 8}},
    "lenticular-filtered": {"lenticular": PANEL, "filter": {"sample_count": 2}},
    "integral": {"integral": INTEGRAL},
    "integral-flipped": {"integral": {**INTEGRAL, "flipped": True, "distance_m": 1.0}},
    "rgbd": {"rgbd": RGBD},
    "rgbd-left": {"rgbd": {**RGBD, "depth_placement": "DEPTH_PLACEMENT_LEFT"}},
    "rgbd-below": {"rgbd": {**RGBD, "depth_placement": "DEPTH_PLACEMENT_BOTTOM",
                            "black_near": True}},
    "rgbd-screen": {"rgbd": {**RGBD, "screen_m": 2.5}},
    "rgbd-two-layers": {"rgbd": {**RGBD, "form": "RGBD_FORM_TWO_LAYERS"}},
    "rgbd-16": {"rgbd": {**RGBD, "depth_bits": 16}},
    "lens": _lens(_quilt()),
    "lens-exact": _lens(_quilt(), mode="GATHER_MODE_EXACT", blades=5, rotation_rad=0.3),
    "lens-walked": _lens(_quilt(), samples=8, gathered_samples=0),
    "lens-automatic": _lens(_quilt(), aperture_radius_m=0, automatic_aperture=True),
    "lens-panel": _lens({"lenticular": PANEL}),
    "lens-stereo": _lens({"stereo": {"eye_size": TILE}}, focus_distance_m=2.0),
    "reflections": _mirror(_quilt()),
    "reflections-unfiltered": _mirror(_quilt(), unfiltered=True, environment_rgb=0x8090A0),
    "reflections-stereo": _mirror({"stereo": {"eye_size": TILE}}),
    "lens-and-reflections": {**_quilt(), "effects": {"lens": LENS, "reflection": REFLECTION}},
}

ENCODINGS = {
    "jpeg": {},
    "jpeg-444": {"chroma": "CHROMA_SUBSAMPLING_444", "jpeg_quality": 60},
    "jpeg-planes": {"color": "BAND_ENCODING_JPEG_PLANES"},
    "zstd": {"color": "BAND_ENCODING_ZSTD", "with_depth": True, "with_mask": True},
    "raw": LOSSLESS,
}
# The displays that are asked for in every encoding; the rest come as they were traced.
IN_ALL_ENCODINGS = ("quilt", "stereo-separate", "lenticular", "rgbd", "rgbd-16")

# Where the eyes before a tracked display are: beside each other, and turned.
EYE_POSES = [_EYES, [_camera(-0.03, 0.02, 0.1, turn=_ROLLED),
                     _camera(0.03, -0.02, 0.1, turn=_ROLLED)]]


def requests():
    """(name, display, encoding, eyes or None) of every atlas that a stream is asked for."""
    for name, display in DISPLAYS.items():
        if name in IN_ALL_ENCODINGS:
            for packing, encoding in ENCODINGS.items():
                yield f"{name}, {packing}", display, encoding, None
        else:
            yield name, display, LOSSLESS, None
    tracked = {"stereo": {"eye_size": TILE, "tracked": True}}
    for number, eyes in enumerate(EYE_POSES):
        yield f"stereo-tracked {number}", tracked, LOSSLESS, eyes


def _between(mode):
    return {**_quilt(), "effects": {"temporal": {"output_rate_hz": 60, "mode": mode}}}


# Displays that show another time than that of a frame, and by how many seconds.
BETWEEN_FRAMES = {"predicted": (_between("TEMPORAL_MODE_PREDICT"), 0.03),
                  "interpolated": (_between("TEMPORAL_MODE_INTERPOLATE"), -0.04)}
