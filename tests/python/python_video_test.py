# SPDX-License-Identifier: Apache-2.0
"""Atlases of H.264 as numpy pictures: against the views that OpenH264 coded, and what is no video
of the layout. Argument: the program code_stack."""

import pathlib
import sys
import unittest
from unittest import mock

import numpy as np

import viewloom
from viewloom import h264
from viewloom.atlas import Band
from viewloom.atlas_inbox import AtlasInbox
from viewloom.stack import VideoDecoder
from viewloom.v1 import atlas_pb2, display_pb2
from viewloom.v1.display_service_pb2 import AtlasHeader, StreamAtlasesResponse

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "web"))
from coded_atlases import code_stacks  # noqa: E402  (it lies beside the tests of the page)

H264 = atlas_pb2.BAND_ENCODING_H264
ORDERS = (display_pb2.TILE_ORDER_BOTTOM_LEFT, display_pb2.TILE_ORDER_TOP_LEFT)


def textured_views(count=13, width=97, height=63):
    y, x = np.mgrid[:height, :width].astype(float)
    waves = [[128 + 90 * np.sin((x - 2 * view) / 9 + channel) * np.cos(y / (11 + channel))
              for channel in range(3)] for view in range(count)]
    return np.rint(np.moveaxis(np.array(waves), 1, -1)).astype(np.uint8)


def layout_of(views, video, order=display_pb2.TILE_ORDER_BOTTOM_LEFT, columns=5, rows=3):
    """Of a quilt with padding at its right and at its top."""
    count, height, width = views.shape[:3]
    layout = atlas_pb2.AtlasLayout(
        size={"width": columns * width + 3, "height": rows * height + 7}, columns=columns,
        rows=rows, view_count=count, tile_size={"width": width, "height": height}, order=order,
        padding_top_px=7, padding_right_px=3)
    stack = dict(video, color_matrix=atlas_pb2.COLOR_MATRIX_BT601)
    layout.video.CopyFrom(atlas_pb2.VideoStack(**stack))
    return layout


def atlas_of(layout, units, others=()):
    size = layout.video.picture_size
    bands = [Band(index, atlas_pb2.ATLAS_PLANE_COLOR, 0, size.height, H264, bytearray(unit))
             for index, unit in enumerate(units)]
    return viewloom.Atlas(layout, AtlasHeader(), [*bands, *others])


class Video(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.views = textured_views()
        ((cls.video, cls.units),) = code_stacks(PROGRAM, [cls.views], 20)

    def atlas(self, order=display_pb2.TILE_ORDER_BOTTOM_LEFT, units=None):
        return atlas_of(layout_of(self.views, self.video, order), units or self.units)

    def test_views_come_back(self):
        for order in ORDERS:
            atlas = self.atlas(order)
            self.assertEqual((atlas.color.dtype, atlas.color.shape), (np.uint8, (196, 488, 3)))
            self.assertFalse(atlas.color.flags.writeable)
            for view, expected in enumerate(self.views):
                error = atlas.view(view).astype(float) - expected
                self.assertLess(np.sqrt(np.mean(error ** 2)), 3, f"view {view}")
            self.assertEqual(atlas.color[:7].max(), 0)
            self.assertEqual(atlas.color[:, -3:].max(), 0)
        self.assertIn("H264", repr(atlas))

    def test_colours_of_flat_patches_are_right(self):
        patches = [(0, 0, 0), (255, 255, 255), (128, 128, 128), (255, 0, 0), (0, 255, 0),
                   (0, 0, 255), (200, 120, 80), (17, 60, 140), (1, 2, 3)]
        views = np.array([np.full((32, 48, 3), patch, np.uint8) for patch in patches])
        ((video, units),) = code_stacks(PROGRAM, [views], 20)
        atlas = atlas_of(layout_of(views, video, columns=3), units)
        for view, patch in enumerate(patches):
            mean = (atlas.view(view).astype(float) - patch).mean(axis=(0, 1))
            self.assertLessEqual(np.abs(mean).max(), 1, f"{patch}: {mean}")

    def test_every_atlas_is_decoded_alone(self):
        (_, first), (video, second) = code_stacks(PROGRAM, [self.views, self.views[::-1]], 20)
        del first
        atlas = atlas_of(layout_of(self.views, video), second)
        self.assertLess(np.abs(atlas.view(0).astype(float) - self.views[-1]).mean(), 3)

    def test_other_planes_lie_in_the_same_pictures(self):
        size, cell = self.video["picture_size"], self.video["cell_size"]
        bands = []
        for picture in range(self.video["picture_count"]):
            rows = np.zeros((size["height"], size["width"]), "<f4")
            for row in range(self.video["rows"]):
                for column in range(self.video["columns"]):
                    rank = row * self.video["columns"] + column
                    rows[row * cell["height"]:, column * cell["width"]:] = \
                        picture + rank * self.video["picture_count"]
            for first in (0, 8):
                part = rows[first:8] if first == 0 else rows[first:]
                bands.append(Band(picture, atlas_pb2.ATLAS_PLANE_DEPTH, first, len(part),
                                  atlas_pb2.BAND_ENCODING_RAW, bytearray(part.tobytes())))
        atlas = atlas_of(layout_of(self.views, self.video), self.units, bands)
        for view in range(len(self.views)):
            self.assertEqual(np.unique(atlas.view_inv_z(view)).tolist(), [view])
        with self.assertRaisesRegex(viewloom.BadInput, "MASK of image 0 did not come"):
            atlas.mask  # pylint: disable=pointless-statement
        with self.assertRaisesRegex(viewloom.BadInput, "is not JPEG"):
            atlas.jpeg  # pylint: disable=pointless-statement

    def test_damage_is_data_loss(self):
        noise = bytes(range(256)) * 2
        for units, words in (
                ([noise, *self.units[1:]], "missing or damaged"),
                ([b"", *self.units[1:]], "missing or damaged"),
                ([self.units[1]] * len(self.units), "missing or damaged"),
                ([self.units[0][:40], *self.units[1:]], "damaged"),
                ([self.units[0], self.units[2], *self.units[2:]], "damaged"),
                ([self.units[0], noise, *self.units[2:]], "damaged"),
                ([self.units[0], b"\0\0\1\x67" + self.units[1], *self.units[2:]],
                 "sequence parameters before"),
                ([b"\0\0\1\x6e" + self.units[0], *self.units[1:]], r"types \[14\]")):
            with self.assertRaisesRegex(viewloom.ViewloomError, f"DATA_LOSS: .*{words}"):
                self.atlas(units=units).color  # pylint: disable=expression-not-assigned

    def test_layouts_that_do_not_fit_are_data_loss(self):
        for change, words in (
                (lambda layout: layout.video.picture_size.CopyFrom(
                    atlas_pb2.VideoStack(picture_size={"width": 640, "height": 64}).picture_size),
                 "do not hold the views"),
                (lambda layout: setattr(layout, "view_count", 5000), "do not hold the views"),
                (lambda layout: setattr(layout, "rows", 50), "do not hold the views"),
                (lambda layout: setattr(layout.video, "full_range", False), "full range")):
            layout = layout_of(self.views, self.video)
            change(layout)
            with self.assertRaisesRegex(viewloom.ViewloomError, f"DATA_LOSS: .*{words}"):
                atlas_of(layout, self.units).color  # pylint: disable=expression-not-assigned
        layout = layout_of(self.views, self.video)
        layout.video.columns *= 2  # a size of its own that holds together
        layout.video.picture_size.width *= 2
        with self.assertRaisesRegex(viewloom.ViewloomError, "px, the layout"):
            atlas_of(layout, self.units).color  # pylint: disable=expression-not-assigned

    def test_chained_atlases_are_decoded_as_they_come(self):
        views = [np.roll(self.views, 3 * number, axis=2) for number in range(3)]
        coded = code_stacks(PROGRAM, views, 20, chained=True)
        layout = layout_of(self.views, coded[0][0])
        layout.encoding.prediction = atlas_pb2.PREDICTION_ACROSS_ATLASES
        inbox = AtlasInbox()
        inbox.add(StreamAtlasesResponse(layout=layout))

        def add(number):
            units = coded[number][1]
            size = layout.video.picture_size
            inbox.add(StreamAtlasesResponse(header={
                "sequence": number + 1, "reference_sequence": number, "band_count": len(units),
                "is_backward": number % 2 == 1}))
            for place, unit in enumerate(units):
                index = len(units) - 1 - place if number % 2 == 1 else place
                inbox.add(StreamAtlasesResponse(band={
                    "sequence": number + 1, "image_index": index,
                    "plane": atlas_pb2.ATLAS_PLANE_COLOR, "row_count": size.height,
                    "encoding": H264, "data": unit, "last_piece": True}))
            inbox.add(StreamAtlasesResponse(end={"sequence": number + 1}))

        add(0)
        inbox.add(StreamAtlasesResponse(layout=layout))  # as for eyes that move
        add(1)  # nobody takes the one before
        add(2)
        atlas = inbox.take()
        for view, expected in enumerate(views[2]):  # with an edge where they were rolled
            error = atlas.view(view).astype(float) - expected
            self.assertLess(np.sqrt(np.mean(error ** 2)), 5, f"view {view}")
        add(0)
        with self.assertRaisesRegex(viewloom.ViewloomError, "DATA_LOSS: .*refers to atlas 2"):
            add(2)

    def test_a_chain_goes_on_only_from_an_atlas_that_was_decoded_whole(self):
        layout = layout_of(self.views, self.video)
        decoder = VideoDecoder()
        self.addCleanup(decoder.close)
        next(decoder.decode(self.units, AtlasHeader(sequence=1), layout))
        with self.assertRaisesRegex(viewloom.ViewloomError, "DATA_LOSS: .*refers to atlas 1"):
            list(decoder.decode(self.units, AtlasHeader(sequence=2, reference_sequence=1), layout))

    def test_pictures_beyond_what_memory_is_for_are_refused(self):
        layout = layout_of(self.views, self.video)
        layout.view_count = layout.columns = 5000
        layout.size.width = layout.columns * layout.tile_size.width
        layout.video.columns = layout.video.rows = 1
        layout.video.cell_size.width = layout.video.picture_size.width = 4096
        layout.video.cell_size.height = layout.video.picture_size.height = 2176
        layout.video.picture_count = 5000
        decoder = VideoDecoder()
        with self.assertRaisesRegex(viewloom.ViewloomError, "DATA_LOSS: .*do not hold the views"):
            list(decoder.decode([b""] * 5000, AtlasHeader(sequence=1), layout))

    def test_chained_video_needs_video(self):
        with self.assertRaisesRegex(viewloom.BadInput, "chained"):
            viewloom.encoding(chained=True)

    def test_a_missing_library_is_named(self):
        h264._library.cache_clear()  # pylint: disable=protected-access
        self.addCleanup(h264._library.cache_clear)  # pylint: disable=protected-access
        with mock.patch.object(h264.ctypes, "CDLL", side_effect=OSError), \
                self.assertRaisesRegex(viewloom.ViewloomError, "UNIMPLEMENTED: .*libopenh264-7"):
            self.atlas().color  # pylint: disable=expression-not-assigned

    def test_is_asked_for_by_name(self):
        asked = viewloom.encoding(h264=True, video_qp=30, depth=True)
        self.assertEqual((asked.color, asked.video_qp, asked.with_depth), (H264, 30, True))
        with self.assertRaisesRegex(viewloom.BadInput, "one of the two"):
            viewloom.encoding(h264=True, lossless=True)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop()
    unittest.main()
