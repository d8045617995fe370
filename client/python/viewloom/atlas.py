# SPDX-License-Identifier: Apache-2.0
"""A whole atlas: its pictures as numpy arrays, and the views cut out of them."""

from __future__ import annotations

import dataclasses
import functools
import io
import pathlib
from typing import Any, Optional, Union

import numpy as np
import zstandard
from numpy.typing import NDArray
from PIL.JpegImagePlugin import JpegImageFile

from viewloom import h264, stack
from viewloom.atlas_file import PathLike, save
from viewloom.errors import BadInput, data_loss
from viewloom.tiles import view_window
from viewloom.v1 import atlas_pb2
from viewloom.v1.atlas_pb2 import AtlasLayout
from viewloom.v1.display_service_pb2 import AtlasEnd, AtlasHeader

# Sample type and samples a pixel of planes that are not JPEGs.
_SAMPLES = {atlas_pb2.ATLAS_PLANE_COLOR: ("u1", 3), atlas_pb2.ATLAS_PLANE_DEPTH: ("<f4", 1),
            atlas_pb2.ATLAS_PLANE_MASK: ("u1", 1), atlas_pb2.ATLAS_PLANE_DEPTH_CODES: ("<u2", 1)}
_CHANNELS = (atlas_pb2.ATLAS_PLANE_RED, atlas_pb2.ATLAS_PLANE_GREEN, atlas_pb2.ATLAS_PLANE_BLUE)
_JPEGS = (atlas_pb2.BAND_ENCODING_JPEG, atlas_pb2.BAND_ENCODING_JPEG_PLANES)


@dataclasses.dataclass
class Band:
    """A full-width strip as it came, its pieces joined."""

    image_index: int
    plane: atlas_pb2.AtlasPlane
    first_row: int
    row_count: int
    encoding: atlas_pb2.BandEncoding
    data: bytearray = dataclasses.field(repr=False)


def _inflate(band: Band, wanted_bytes: int) -> bytes:
    packed = bytes(band.data)
    try:
        stated_bytes = zstandard.frame_content_size(packed)  # -1 = not stated
        if stated_bytes in (-1, wanted_bytes):
            return zstandard.ZstdDecompressor().decompress(packed, max_output_size=wanted_bytes)
        problem = f"it holds {stated_bytes} bytes, expected {wanted_bytes}"
    except zstandard.ZstdError as error:
        problem = str(error)
    raise data_loss(f"the band at row {band.first_row} does not unpack: {problem}")


def _decode_jpeg(jpeg: bytes, size_px: tuple[int, int], mode: str) -> NDArray[Any]:
    try:
        # Not by Image.open, which takes what is larger than its guess of a picture for an attack.
        image = JpegImageFile(io.BytesIO(jpeg))
        if image.size != size_px:
            raise data_loss(f"the JPEG is {image.size[0]}x{image.size[1]} px, the layout "
                            f"{size_px[0]}x{size_px[1]}")
        if image.mode != mode:
            raise data_loss(f"the JPEG has samples of {image.mode}, the plane of {mode}")
        return np.asarray(image)
    except (OSError, SyntaxError) as problem:  # SyntaxError is what Pillow calls a bad header
        raise data_loss(f"the bands are no JPEG: {problem}") from None


@dataclasses.dataclass(repr=False)
class Atlas:
    """All views of a display at one instant. Pictures are decoded when first asked for.

    layout:   where the views lie and what they see (proto AtlasLayout).
    header:   frame number, capture time, eyes, depth budget (proto AtlasHeader).
    end:      what is known once it is whole: coverage, stage times (proto AtlasEnd).
    skipped:  atlases of this display that were made since the one before, and overtaken.
    stream:   the name of the stream.
    pictures: of chained video, decoded as they came, with their numbers; else None.
    """

    layout: AtlasLayout
    header: AtlasHeader
    bands: list[Band]
    end: AtlasEnd = dataclasses.field(default_factory=AtlasEnd)
    skipped: int = 0
    stream: str = ""
    pictures: Optional[list[tuple[int, h264.Picture]]] = None

    def __repr__(self) -> str:
        tile = self.layout.tile_size
        kinds = sorted({atlas_pb2.BandEncoding.Name(band.encoding).removeprefix("BAND_ENCODING_")
                        for band in self.bands})
        size_bytes = sum(len(band.data) for band in self.bands)
        return (f"<viewloom.Atlas of {self.stream!r}, frame {self.header.frame_number}: "
                f"{self.layout.view_count} views of {tile.width}x{tile.height} px in "
                f"{self.layout.size.width}x{self.layout.size.height}, {size_bytes} bytes of "
                f"{'+'.join(kinds)}>")

    @property
    def image_count(self) -> int:
        """Images of equal height that the atlas is, one below the other."""
        return max(self.layout.image_count, 1)

    def plane(self, plane: atlas_pb2.AtlasPlane, image_index: int = 0) -> NDArray[Any]:
        """A plane of atlas_pb2.AtlasPlane of one image, decoded.

        Raises BadInput when it was not asked for.
        """
        height = self.layout.size.height // self.image_count
        if self.layout.HasField("video"):
            # Bands lie in the pictures of the video, whichever image their views belong to.
            return self._stacked(plane)[image_index * height:(image_index + 1) * height]
        bands = self._bands_of(plane, image_index)
        if bands[0].encoding in _JPEGS:
            return _decode_jpeg(b"".join(band.data for band in bands),
                                (self.layout.size.width, height),
                                "RGB" if plane == atlas_pb2.ATLAS_PLANE_COLOR else "L")
        return self._unpacked(bands, plane, self.layout.size.width, height)

    def _bands_of(self, plane: atlas_pb2.AtlasPlane, image_index: int) -> list[Band]:
        bands = [band for band in self.bands
                 if band.plane == plane and band.image_index == image_index]
        if not bands:
            name = atlas_pb2.AtlasPlane.Name(plane)
            raise BadInput("plane", f"{name} of image {image_index} did not come: ask for it with "
                           "encoding=viewloom.encoding(...)")
        return bands

    def _stacked(self, plane: atlas_pb2.AtlasPlane) -> NDArray[Any]:
        """All images of an atlas whose color is video."""
        video = self.layout.video
        if plane == atlas_pb2.ATLAS_PLANE_COLOR and self.pictures is not None:
            return stack.painted(self.pictures, self.layout)
        if plane == atlas_pb2.ATLAS_PLANE_COLOR:
            alone = stack.VideoDecoder()
            return stack.painted(alone.decode(self.access_units(), self.header, self.layout),
                                 self.layout)
        pictures = [self._bands_of(plane, picture) for picture in range(video.picture_count)]
        return stack.unstacked(
            [self._unpacked(bands, plane, video.picture_size.width, video.picture_size.height)
             for bands in pictures], self.layout)

    def access_units(self) -> list[bytes]:
        """Pictures of H.264, by their numbers. Raises BadInput where colour is no video.

        A player takes them joined, from the last to the first if header.is_backward.
        """
        if not self.layout.HasField("video"):
            raise BadInput("encoding", "is not H.264: there are no pictures of a video; use color")
        return [b"".join(band.data for band in self._bands_of(atlas_pb2.ATLAS_PLANE_COLOR, picture))
                for picture in range(self.layout.video.picture_count)]

    def _whole(self, plane: atlas_pb2.AtlasPlane) -> NDArray[Any]:
        if self.layout.HasField("video"):
            return self._stacked(plane)
        images = [self.plane(plane, image) for image in range(self.image_count)]
        return images[0] if len(images) == 1 else np.concatenate(images)

    def _unpacked(self, bands: list[Band], plane: atlas_pb2.AtlasPlane, width: int,
                  height: int) -> NDArray[Any]:
        sample_type, channels = _SAMPLES.get(plane, ("u1", 1))
        row_bytes = width * channels * np.dtype(sample_type).itemsize
        pieces = []
        row = 0
        for band in bands:
            if row + band.row_count > height:
                raise data_loss(f"the bands have {row + band.row_count} rows, the layout {height}")
            wanted_bytes = band.row_count * row_bytes
            is_packed = band.encoding == atlas_pb2.BAND_ENCODING_ZSTD
            pieces.append(_inflate(band, wanted_bytes) if is_packed else bytes(band.data))
            if len(pieces[-1]) != wanted_bytes or band.first_row != row:
                raise data_loss(f"the band at row {band.first_row} has {len(pieces[-1])} bytes, "
                                f"expected {wanted_bytes} at row {row}")
            row += band.row_count
        if row != height:
            raise data_loss(f"the bands have {row} rows, the layout {height}")
        shape = (height, width) + ((channels,) if channels > 1 else ())
        return np.frombuffer(b"".join(pieces), sample_type).reshape(shape)

    @functools.cached_property
    def color(self) -> NDArray[np.uint8]:
        """uint8[height_px][width_px][3], sRGB, top row first. Read-only, as all pictures are."""
        if any(band.plane in _CHANNELS for band in self.bands):
            channels: NDArray[np.uint8] = np.stack([self._whole(plane) for plane in _CHANNELS],
                                                   axis=-1)
            channels.flags.writeable = False
            return channels
        return self._whole(atlas_pb2.ATLAS_PLANE_COLOR)

    @functools.cached_property
    def inv_z(self) -> NDArray[np.float32]:
        """float32[height_px][width_px]: 1/Z of each view, 1/m; 0 = infinitely far."""
        return self._whole(atlas_pb2.ATLAS_PLANE_DEPTH)

    @functools.cached_property
    def mask(self) -> NDArray[np.uint8]:
        """uint8[height_px][width_px]: how each ray ended, of atlas_pb2.RayClass."""
        return self._whole(atlas_pb2.ATLAS_PLANE_MASK)

    @functools.cached_property
    def depth_codes(self) -> NDArray[Union[np.uint8, np.uint16]]:
        """Of RGBD displays, [rows * height_px][width_px] of views: how near each pixel is.

        uint8, or uint16 where the display has 16 bits; of two layers the one behind stands below.
        code_inv_z() says what they mean. Raises BadInput for other displays.
        """
        codes = self._codes()
        if codes.bits == 16:
            return self._whole(atlas_pb2.ATLAS_PLANE_DEPTH_CODES)
        views = [self.view(view)[..., 0] for view in codes.depth_views]
        return views[0] if len(views) == 1 else np.concatenate(views)

    def code_inv_z(self) -> NDArray[np.float64]:
        """float64, shaped as depth_codes: the 1/Z that the codes say, 1/m."""
        codes = self._codes()
        share = self.depth_codes / (2.0 ** codes.bits - 1)
        if codes.black_near:
            share = 1 - share
        inv_z: NDArray[np.float64] = codes.inv_z_far + (codes.inv_z_near - codes.inv_z_far) * share
        return inv_z

    def _codes(self) -> atlas_pb2.DepthCodes:
        if not self.layout.HasField("depth_codes"):
            raise BadInput("depth_codes", "are those of RGBD displays alone; elsewhere depth comes "
                           "with encoding=viewloom.encoding(depth=True), as inv_z")
        return self.layout.depth_codes

    @functools.cached_property
    def jpeg(self) -> bytes:
        """The colour of the first image as one JPEG file, byte for byte as the server made it."""
        bands = [band for band in self.bands
                 if band.plane == atlas_pb2.ATLAS_PLANE_COLOR and band.image_index == 0]
        if not bands or bands[0].encoding != atlas_pb2.BAND_ENCODING_JPEG:
            raise BadInput("encoding", "is not JPEG: there is no file; use color")
        return b"".join(band.data for band in bands)

    @property
    def is_jpeg(self) -> bool:
        """Whether all of its colour is one JPEG file."""
        bands = [band for band in self.bands if band.plane == atlas_pb2.ATLAS_PLANE_COLOR]
        return self.image_count == 1 and bool(bands) and all(
            band.encoding == atlas_pb2.BAND_ENCODING_JPEG for band in bands)

    def save(self, path: PathLike) -> pathlib.Path:
        """Saves the colour as a picture file; says which.

        path: a file that ends in .jpg (the bytes as they came) or .png; or a folder, then with a
              name that quilt players read the layout from: demo_000001_qs8x6a0.75.jpg.
        The file is there whole, or not at all. Only regular files are replaced. Raises BadInput,
        and OSError where the file cannot be written.
        """
        return save(self, path)

    def view(self, view: int) -> NDArray[np.uint8]:
        """uint8[tile_height_px][tile_width_px][3]: colour of view 0..view_count - 1."""
        return view_window(self.color, self.layout, view)

    def view_inv_z(self, view: int) -> NDArray[np.float32]:
        """float32[tile_height_px][tile_width_px]: 1/Z of one view, 1/m."""
        return view_window(self.inv_z, self.layout, view)

    def view_mask(self, view: int) -> NDArray[np.uint8]:
        """uint8[tile_height_px][tile_width_px]: how the rays of one view ended."""
        return view_window(self.mask, self.layout, view)
