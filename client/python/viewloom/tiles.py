# SPDX-License-Identifier: Apache-2.0
"""Where the views of an atlas lie."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from viewloom.errors import BadInput, data_loss
from viewloom.v1 import display_pb2
from viewloom.v1.atlas_pb2 import AtlasLayout

_SIDE_MAX_PX = 16384  # as display.proto


def check_layout(layout: AtlasLayout) -> None:
    """Raises DATA_LOSS for a layout of which no view can be cut."""
    size, tile = layout.size, layout.tile_size
    if not 0 < min(size.width, size.height) <= max(size.width, size.height) <= _SIDE_MAX_PX:
        raise data_loss(f"the layout has an atlas of {size.width}x{size.height} px; accepted is "
                        f"1..{_SIDE_MAX_PX} px a side")
    if (layout.columns * tile.width > size.width
            or layout.rows * tile.height + layout.padding_top_px > size.height
            or layout.view_count > layout.columns * layout.rows):
        raise data_loss("the layout has an atlas without room for its views")
    images = max(layout.image_count, 1)
    if size.height % images != 0:
        raise data_loss(f"the layout has {images} images in {size.height} rows; accepted are "
                        "images of equal height")


def view_window(picture: NDArray[Any], layout: AtlasLayout, view: int) -> NDArray[Any]:
    """The part of a picture of an atlas that shows one view: a window, not a copy.

    picture: [height_px][width_px] or [height_px][width_px][channels], as layout.size.
    """
    if not 0 <= view < layout.view_count:
        raise BadInput("view", f"is {view}, must lie in 0..{layout.view_count - 1}")
    row, column = divmod(view, layout.columns)
    if layout.order != display_pb2.TILE_ORDER_TOP_LEFT:
        row = layout.rows - 1 - row
    top = layout.padding_top_px + row * layout.tile_size.height
    left = column * layout.tile_size.width
    return picture[top:top + layout.tile_size.height, left:left + layout.tile_size.width]
