# SPDX-License-Identifier: Apache-2.0
"""A publisher and a viewer that call again whenever they are refused, and never wait for ever."""

import itertools
import threading

import viewloom

import scene

STREAM = "scene"
PERIOD_S = 0.1
AGAIN_S = 0.05
RECEIVE_S = 0.5


class Notes:
    """What clients saw. Thread-safety: all methods may be called from any thread."""

    def __init__(self, pictures):
        self.pictures = pictures
        self.wrong = []     # pictures that should not be
        self.refusals = []  # sentences of the server
        self._lock = threading.Lock()
        self._newest = {}   # display: frame

    def see(self, display, atlas):
        """The frame that the atlas shows; None where it is wrong."""
        found = self.pictures.found(display, atlas)
        with self._lock:
            if found:
                self.wrong.append(found)
                return None
            self._newest[display] = atlas.header.capture_time_ns
            return atlas.header.capture_time_ns

    def clear(self):
        """Begins anew. What the displays show stays known."""
        with self._lock:
            self.wrong, self.refusals = [], []

    def taken(self):
        """Wrong pictures and refusals so far."""
        with self._lock:
            return list(self.wrong), list(self.refusals)

    def refuse(self, error):
        with self._lock:
            self.refusals.append(str(error))

    def shows(self, display, frame):
        """Whether the newest picture of that display is of that frame."""
        with self._lock:
            return self._newest.get(display) == frame


class Client(threading.Thread):
    """Calls again and again until stop()."""

    def __init__(self, server, notes):
        super().__init__(daemon=True)
        self.server = server
        self.notes = notes
        self.stopping = threading.Event()

    def run(self):
        while not self.stopping.is_set():
            try:
                self.call()
            except viewloom.ViewloomError as error:
                if not self.stopping.is_set():
                    self.notes.refuse(error)
            self.stopping.wait(AGAIN_S)

    def stop(self):
        self.stopping.set()


class Publishing(Client):
    """Sends its frames in turn, ten a second. One alone the server drops while it has it."""

    def __init__(self, server, notes, make_source):
        super().__init__(server, notes)
        self.make_source = make_source
        self.frames = (scene.FIRST,)

    def call(self):
        with self.server.publish(STREAM, in_flight_max=2) as publisher:
            for number in itertools.count():
                if self.stopping.wait(PERIOD_S):
                    return
                frames = self.frames
                frame = frames[number % len(frames)]
                report = publisher.send(self.make_source(frame), capture_time_ns=frame)
                report.add_done_callback(self.note)

    def note(self, report):
        error = report.exception()
        if error and not self.stopping.is_set():
            self.notes.refuse(error)


class Watching(Client):
    """Watches one display all the time."""

    def __init__(self, server, notes, display):
        super().__init__(server, notes)
        self.display = display

    def call(self):
        with self.server.watch(STREAM, scene.DISPLAYS[self.display], encoding=scene.LOSSLESS,
                               wait_for_stream=True) as watcher:
            while not self.stopping.is_set():
                try:
                    atlas = watcher.receive(RECEIVE_S)
                except viewloom.ViewloomError as error:
                    if error.status.name == "DEADLINE_EXCEEDED":
                        continue
                    raise
                if atlas is None:
                    return
                self.notes.see(self.display, atlas)
