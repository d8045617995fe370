# SPDX-License-Identifier: Apache-2.0
"""One posed camera and what it sees, as numpy arrays."""

from __future__ import annotations

import dataclasses
from textwrap import shorten
from typing import Any, Optional, Sequence, Union

from numpy.typing import NDArray

from viewloom.camera import PoseLike, make_camera
from viewloom.coded_color import CodedColor
from viewloom.errors import BadInput
from viewloom.planes import (ColorMeaning, DepthFormatLike, WirePlane, color_plane, depth_format,
                             depth_plane)
from viewloom.surface import motion_plane, normal_plane, roughness_plane, specular_plane
from viewloom.v1 import frame_pb2, geometry_pb2

ArrayOrLayers = Union[NDArray[Any], Sequence[NDArray[Any]]]
ColorOrLayers = Union[NDArray[Any], CodedColor, Sequence[Union[NDArray[Any], CodedColor]]]
_LAYER_COUNT_MAX = 4


def _brief(value: Any) -> str:
    """On one line: of arrays the type and the shape."""
    if isinstance(value, (list, tuple)) and any(hasattr(entry, "shape") for entry in value):
        return f"[{', '.join(map(_brief, value))}]"
    if hasattr(value, "shape") and hasattr(value, "dtype"):
        return f"{value.dtype}" + "".join(f"[{count}]" for count in value.shape)
    return shorten(" ".join(repr(value).split()), 80, placeholder=" ...")


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Source:
    """Colour and depth of one camera; with several layers, one array each, the nearest first.

    color:  uint8 or float [height_px][width_px][3 or 4], top row first. May be larger or smaller
            than depth. Floats are sent as binary16, at most 65504. Or a CodedColor.
    depth:  float16, float32, float64 or uint16 [height_px][width_px], top row first. Metres along
            the view axis unless depth_format says otherwise; +inf is the sky; NaN and 0 are no
            surface. float64 is sent as float32.

    Exactly one of (but for cube maps, which have none):
    fov_y_rad:   height of the picture, radians, 0..pi; the width follows from depth's shape.
    fov:         left, right, up, down: radians from the view axis, negative to the left and down.
    intrinsics:  focal x, focal y, principal x, principal y: px of depth. Sample centres are at
                 +0.5: add 0.5 to a principal point that counts them from 0, as OpenCV does.

    pose:        camera to world, a 4x4 matrix (metres, +y up, looking along -z) or a Pose.
    transfer:    "srgb" or "linear"; None = srgb for uint8, linear for floats.
    primaries:   "bt709", "display_p3" or "bt2020".
    alpha:       what a fourth channel says: "opaque" (ignored), "straight" or "premultiplied".
    depth_format: what a depth sample measures: a DepthFormat, or a mapping of its fields.
    connection_tolerance: 1/m, as in proto Source; 0 = measured.
    specular:    share of the light that is mirrored head on (F0): uint8 (v / 255) or float 0..1,
                 [height_px][width_px] or [..][3] of depth's size, as the next two; None = nothing
                 mirrors. Displays show it with effects.reflection.
    roughness:   0 = a mirror, 1 = rough: uint8 (v / 255) or float 0..1. None: all is a mirror.
    normal:      where surfaces face, of any length but 0: float or uint8 (2 v / 255 - 1)
                 [height_px][width_px][3], or uint16 [..][2], an octahedron as in proto. None: as
                 depth slopes.
    normal_space: "camera" (+x right, +y up, +z towards it) or "world".
    color_has_reflections: nothing is added to the colour, whatever specular says.
    motion:      how surfaces move by themselves, without what the camera does: float
                 [height_px][width_px][3] of depth's size, m/s along the world's axes. For displays
                 with effects.temporal; colour has to be as large as depth. None: all stands.
    cube_map:    six square faces below each other: +x, -x, +y, -y, +z, -z, as in proto Source.
    """

    color: ColorOrLayers
    depth: ArrayOrLayers
    fov_y_rad: Optional[float] = None
    fov: Optional[Sequence[float]] = None
    intrinsics: Optional[Sequence[float]] = None
    pose: PoseLike = None
    transfer: Optional[str] = None
    primaries: str = "bt709"
    alpha: str = "opaque"
    depth_format: DepthFormatLike = None
    connection_tolerance: float = 0.0
    cube_map: bool = False
    specular: Optional[ArrayOrLayers] = None
    roughness: Optional[ArrayOrLayers] = None
    normal: Optional[ArrayOrLayers] = None
    normal_space: str = "camera"
    color_has_reflections: bool = False
    motion: Optional[ArrayOrLayers] = None

    def __repr__(self) -> str:
        given = [f"{field.name}={_brief(getattr(self, field.name))}"
                 for field in dataclasses.fields(self)
                 if getattr(self, field.name) is not field.default]
        return f"viewloom.Source({', '.join(given)})"

    def camera(self, size_px: tuple[int, int]) -> geometry_pb2.Camera:
        """Of depth planes of (width, height) px."""
        return make_camera(size_px, fov_y_rad=self.fov_y_rad, fov=self.fov,
                           intrinsics=self.intrinsics, pose=self.pose,
                           without_projection=self.cube_map)


def _layers(value: ColorOrLayers, field: str) -> list[tuple[str, Any]]:
    """Each layer's array, and what it is called."""
    if isinstance(value, (list, tuple)):
        return [(f"{field}[{index}]", layer) for index, layer in enumerate(value)]
    return [(field, value)]


def _surface_planes(source: Source, layer: int, layer_count: int) -> list[WirePlane]:
    """Of one layer, what says how it moves and mirrors."""
    planes = []
    given = {"motion": source.motion, "normal": source.normal, "roughness": source.roughness,
             "specular": source.specular}
    for name, value in given.items():
        if value is None:
            continue
        layers = _layers(value, name)
        if len(layers) != layer_count:
            raise BadInput(name, f"has {len(layers)} layers, must have as many as depth, "
                           f"{layer_count}")
        field, array = layers[layer]
        if name == "motion":
            planes.append(motion_plane(array, field))
        elif name == "normal":
            planes.append(normal_plane(array, field, source.normal_space))
        elif name == "roughness":
            planes.append(roughness_plane(array, field))
        else:
            planes.append(specular_plane(array, field))
    return planes


def wire_planes(source: Source) -> list[WirePlane]:
    """Colour, depth and what else is given of each layer in turn. Raises BadInput."""
    colors, depths = _layers(source.color, "color"), _layers(source.depth, "depth")
    if len(colors) != len(depths):
        raise BadInput("color", f"has {len(colors)} layers, must have as many as depth, "
                       f"{len(depths)}")
    if not 1 <= len(colors) <= _LAYER_COUNT_MAX:
        raise BadInput("color", f"has {len(colors)} layers, must have 1..{_LAYER_COUNT_MAX}")
    meaning = ColorMeaning(source.transfer, source.primaries, source.alpha)
    format_given = depth_format(source.depth_format)
    planes = []
    for layer, ((color_field, color), (depth_field, depth)) in enumerate(zip(colors, depths)):
        planes.append(color_plane(color, color_field, meaning))
        planes.append(depth_plane(depth, depth_field, format_given))
        first, this = planes[1].samples.shape, planes[-1].samples.shape
        if this != first:
            raise BadInput(depth_field, f"is {this[1]}x{this[0]} px, must be that of layer 0, "
                           f"{first[1]}x{first[0]}")
        planes += _surface_planes(source, layer, len(colors))
    return planes


def source_header(source: Source, planes: Sequence[frame_pb2.Plane]) -> frame_pb2.Source:
    """The declaration of a source whose planes are these; layers begin with their colour."""
    size_px = planes[1].size.width, planes[1].size.height
    layers: list[frame_pb2.Layer] = []
    for plane in planes:
        if plane.kind == frame_pb2.PLANE_KIND_COLOR:
            layers.append(frame_pb2.Layer(color_has_reflections=source.color_has_reflections))
        layers[-1].planes.append(plane)
    return frame_pb2.Source(camera=source.camera(size_px), layers=layers,
                            connection_tolerance=source.connection_tolerance,
                            cube_map=source.cube_map)
