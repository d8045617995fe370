# SPDX-License-Identifier: Apache-2.0
"""One server, one stage, one fault or none."""

import signal
import time

import viewloom

import scene
from clients import STREAM, Notes, Publishing, Watching
from faulted_server import FaultedServer
from judge import Outcome
from stages import Moment

LOOK_S = 0.05
SETUP_S = 120.0
STOP_S = 15.0
BUSY_S = 1.0  # of frames that go on coming while the server stops
WATCHED = "watched"


class Trial:
    """Runs at once; its result is `outcome`. patience_s: how long a picture, or the end of a
    process, is waited for."""

    def __init__(self, program, layer_folder, stage, pictures, fault=None, patience_s=20.0,
                 clean_s=0.0):
        self.stage, self.fault, self.patience_s = stage, fault, patience_s
        self.notes = Notes(pictures)
        self.outcome = Outcome(stage.name, fault, clean_s=clean_s)
        begun_s = time.monotonic()
        prepare = self._arm if stage.moment is Moment.START else None
        self.server = FaultedServer(program, layer_folder, prepare, stage.warms_up)
        try:
            self._run()
        finally:
            self.server.close()
        self.outcome.took_s = time.monotonic() - begun_s

    def _run(self):
        if self.server.address is None:
            self.outcome.had_started = False
        else:
            self._meet_clients()
        self._note_end()

    def _meet_clients(self):
        with viewloom.connect(self.server.address, reconnect=False) as self.connection:
            self.publishing = Publishing(
                self.connection, self.notes,
                lambda frame: scene.source(frame, self.stage.is_mirroring))
            clients = [self.publishing, *(Watching(self.connection, self.notes, display)
                                          for display in {WATCHED, self.stage.watched})]
            try:
                self._live(clients)
            finally:
                for client in clients:
                    client.stop()
                for client in clients:
                    if client.is_alive():
                        client.join(STOP_S)

    def _live(self, clients):
        if self.stage.before:
            self._prepare(clients)
        counts = self.server.board.counts()
        if self.stage.moment is Moment.START:
            self.outcome.counts = counts
        else:
            self._arm(self.server.board)
        if not self.stage.before:
            for client in clients:
                client.start()
        if self.stage.moment is Moment.STOPPING:
            self._stop()
            self._count(counts)
            return
        self._serve()
        if self.stage.moment is Moment.SERVING:
            self._count(counts)
        self._stop()

    def _prepare(self, clients):
        """All that is served before the fault."""
        for client in clients:
            client.start()
        for frame in self.stage.before:
            if not self._is_served(self.stage.watched, frame, SETUP_S):
                raise RuntimeError(f"no picture before the fault: {self.notes.refusals}"
                                   f"{self.notes.wrong}\n{self.server.log()}")
        if self.stage.moment is Moment.STOPPING:
            self.publishing.frames = self.stage.frames
            time.sleep(BUSY_S)

    def _serve(self):
        """All that is to be served with the fault."""
        outcome, board = self.outcome, self.server.board
        begun_s = time.monotonic()
        is_served = not self.stage.warms_up or self._warm_up()
        is_served = is_served and all(
            self._is_served(self.stage.display, frame, self.patience_s)
            for frame in self.stage.frames)
        outcome.clean_s = outcome.clean_s or time.monotonic() - begun_s
        if is_served and board.fault_count() and outcome.again_s is None:
            outcome.again_s = time.monotonic() - board.fault_s()

    def _count(self, before):
        after = self.server.board.counts()
        self.outcome.counts = {name: count - before.get(name, 0) for name, count in after.items()
                               if count > before.get(name, 0)}

    def _arm(self, board):
        if self.fault:
            board.arm(self.fault.function, self.fault.number, self.fault.result,
                      self.fault.stays_lost)

    def _is_served(self, display, frame, patience_s):
        """Whether that display and the watched one come to show that frame rightly."""
        self.publishing.frames = (frame,)
        deadline_s = time.monotonic() + patience_s
        had_failed = self.server.board.fault_count()
        while time.monotonic() < deadline_s and not self.notes.wrong:
            if self.server.process.poll() is not None:
                return False
            try:
                atlas = self.connection.still(STREAM, scene.DISPLAYS[display],
                                              encoding=scene.LOSSLESS, wait_for_stream=True,
                                              timeout_s=deadline_s - time.monotonic())
                is_shown = self.notes.see(display, atlas) == frame
            except viewloom.ViewloomError as error:
                self.notes.refuse(error)
                is_shown = False
            if is_shown and self.notes.shows(WATCHED, frame):
                if self.server.board.fault_count() > had_failed:
                    self.outcome.again_s = time.monotonic() - self.server.board.fault_s()
                return True
            time.sleep(LOOK_S)
        return False

    def _warm_up(self):
        """Whether it has said that it is over, or that it gives up."""
        deadline_s = time.monotonic() + 6 * self.patience_s
        while time.monotonic() < deadline_s and self.server.is_alive():
            if "compiled" in self.server.log():
                return True
            time.sleep(LOOK_S)
        return False

    def _stop(self):
        """A server that ended by itself, or will, is given its time for that."""
        outcome = self.outcome
        is_stopping = self.stage.moment is Moment.STOPPING
        has_fault = self.server.board.fault_count() and not self.notes.wrong
        if not is_stopping and outcome.again_s is None and has_fault:
            self.server.wait(self.patience_s)
        if not self.server.is_alive():
            return
        outcome.was_stopping = is_stopping
        self.server.process.send_signal(signal.SIGTERM)
        outcome.stop_code = self.server.wait(max(STOP_S, self.patience_s))

    def _note_end(self):
        outcome, board = self.outcome, self.server.board
        if not outcome.had_started:
            self.server.wait()
        outcome.has_failed = board.fault_count() > 0
        outcome.wrong, outcome.refusals = self.notes.wrong, self.notes.refusals
        outcome.log = self.server.log()
        is_end = not outcome.had_started or outcome.stop_code is None or outcome.was_stopping
        if is_end and not self.server.is_alive():
            outcome.exit_code = self.server.process.returncode
            since_s = board.fault_s() if outcome.has_failed else self.server.ended_s
            outcome.end_s = self.server.ended_s - since_s
