# SPDX-License-Identifier: Apache-2.0
"""How the package joins what comes into atlases, and what it never gives as one."""

import io
import unittest

import numpy as np
import zstandard
from PIL import Image

import viewloom
from viewloom.atlas_inbox import AtlasInbox
from viewloom.v1 import atlas_pb2, display_pb2
from viewloom.v1.display_service_pb2 import StreamAtlasesResponse


def answers(sequence, layout=None, size=(2, 2), value=9):
    """The messages of an atlas of raw colour, all samples the same."""
    width, height = size
    layout = layout or atlas_pb2.AtlasLayout(
        size={"width": width, "height": height}, columns=1, rows=1, view_count=1,
        tile_size={"width": width, "height": height})
    band = {"sequence": sequence, "plane": atlas_pb2.ATLAS_PLANE_COLOR, "row_count": height,
            "encoding": atlas_pb2.BAND_ENCODING_RAW, "data": bytes([value]) * width * height * 3,
            "last_piece": True}
    return [StreamAtlasesResponse(layout=layout),
            StreamAtlasesResponse(header={"sequence": sequence, "band_count": 1}),
            StreamAtlasesResponse(band=band), StreamAtlasesResponse(end={"sequence": sequence})]


class Inbox(unittest.TestCase):
    def setUp(self):
        self.inbox = AtlasInbox()

    def add(self, messages):
        for message in messages:
            self.inbox.add(message)

    def test_a_reader_that_comes_late_gets_the_newest(self):
        self.add(answers(1) + answers(2)[1:] + answers(3, value=7)[1:])
        self.inbox.add(StreamAtlasesResponse(skipped={"count": 4}))
        self.add(answers(8, value=5)[1:])
        atlas = self.inbox.take()
        self.assertEqual((atlas.header.sequence, atlas.skipped, atlas.color[0, 0, 0]), (8, 7, 5))
        self.assertFalse(self.inbox.is_ready())

    def test_an_atlas_without_its_end_is_discarded(self):
        self.add(answers(1)[:3] + answers(2)[1:])
        self.assertEqual(self.inbox.take().header.sequence, 2)

    def test_an_atlas_that_is_abandoned_is_never_given(self):
        abandoned = StreamAtlasesResponse(abandoned={"sequence": 1})
        self.add(answers(1)[:3] + [abandoned])
        self.assertFalse(self.inbox.is_ready())
        self.add(answers(2, value=5)[1:])
        atlas = self.inbox.take()
        self.assertEqual((atlas.header.sequence, atlas.color[0, 0, 0]), (2, 5))
        with self.assertRaises(viewloom.ViewloomError):
            self.add(answers(3)[1:3] + [StreamAtlasesResponse(abandoned={"sequence": 3}),
                                        answers(3)[3]])

    def test_the_outcome_comes_with_the_end_or_of_older_servers_with_the_header(self):
        layout, header, band, end = answers(1)
        end.end.coverage.hit = 0.5
        self.add([layout, header, band, end])
        self.assertEqual(self.inbox.take().end.coverage.hit, 0.5)
        header.header.coverage.hit, header.header.times.trace_ns = 0.25, 7
        self.add([layout, header, band, answers(1)[3]])
        atlas = self.inbox.take()
        self.assertEqual((atlas.end.coverage.hit, atlas.end.times.trace_ns), (0.25, 7))
        self.assertFalse(atlas.header.HasField("coverage"))

    def test_atlases_that_are_not_whole_are_data_loss(self):
        layout, header, band, end = answers(1)
        open_band = StreamAtlasesResponse()
        open_band.CopyFrom(band)
        open_band.band.last_piece = False
        for messages in ([layout, header, end], [layout, band], [header, band, end],
                         [layout, header, open_band, end], [layout, header, open_band, band],
                         [layout, header, band, answers(2)[3]]):
            self.inbox = AtlasInbox()
            with self.assertRaises(viewloom.ViewloomError) as broken:
                self.add(messages)
            self.assertEqual(broken.exception.status.name, "DATA_LOSS")

    def test_layouts_of_which_no_view_can_be_cut_are_data_loss(self):
        for change in ({"size": {"width": 2 ** 32 - 1, "height": 2}}, {"size": {}}, {"columns": 2},
                       {"columns": 0}, {"padding_top_px": 1}, {"view_count": 5},
                       {"image_count": 3}):
            layout, *_ = answers(1)
            for name in change:
                layout.layout.ClearField(name)
            layout.layout.MergeFrom(atlas_pb2.AtlasLayout(**change))
            with self.assertRaisesRegex(viewloom.ViewloomError, "DATA_LOSS: .*the layout has"):
                self.inbox.add(layout)

    def test_bands_without_rows_or_beyond_the_header_are_data_loss(self):
        layout, header, band, _ = answers(1)
        rowless = StreamAtlasesResponse()
        rowless.CopyFrom(band)
        rowless.band.row_count = 0
        for messages in ([layout, header, rowless], [layout, header, band, band]):
            self.inbox = AtlasInbox()
            with self.assertRaisesRegex(viewloom.ViewloomError, "DATA_LOSS: .*band"):
                self.add(messages)

    def test_a_grey_jpeg_is_no_colour(self):
        file = io.BytesIO()
        Image.new("L", (2, 2)).save(file, "JPEG")
        messages = answers(1)
        messages[2].band.encoding = atlas_pb2.BAND_ENCODING_JPEG
        messages[2].band.data = file.getvalue()
        self.add(messages)
        with self.assertRaisesRegex(viewloom.ViewloomError, "DATA_LOSS: .*samples of L"):
            self.inbox.take().color

    def test_bytes_that_are_no_picture_of_the_layout_are_data_loss(self):
        file = io.BytesIO()
        Image.new("RGB", (3, 2)).save(file, "JPEG")
        jpeg, zstd = atlas_pb2.BAND_ENCODING_JPEG, atlas_pb2.BAND_ENCODING_ZSTD
        pack = zstandard.ZstdCompressor().compress
        for encoding, data, words in (
                (atlas_pb2.BAND_ENCODING_RAW, bytes(13), "has 13 bytes, expected 12"),
                (zstd, pack(bytes(13)), "holds 13 bytes, expected 12"),
                (zstd, pack(bytes(12))[:-1], "does not unpack"), (zstd, b"no zstd", "does not"),
                (jpeg, file.getvalue(), "is 3x2 px, the layout 2x2"),
                (jpeg, file.getvalue()[:100], "no JPEG"), (jpeg, b"", "no JPEG")):
            messages = answers(1)
            messages[2].band.encoding, messages[2].band.data = encoding, data
            self.add(messages)
            with self.assertRaisesRegex(viewloom.ViewloomError, f"DATA_LOSS: .*{words}"):
                self.inbox.take().color
        messages = answers(1)
        messages[0].layout.size.height = 3
        self.add(messages)
        with self.assertRaisesRegex(viewloom.ViewloomError, "have 2 rows, the layout 3"):
            self.inbox.take().color

    def test_views_are_cut_by_order_and_padding(self):
        layout = atlas_pb2.AtlasLayout(
            size={"width": 7, "height": 5}, columns=2, rows=2, view_count=3, padding_top_px=1,
            padding_right_px=1, tile_size={"width": 3, "height": 2})
        picture = np.arange(35).reshape(5, 7)
        corners = {display_pb2.TILE_ORDER_BOTTOM_LEFT: [21, 24, 7],
                   display_pb2.TILE_ORDER_TOP_LEFT: [7, 10, 21]}
        for layout.order, firsts in corners.items():
            views = [viewloom.view_window(picture, layout, view) for view in range(3)]
            self.assertEqual([view[0, 0] for view in views], firsts)
            self.assertEqual({view.shape for view in views}, {(2, 3)})
        with self.assertRaisesRegex(viewloom.BadInput, "is 3, must lie in 0..2"):
            viewloom.view_window(picture, layout, 3)


if __name__ == "__main__":
    unittest.main()
