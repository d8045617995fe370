# SPDX-License-Identifier: Apache-2.0
"""Where the views of an atlas lie."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from viewloom.errors import BadInput
from viewloom.v1 import display_pb2
from viewloom.v1.atlas_pb2 import AtlasLayout


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
