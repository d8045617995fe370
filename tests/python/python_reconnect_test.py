# SPDX-License-Identifier: Apache-2.0
"""Publishers and watchers are back when a server is, and say what to do where there is none."""

import asyncio
import contextlib
import socket
import signal
import time
import unittest

import viewloomd  # takes its argument

import grpc
import numpy as np

import scene
import viewloom
from viewloom.retry import Backoff, SilenceWatch, is_passing

LOSSLESS = viewloom.encoding(lossless=True)


def flat(level):
    """A frame of one colour, and that colour."""
    color = np.full((scene.HEIGHT_PX, scene.WIDTH_PX, 3), level, np.uint8)
    return scene.source(color, np.full(color.shape[:2], scene.FAR_M, np.float32))


def level_of(atlas):
    return int(np.median(atlas.view(0)))


def unused_address():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return f"127.0.0.1:{free.getsockname()[1]}"


class Restarts(unittest.TestCase):
    """Of a server that ends in order, and of one that is killed."""

    def setUp(self):
        self.daemon = viewloomd.Viewloomd()
        self.addCleanup(lambda: self.daemon.stop())  # the one that is there then

    def end(self, is_killed):
        if is_killed:
            self.daemon.kill()
        else:
            self.daemon.stop()

    def begin(self):
        self.daemon = viewloomd.Viewloomd(self.daemon.address)

    def test_a_still_picture_is_published_and_watched_again(self):
        for is_killed in (False, True):
            stream = f"stands.{is_killed}"
            with self.subTest(stream), viewloom.connect(self.daemon.address) as server, \
                    server.publish(stream) as publisher, \
                    server.watch(stream, scene.own_place(), encoding=LOSSLESS,
                                 wait_for_stream=True) as watcher:
                publisher.send(flat(90)).result(viewloomd.PATIENCE_S)
                self.assertEqual(level_of(watcher.receive(viewloomd.PATIENCE_S)), 90)
                self.end(is_killed)
                self.begin()
                atlas = watcher.receive(viewloomd.PATIENCE_S)
                self.assertEqual((level_of(atlas), atlas.header.frame_number), (90, 1))
                publisher.send(flat(120)).result(viewloomd.PATIENCE_S)
                self.assertEqual(level_of(watcher.receive(viewloomd.PATIENCE_S)), 120)

    def test_frames_that_were_on_their_way_are_reported_after_the_restart(self):
        with viewloom.connect(self.daemon.address) as server, server.publish("moves") as publisher:
            publisher.send(flat(1)).result(viewloomd.PATIENCE_S)
            self.daemon.process.send_signal(signal.SIGSTOP)  # it reports nothing
            promises = [publisher.send(flat(level)) for level in (2, 3)]
            self.daemon.kill()
            self.begin()
            numbers = [promise.result(viewloomd.PATIENCE_S).number for promise in promises]
            self.assertEqual(numbers, [2, 3])
            self.assertEqual(level_of(server.still("moves", scene.own_place(),
                                                   encoding=LOSSLESS)), 3)

    def test_a_change_of_display_outlasts_a_restart(self):
        with viewloom.connect(self.daemon.address) as server, \
                server.publish("changed") as publisher, \
                server.watch("changed", scene.own_place(), wait_for_stream=True) as watcher:
            publisher.send(flat(90)).result(viewloomd.PATIENCE_S)
            self.assertEqual(watcher.receive(viewloomd.PATIENCE_S).layout.view_count, 1)
            self.end(is_killed=True)
            watcher.change(scene.cameras([-0.1, 0.1]))
            self.begin()
            self.assertEqual(watcher.receive(viewloomd.PATIENCE_S).layout.view_count, 2)

    def test_without_reconnecting_the_end_of_the_server_is_an_error(self):
        with viewloom.connect(self.daemon.address, reconnect=False) as server:
            publisher = server.publish("leaves")
            publisher.send(flat(90)).result(viewloomd.PATIENCE_S)
            watcher = server.watch("leaves", scene.own_place())
            watcher.receive(viewloomd.PATIENCE_S)
            self.end(is_killed=True)
            with self.assertRaises(viewloom.ViewloomError) as lost:
                watcher.receive(viewloomd.PATIENCE_S)
            self.assertEqual(lost.exception.status.name, "UNAVAILABLE")
            with self.assertRaises(viewloom.ViewloomError):
                publisher.close()
            self.begin()

    def test_whoever_has_nothing_on_its_way_may_close_while_the_server_is_away(self):
        with viewloom.connect(self.daemon.address) as server:
            publisher, watcher = server.publish("closes"), server.watch("closes", scene.own_place())
            publisher.send(flat(90)).result(viewloomd.PATIENCE_S)
            watcher.receive(viewloomd.PATIENCE_S)
            self.end(is_killed=True)
            time.sleep(0.3)  # both have noticed
            publisher.close()
            watcher.close()
        self.begin()
        with viewloom.connect(self.daemon.address) as server:
            self.assertEqual(server.streams(), [])

    def test_asyncio_is_back_too(self):
        async def run():
            async with contextlib.AsyncExitStack() as stack:
                enter = stack.enter_async_context
                server = await enter(viewloom.aio.connect(self.daemon.address))
                publisher = await enter(server.publish("stands"))
                watcher = await enter(server.watch("stands", scene.own_place(), encoding=LOSSLESS,
                                                   wait_for_stream=True))
                await (await publisher.send(flat(90)))
                self.assertEqual(level_of(await watcher.receive(viewloomd.PATIENCE_S)), 90)
                for is_killed in (False, True):
                    self.end(is_killed)
                    await asyncio.sleep(0.2)
                    self.begin()
                    atlas = await watcher.receive(viewloomd.PATIENCE_S)
                    self.assertEqual(level_of(atlas), 90)
                await (await publisher.send(flat(120)))
                self.assertEqual(level_of(await watcher.receive(viewloomd.PATIENCE_S)), 120)

        asyncio.run(run())

    def test_asyncio_closes_while_the_server_is_away(self):
        async def run():
            async with viewloom.aio.connect(self.daemon.address) as server:
                async with server.publish("closes") as publisher, \
                        server.watch("closes", scene.own_place(), wait_for_stream=True) as watcher:
                    await (await publisher.send(flat(90)))
                    await watcher.receive(viewloomd.PATIENCE_S)
                    self.end(is_killed=True)
                    await asyncio.sleep(0.3)

        asyncio.run(run())
        self.begin()


class Schedule(unittest.TestCase):
    def test_no_delay_outlasts_two_seconds_with_an_attempt(self):
        """However often a call was made in vain: 1.5 s at most, and the attempt itself."""
        lost = viewloom.ViewloomError(grpc.StatusCode.UNAVAILABLE, "", "away")
        backoff = Backoff()
        delays_s = [backoff.delay_s(lost) for _ in range(1000)]
        self.assertLessEqual(max(delays_s), 1.5)
        self.assertLess(delays_s[0], 0.2)
        self.assertGreater(len(set(delays_s)), 900)  # not all clients at once

    def test_what_the_server_refuses_stays_refused_and_what_the_line_did_passes(self):
        code = grpc.StatusCode

        def passes(status, message="", **more):
            return is_passing(viewloom.ViewloomError(status, "", message, **more))

        for status in (code.UNAVAILABLE, code.UNKNOWN, code.INTERNAL, code.RESOURCE_EXHAUSTED):
            self.assertTrue(passes(status), status)
        for status in (code.INVALID_ARGUMENT, code.NOT_FOUND, code.ABORTED, code.UNIMPLEMENTED):
            self.assertFalse(passes(status), status)
        self.assertFalse(passes(code.RESOURCE_EXHAUSTED, "too many streams", is_from_server=True))
        self.assertFalse(passes(code.RESOURCE_EXHAUSTED, "Received message larger than max"))
        self.assertTrue(passes(code.ALREADY_EXISTS, is_from_server=True, retry_delay_s=1.0))

    def test_a_server_is_silent_after_five_heartbeats_that_did_not_come(self):
        silence = SilenceWatch()
        self.assertFalse(any(silence.tick() for _ in range(100)))  # one that has none
        silence.hears(True)
        self.assertEqual([silence.tick() for _ in range(6)], [False] * 5 + [True])
        silence.hears(False)
        self.assertFalse(silence.tick())


class NoServer(unittest.TestCase):
    def told(self, call):
        with self.assertRaises(viewloom.ViewloomError) as absent:
            call()
        self.assertEqual(absent.exception.status.name, "UNAVAILABLE")
        return absent.exception.message

    def test_the_address_and_how_to_start_one_are_told(self):
        address = unused_address()
        with viewloom.connect(address) as server:
            for call in (lambda: server.publish("demo"),
                         lambda: server.still("demo", "portrait"), server.streams,
                         lambda: server.watch("demo", "portrait").receive(viewloomd.PATIENCE_S)):
                said = self.told(call)
                self.assertIn(f"no viewloomd answers at {address} (Connection refused)", said)
                self.assertIn("`viewloomd serve`", said)

        async def ask():
            async with viewloom.aio.connect(address) as server, server.publish("demo"):
                self.fail("there is no server")

        self.assertIn("`viewloomd serve`", self.told(lambda: asyncio.run(ask())))

    def test_an_address_of_the_page_or_with_a_scheme_is_told_from_that_of_grpc(self):
        for address in ("http://127.0.0.1:50051", "", "127.0.0.1: 50051", 50051):
            with self.assertRaises(viewloom.BadInput) as refused:
                viewloom.connect(address)
            self.assertEqual(refused.exception.field, "address")
        daemon = viewloomd.Viewloomd()
        self.addCleanup(daemon.stop)
        with viewloom.connect(daemon.url.split("/")[2]) as server:
            self.assertIn("not that of its page", self.told(server.streams))

    def test_a_host_without_a_port_means_the_port_of_viewloomd(self):
        for address, meant in (("localhost", "localhost:50051"), ("::1", "[::1]:50051"),
                               ("[::1]:7", "[::1]:7"), ("unix:/tmp/x", "unix:/tmp/x")):
            self.assertEqual(repr(viewloom.connect(address)), f"<viewloom.Server at {meant}>")


if __name__ == "__main__":
    unittest.main()
