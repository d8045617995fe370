# SPDX-License-Identifier: Apache-2.0
"""Views that lie in the pictures of a video, put where the layout has them (proto VideoStack)."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Iterable, Iterator, Optional, Sequence, TypeVar

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from viewloom import h264
from viewloom.errors import data_loss
from viewloom.tiles import view_window
from viewloom.v1 import atlas_pb2
from viewloom.v1.atlas_pb2 import AtlasLayout, VideoStack
from viewloom.v1.display_service_pb2 import AtlasHeader

_Sample = TypeVar("_Sample", bound=np.generic)
# Pixels of all pictures together; decoded, each takes 1.5 bytes. As the client in C++.
_STACK_AREA_MAX_PX = 1 << 29
# Pillow lets other threads of Python run while it converts; beyond this, they wait for each other.
_THREAD_COUNT_MAX = 8


def _check(layout: AtlasLayout) -> VideoStack:
    """A stack that has a cell for each view, so that no index leaves a picture."""
    video, tile = layout.video, layout.tile_size
    cells = video.picture_count * video.columns * video.rows
    is_whole = (
        0 < layout.view_count <= min(cells, layout.columns * layout.rows)
        and 0 < video.picture_count <= layout.view_count
        and (video.picture_size.width * video.picture_size.height * video.picture_count
             <= _STACK_AREA_MAX_PX)
        and layout.columns * tile.width <= layout.size.width
        and layout.padding_top_px + layout.rows * tile.height <= layout.size.height
        and 0 < tile.width <= video.cell_size.width and 0 < tile.height <= video.cell_size.height
        and video.columns * video.cell_size.width == video.picture_size.width
        and video.rows * video.cell_size.height == video.picture_size.height
        and video.cell_size.width % 2 == 0 and video.cell_size.height % 2 == 0)
    if not is_whole:
        raise data_loss("the pictures of the video do not hold the views of the layout")
    if video.color_matrix != atlas_pb2.COLOR_MATRIX_BT601 or not video.full_range:
        raise data_loss("the video has another colour matrix or range than BT.601 in full range")
    return video


def _cell(video: VideoStack, view: int) -> tuple[int, int, int]:
    """Picture of a view, and the top left pixel of its cell: (picture, left, top)."""
    cell, picture = divmod(view, video.picture_count)
    row, column = divmod(cell, video.columns)
    return picture, column * video.cell_size.width, row * video.cell_size.height


def unstacked(pictures: Sequence[NDArray[_Sample]], layout: AtlasLayout) -> NDArray[_Sample]:
    """Samples of all pictures, [height_px][width_px] or with channels, as layout.size says."""
    video, tile = _check(layout), layout.tile_size
    shape = (layout.size.height, layout.size.width) + pictures[0].shape[2:]
    whole: NDArray[_Sample] = np.zeros(shape, pictures[0].dtype)
    for view in range(layout.view_count):
        picture, left, top = _cell(video, view)
        view_window(whole, layout, view)[:] = pictures[picture][top:top + tile.height,
                                                                left:left + tile.width]
    whole.flags.writeable = False
    return whole


def _enlarged(plane: NDArray[np.uint8], width: int, height: int) -> Any:
    """Chroma of a view between its samples, as libjpeg has it; none of the views beside it."""
    doubled = Image.fromarray(plane).resize((2 * plane.shape[1], 2 * plane.shape[0]),
                                            Image.Resampling.BILINEAR)
    return doubled.crop((0, 0, width, height))


def _view_rgb(picture: h264.Picture, left: int, top: int, width: int,
              height: int) -> NDArray[np.uint8]:
    half = (slice(top // 2, top // 2 + (height + 1) // 2),
            slice(left // 2, left // 2 + (width + 1) // 2))
    merged = Image.merge("YCbCr", (
        Image.fromarray(picture.luma[top:top + height, left:left + width]),
        _enlarged(picture.cb[half], width, height), _enlarged(picture.cr[half], width, height)))
    return np.asarray(merged.convert("RGB"))


def painted(pictures: Iterable[tuple[int, h264.Picture]],
            layout: AtlasLayout) -> NDArray[np.uint8]:
    """uint8[height_px][width_px][3], sRGB, of all views; read-only. Raises DATA_LOSS.

    pictures: with their numbers in the stack, in any order. Views are converted on several threads.
    """
    video, tile = _check(layout), layout.tile_size
    whole = np.zeros((layout.size.height, layout.size.width, 3), np.uint8)

    def paint(picture: h264.Picture, view: int) -> None:
        _, left, top = _cell(video, view)
        view_window(whole, layout, view)[:] = _view_rgb(picture, left, top, tile.width, tile.height)

    # The next picture is decoded meanwhile.
    with ThreadPoolExecutor(min(_THREAD_COUNT_MAX, os.cpu_count() or 1)) as threads:
        views = [threads.submit(paint, picture, view) for index, picture in pictures
                 for view in range(index, layout.view_count, video.picture_count)]
    for view in views:
        view.result()  # raises what it raised
    whole.flags.writeable = False
    return whole


class VideoDecoder:
    """Decodes the atlases of one display, which may refer to the one before.

    Thread-safety: none.
    """

    def __init__(self) -> None:
        self._decoder: Optional[h264.Decoder] = None
        self._sequence = 0  # of the last atlas; 0 = none

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        """Frees the decoder. The next atlas has to be one that refers to no other."""
        if self._decoder is not None:
            self._decoder.close()
        self._decoder, self._sequence = None, 0

    def decode(self, access_units: Sequence[bytes], header: AtlasHeader,
               layout: AtlasLayout) -> Iterator[tuple[int, h264.Picture]]:
        """The pictures of the next atlas, with their numbers. All have to be taken.

        access_units: in the order of their numbers. Raises DATA_LOSS, also if the atlas before it
        is missing.
        """
        video = _check(layout)
        if len(access_units) != video.picture_count:
            raise data_loss(f"{len(access_units)} pictures of H.264 came, the layout has "
                            f"{video.picture_count}")
        if header.reference_sequence == 0:
            self.close()
            self._decoder = h264.Decoder()
        elif self._decoder is None or header.reference_sequence != self._sequence:
            raise data_loss(f"atlas {header.sequence} refers to atlas {header.reference_sequence}, "
                            "which was not decoded before it")
        self._sequence = 0  # until it is decoded
        numbered = list(enumerate(access_units))
        for index, access_unit in reversed(numbered) if header.is_backward else numbered:
            yield index, self._decoder.decode(access_unit, video.picture_size.width,
                                              video.picture_size.height)
        self._sequence = header.sequence
