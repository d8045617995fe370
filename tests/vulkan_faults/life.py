# SPDX-License-Identifier: Apache-2.0
"""A server above the layer with its clients, which live through one stage, again and again."""

import signal
import time

import viewloom

import scene
from clients import STREAM, Notes, Publishing, Watching
from faulted_server import FaultedServer
from stages import Moment

LOOK_S = 0.05
SETUP_S = 120.0
STOP_S = 15.0
BUSY_S = 1.0  # of frames that go on coming while the server stops
WATCHED = "watched"


class Life:
    """Starts at once. prepare: called with the board before the process starts. `connection` is
    None where the server ended before it listened."""

    def __init__(self, program, layer_folder, stage, pictures, prepare=None):
        self.stage = stage
        self.notes = Notes(pictures)
        self.server = FaultedServer(program, layer_folder, prepare, stage.warms_up)
        self.board = self.server.board
        self.connection = None
        self._clients = []
        self._is_prepared = False
        if self.server.address is None:
            return
        self.connection = viewloom.connect(self.server.address, reconnect=False)
        self._publishing = Publishing(self.connection, self.notes,
                                      lambda frame: scene.source(frame, stage.is_mirroring))
        self._clients = [self._publishing,
                         *(Watching(self.connection, self.notes, display)
                           for display in {WATCHED, stage.watched})]

    def start_clients(self):
        for client in self._clients:
            if not client.is_alive():
                client.start()

    def prepare(self):
        """Shows all that is served before a fault, as often as there is one."""
        if not self.stage.before:
            return
        self.start_clients()
        for frame in self.stage.before:
            if not self.serve(self.stage.watched, frame, SETUP_S):
                raise RuntimeError(f"no picture before the fault: {self.notes.refusals}"
                                   f"{self.notes.wrong}\n{self.server.log()}")
        if self.stage.moment is Moment.STOPPING:
            self._publishing.frames = self.stage.frames
            time.sleep(BUSY_S)

    def serve(self, display, frame, patience_s):
        """Whether that display and the watched one come to show that frame rightly."""
        self._publishing.frames = (frame,)
        deadline_s = time.monotonic() + patience_s
        while time.monotonic() < deadline_s and not self.notes.wrong and self.server.is_alive():
            if self._shows(display, frame, deadline_s) and self.notes.shows(WATCHED, frame):
                return True
            time.sleep(LOOK_S)
        return False

    def _shows(self, display, frame, deadline_s):
        try:
            atlas = self.connection.still(STREAM, scene.DISPLAYS[display],
                                          encoding=scene.LOSSLESS, wait_for_stream=True,
                                          timeout_s=max(LOOK_S, deadline_s - time.monotonic()))
        except viewloom.ViewloomError as error:
            self.notes.refuse(error)
            return False
        return self.notes.see(display, atlas) == frame

    def wait_for_kernels(self, patience_s):
        """Whether the server has said that its warm-up is over, or that it gives it up."""
        deadline_s = time.monotonic() + patience_s
        while time.monotonic() < deadline_s and self.server.is_alive():
            if "compiled" in self.server.log():
                return True
            time.sleep(LOOK_S)
        return False

    def stop(self, patience_s=STOP_S):
        """The exit code after SIGTERM; None where it hangs."""
        self.server.process.send_signal(signal.SIGTERM)
        return self.server.wait(max(STOP_S, patience_s))

    def close(self):
        for client in self._clients:
            client.stop()
        for client in self._clients:
            if client.is_alive():
                client.join(STOP_S)
        if self.connection:
            self.connection.close()
        self.server.close()
