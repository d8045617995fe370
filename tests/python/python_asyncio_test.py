# SPDX-License-Identifier: Apache-2.0
"""The asyncio half of the package against a real server, and beside the blocking half."""

import asyncio
import unittest

import viewloomd  # takes its argument

import numpy as np

import scene
import viewloom
from viewloom.v1 import ingest_service_pb2 as ingest

LOSSLESS = viewloom.encoding(lossless=True)
FRAMES = 6


def flat_source(level):
    color = np.full((scene.HEIGHT_PX, scene.WIDTH_PX, 3), level, np.uint8)
    return scene.source(color, scene.step_depth())


class Asyncio(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        self.daemon = viewloomd.Viewloomd()
        self.addCleanup(self.daemon.stop)
        self.server = viewloom.aio.connect(self.daemon.address)
        self.addAsyncCleanup(self.server.close)

    async def reported(self, publisher, source, **more):
        return await asyncio.wait_for(await publisher.send(source, **more), viewloomd.PATIENCE_S)

    async def refused(self, awaitable, status, field, words):
        with self.assertRaises(viewloom.ViewloomError) as refusal:
            await awaitable
        error = refusal.exception
        self.assertEqual((error.status.name, error.field), (status, field), error)
        self.assertIn(words, error.message)

    async def test_the_sources_own_view_is_the_picture_exactly(self):
        color = scene.noise_color()
        async with self.server.publish("scene") as publisher:
            report = await self.reported(publisher, scene.source(color, scene.step_depth()))
            self.assertEqual(report.outcome, ingest.FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY)
            still = await self.server.still("scene", scene.own_place(), encoding=LOSSLESS)
            np.testing.assert_array_equal(still.view(0), color)
            with viewloom.connect(self.daemon.address) as blocking:
                same = blocking.still("scene", scene.own_place(), encoding=LOSSLESS)
            np.testing.assert_array_equal(same.color, still.color)

    async def test_a_slow_reader_gets_the_newest_and_is_told_what_it_missed(self):
        async with self.server.publish("scene") as publisher, \
                self.server.watch("scene", scene.own_place(), encoding=LOSSLESS) as watcher:
            await publisher.send(flat_source(0))
            received = [await watcher.receive(viewloomd.PATIENCE_S)]
            for number in range(2, FRAMES + 1):
                await self.reported(publisher, flat_source(number * 20))
            while received[-1].header.frame_number < FRAMES:
                received.append(await anext(watcher))
            self.assertEqual([after.skipped for after in received[1:]],
                             [after.header.sequence - before.header.sequence - 1
                              for before, after in zip(received, received[1:])])
            np.testing.assert_array_equal(received[-1].color, FRAMES * 20)
            self.assertLess(len(received), FRAMES)

            await watcher.change(scene.quilt(2, 1))
            async for atlas in watcher:
                if atlas.layout.view_count == 2:
                    break

    async def test_eyes_that_move_are_followed(self):
        tracked = {"stereo": {"eye_size": {"width": 64, "height": 48}, "tracked": True}}
        async with self.server.publish("scene") as publisher, \
                self.server.watch("scene", tracked) as watcher:
            await publisher.send(flat_source(9))
            await watcher.send_eye_poses((-0.1, 0, 0), (0.2, 0, 0), time_ns=4)
            async for atlas in watcher:
                if atlas.header.eye_poses_time_ns == 4:
                    break
            self.assertEqual(atlas.layout.views[1].pose.position.x, 0.2)

    async def test_the_servers_clock_is_this_machines(self):
        async with self.server.publish("scene") as publisher, \
                self.server.watch("scene", scene.own_place()) as watcher:
            await publisher.send(flat_source(90))
            atlas = await anext(watcher)
            clock = await watcher.measure_clock(probes=3, timeout_s=viewloomd.PATIENCE_S)
            self.assertLessEqual(abs(clock.ahead_ns), clock.error_ns)
            await watcher.report_presented(atlas, 5)

    async def test_two_streams_at_once_on_one_connection(self):
        async def still_of(name, seed):
            color = scene.noise_color(seed)
            async with self.server.publish(name) as publisher:
                # Sent at once; frames of one stream keep their order.
                await asyncio.gather(*(publisher.send(flat_source(level)) for level in (1, 2, 3)))
                await self.reported(publisher, scene.source(color, scene.step_depth()))
                atlas = await self.server.still(name, scene.own_place(), encoding=LOSSLESS)
            np.testing.assert_array_equal(atlas.color, color)

        await asyncio.gather(still_of("left", 1), still_of("right", 2))

    async def test_refusals_name_the_field(self):
        async with self.server.publish("scene") as publisher:
            await self.reported(publisher, flat_source(1))
            await self.refused(self.server.still("scene", scene.quilt(0, 2)), "INVALID_ARGUMENT",
                               "open.display.quilt.columns", "0")
            async with self.server.watch("elsewhere", "portrait") as watcher:
                await self.refused(watcher.receive(), "NOT_FOUND", "open.stream", "scene")
            await self.refused(self.server.publish("scene").__aenter__(), "ALREADY_EXISTS",
                               "settings.stream", "scene")
            await self.refused(publisher.send(viewloom.Source(1, 2)), "INVALID_ARGUMENT", "color",
                               "int")
            await self.reported(publisher, flat_source(2))

    async def test_a_refused_frame_ends_the_call_and_says_why(self):
        exposure = "INVALID_ARGUMENT", "header.exposure_ev", "-32..32"
        with self.assertRaisesRegex(viewloom.ViewloomError, "exposure_ev"):
            async with self.server.publish("scene") as publisher:
                await self.refused(self.reported(publisher, flat_source(1), exposure_ev=99),
                                   *exposure)
                await self.refused(publisher.send(flat_source(1)), *exposure)

    async def test_the_catalogue_tells_what_there_is(self):
        async with self.server.publish("scene") as publisher, \
                self.server.watch("scene", scene.quilt(2, 1)) as watcher:
            await self.reported(publisher, flat_source(1))
            await anext(watcher)
            self.assertEqual([s.name for s in await self.server.streams()], ["scene"])
            self.assertEqual([d.stream for d in await self.server.displays()], ["scene"])
            self.assertIn("portrait", [preset.name for preset in await self.server.presets()])
            info = await self.server.server_info()
            self.assertEqual(info.ingest_limits, publisher.accepted)
            self.assertEqual(publisher.wanted.display_count, 1)

    async def test_a_source_is_advised_as_by_the_blocking_half(self):
        display = {"quilt": {"preset": "portrait", "fov_y_rad": 0.25}}
        with viewloom.connect(self.daemon.address) as blocking:
            self.assertEqual(await self.server.advise_source(display, 0.5, 3),
                             blocking.advise_source(display, 0.5, 3))
        await self.refused(self.server.advise_source(display, 0, 3), "INVALID_ARGUMENT", "near_m",
                           "0")

    async def test_waiting_has_an_end_and_can_be_given_up(self):
        async with self.server.watch("later", "portrait", wait_for_stream=True) as watcher:
            await self.refused(watcher.receive(timeout_s=0.01), "DEADLINE_EXCEEDED", "", "0.01 s")
        self.assertIsNone(await watcher.receive(), "closed")
        await self.refused(self.server.still("later", "portrait", wait_for_stream=True,
                                             timeout_s=0.05), "DEADLINE_EXCEEDED", "", "")
        with self.assertRaises(asyncio.TimeoutError):
            await asyncio.wait_for(
                self.server.still("later", "portrait", wait_for_stream=True), 0.05)

    async def test_a_server_that_leaves_is_an_error_without_reconnecting(self):
        async with viewloom.aio.connect(self.daemon.address, reconnect=False) as server:
            publisher = await server.publish("scene").__aenter__()
            async with server.watch("scene", "portrait") as watcher:
                self.daemon.process.terminate()
                await self.refused(watcher.receive(), "UNAVAILABLE", "", "")
            await self.refused(publisher.close(), "UNAVAILABLE", "", "")


if __name__ == "__main__":
    unittest.main()
