# SPDX-License-Identifier: Apache-2.0
"""H.264 from a real server, as numpy pictures: against the same atlas without loss. Argument:
viewloomd."""

import unittest

import numpy as np

import scene
import viewloom
import viewloomd
from viewloom.v1 import atlas_pb2


class ServedVideo(unittest.TestCase):
    def setUp(self):
        daemon = viewloomd.Viewloomd()
        self.addCleanup(daemon.stop)
        self.server = viewloom.connect(daemon.address)
        self.addCleanup(self.server.close)
        self.publisher = self.server.publish("scene")
        self.addCleanup(self.publisher.close)
        self.publisher.send(scene.source(scene.smooth_color(), scene.step_depth()))

    def stills(self, display):
        """One frame, as video and without loss, both with depth and mask."""
        return [self.server.still("scene", display, wait_for_stream=True,
                                  timeout_s=viewloomd.PATIENCE_S, encoding=viewloom.encoding(
                                      depth=True, mask=True, **color))
                for color in ({"h264": True, "video_qp": 20}, {"lossless": True})]

    def test_views_depth_and_mask_are_those_of_lossless_atlases(self):
        for display in (scene.quilt(4, 3), scene.own_place(),
                        scene.cameras([-0.1, 0.0, 0.1, 0.2, 0.3], columns=2)):
            video, exact = self.stills(display)
            self.assertEqual(video.layout.encoding.color, atlas_pb2.BAND_ENCODING_H264)
            self.assertEqual(video.layout.video.codec_string[:5], "avc1.")
            self.assertEqual(video.color.shape, exact.color.shape)
            error = video.color.astype(float) - exact.color
            self.assertLess(np.sqrt(np.mean(error ** 2)), 4)
            self.assertLess(np.abs(error.mean(axis=(0, 1))).max(), 1)
            np.testing.assert_array_equal(video.inv_z, exact.inv_z)
            np.testing.assert_array_equal(video.mask, exact.mask)

    def test_displays_that_are_no_views_are_refused(self):
        with self.assertRaisesRegex(viewloom.ViewloomError, "H264"):
            self.server.still("scene", "near_eye_2013", encoding=viewloom.encoding(h264=True),
                              wait_for_stream=True, timeout_s=viewloomd.PATIENCE_S)


if __name__ == "__main__":
    unittest.main()
