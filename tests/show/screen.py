# SPDX-License-Identifier: Apache-2.0
"""A screen in memory (Xvfb), programs on it, pictures of it and keys pressed on it."""

import os
import subprocess
import tempfile
import time

import numpy
from PIL import ImageGrab

PATIENCE_S = 120


def wait_for(condition, what):
    """The first true value of condition()."""
    deadline = time.monotonic() + PATIENCE_S
    while time.monotonic() < deadline:
        if found := condition():
            return found
        time.sleep(0.05)
    raise AssertionError(f"waited {PATIENCE_S} s for {what}")


class Screen:
    """One monitor of width x height px."""

    def __init__(self, width, height):
        ready, tell = os.pipe()
        self._server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(tell), "-screen", "0", f"{width}x{height}x24", "-noreset",
             "-nolisten", "tcp"], pass_fds=[tell], stderr=subprocess.DEVNULL)
        os.close(tell)
        with os.fdopen(ready) as number:
            self.name = f":{int(number.readline())}"

    def close(self):
        self._server.terminate()
        self._server.wait(PATIENCE_S)

    def environment(self):
        return dict(os.environ, DISPLAY=self.name, SDL_VIDEODRIVER="x11", LIBGL_ALWAYS_SOFTWARE="1")

    def picture(self):
        """uint8[height][width][3], top row first."""
        return numpy.asarray(ImageGrab.grab(xdisplay=self.name).convert("RGB"))

    def press(self, key):
        subprocess.run(["xdotool", "key", key], env=self.environment(), check=True)


class Show:
    """`viewloom show` on a screen."""

    def __init__(self, viewloom, screen, server, *arguments, stdin=None):
        self._said = tempfile.TemporaryFile("w+")
        environment = screen.environment() if screen else \
            {name: value for name, value in os.environ.items()
             if name not in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")}
        self._process = subprocess.Popen(
            [viewloom, "--server", server, "show", "known", *map(str, arguments)],
            env=environment, stdin=stdin, stderr=self._said)

    def said(self):
        self._said.seek(0)
        return self._said.read()

    def exit_code(self):
        """Waits for the end."""
        return self._process.wait(PATIENCE_S)

    def close(self):
        if self._process.poll() is None:
            self._process.terminate()
        self._process.wait(PATIENCE_S)
        self._said.close()
