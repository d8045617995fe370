# SPDX-License-Identifier: Apache-2.0
"""One stage of a server's life, with one fault or none."""

import time

from judge import Outcome
from life import Life
from stages import Moment


def arm(board, fault):
    if fault:
        board.arm(fault.function, fault.number, fault.result, fault.stays_lost)


def born(program, layer_folder, stage, pictures, fault=None):
    """A server for that stage. If its start is the stage, its start has the fault."""
    prepare = (lambda board: arm(board, fault)) if stage.moment is Moment.START else None
    return Life(program, layer_folder, stage, pictures, prepare)


class Trial:
    """Runs at once; its result is `outcome`. patience_s: how long a picture, or the end of a
    process, is waited for. The life may go on with another trial if `is_reusable`."""

    def __init__(self, life, fault=None, patience_s=20.0, clean_s=0.0):
        self.life, self.stage, self.board = life, life.stage, life.board
        self.patience_s = patience_s
        self.outcome = Outcome(life.stage.name, fault, clean_s=clean_s)
        life.notes.clear()
        self._fault_count = 0
        if life.connection:
            life.prepare()
            if self.stage.moment is not Moment.START:
                self._fault_count = self.board.fault_count()
            self._live()
        else:
            self.outcome.had_started = False
            life.server.wait()
        self._note_end()

    @property
    def is_reusable(self):
        return (self.stage.moment is Moment.SERVING and bool(self.stage.before) and
                self.life.server.is_alive() and not self.outcome.wrong and
                (not self.outcome.has_failed or self.outcome.again_s is not None))

    def _has_failed(self):
        return self.board.fault_count() > self._fault_count

    def _live(self):
        before = self.board.counts()
        if self.stage.moment is Moment.START:
            self.outcome.counts = before
        else:
            arm(self.board, self.outcome.fault)
        self.life.start_clients()
        if self.stage.moment is Moment.STOPPING:
            self.outcome.was_stopping = True
            self.life.stop(self.patience_s)
        else:
            self._serve()
        self.board.disarm()
        if self.stage.moment is not Moment.START:
            after = self.board.counts()
            self.outcome.counts = {name: count - before.get(name, 0)
                                   for name, count in after.items() if count > before.get(name, 0)}

    def _serve(self):
        """All that is to be served with the fault. If that fails, the process has time to end."""
        begun_s = time.monotonic()
        is_served = not self.stage.warms_up or self.life.wait_for_kernels(6 * self.patience_s)
        for frame in self.stage.frames:
            had_failed = self._has_failed()
            is_served = is_served and self.life.serve(self.stage.display, frame, self.patience_s)
            if is_served and self._has_failed() and not had_failed:
                self._note_again()
        self.outcome.clean_s = self.outcome.clean_s or time.monotonic() - begun_s
        if not is_served:
            self.outcome.again_s = None
            if self._has_failed() and not self.life.notes.wrong:
                self.life.server.wait(self.patience_s)
        elif self._has_failed() and self.outcome.again_s is None:
            self._note_again()

    def _note_again(self):
        self.outcome.again_s = time.monotonic() - self.board.fault_s()

    def _note_end(self):
        outcome, server = self.outcome, self.life.server
        outcome.has_failed = self._has_failed()
        outcome.wrong, outcome.refusals = self.life.notes.taken()
        outcome.log = server.log()
        if server.is_alive():
            return
        server.wait()
        outcome.exit_code = server.process.returncode
        outcome.end_s = server.ended_s - (self.board.fault_s() if outcome.has_failed
                                          else server.ended_s)
