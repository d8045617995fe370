# SPDX-License-Identifier: Apache-2.0
"""Things that a document expects beside its commands: the server with the stream demo, a screen,
Looking Glass Bridge, a front. Each starts when a block needs it."""

import pathlib
import re
import socket
import sys
import time

from front_beside import FrontBeside
from running import Failure, Running
from server_lists import ServerLists

FOLDER = pathlib.Path(__file__).parent
sys.path[:0] = [str(FOLDER.parent / "show"), str(FOLDER.parent / "web")]
from fake_bridge import FakeBridge  # noqa: E402
from screen import Screen  # noqa: E402

import samples  # noqa: E402

PORTS = (50051, 8080)
BRIDGE_PORT = 33334
PORT_PATIENCE_S = 60
PATIENCE_S = 60
DEMO = "viewloom publish --synthetic --size 320x180 --rate 5 --quiet"
STARTS_A_SERVER = re.compile(r"\bviewloomd (serve|doctor)\b|^(\$ )?deploy/demo\.sh", re.MULTILINE)
CALLS_A_SERVER = re.compile(r"\bviewloom (publish|watch (?!--from)|show|record|cast|list|advise)\b"
                            r"|//127\.0\.0\.1:8080|viewloom\.(aio\.)?connect\(|examples/\w+\.py"
                            r"|watch_quilt\.js|^/(still|stream|ws)\b", re.MULTILINE)
BEHIND_A_FRONT = re.compile(r"https://viewloom\.example")
PUBLISHES_DEMO = re.compile(r"\bviewloom publish (?!.*--stream)|publish\(\"demo\"\)")


def wait_for_free_ports(ports, patience_s=PORT_PATIENCE_S):
    """Documents use the default ports, which a demo or another suite may have."""
    deadline = time.monotonic() + patience_s
    for port in ports:
        while True:
            with socket.socket() as one:
                one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                try:
                    one.bind(("127.0.0.1", port))
                    break
                except OSError:
                    if time.monotonic() > deadline:
                        raise Failure(f"port {port} is taken: stop what uses it, such as "
                                      "deploy/demo.sh, and run the test again") from None
            time.sleep(0.2)


class Served:
    def __init__(self, workplace):
        self._workplace = workplace
        self._server = self._demo = self._screen = self._front = self.bridge = None
        self.lists = ServerLists(workplace)

    def prepare(self, text, has_server=False):
        """Starts the things that a block needs, and stops those that are in its way. has_server:
        one of the document is running."""
        if BEHIND_A_FRONT.search(text) and not self._front:
            self._front = FrontBeside(PORTS)
        if STARTS_A_SERVER.search(text):
            self._stop_server()
            wait_for_free_ports(PORTS)
        elif CALLS_A_SERVER.search(text) and not has_server:
            self._start_server()
            if PUBLISHES_DEMO.search(text):
                self._stop_demo()
            elif not self._demo:
                self._demo = self._started(DEMO)
                self.wait_for_stream(self._demo, "demo")
        if re.search(r"\bviewloom show\b", text) and not self._screen:
            self._screen = Screen(*samples.SCREEN_PX)
        if re.search(r"\bviewloom cast\b", text) and not self.bridge:
            wait_for_free_ports([BRIDGE_PORT])
            self.bridge = FakeBridge(port=BRIDGE_PORT)

    def environment(self):
        found = dict(self._front.environment) if self._front else {}
        if self._screen:
            found.update({name: value for name, value in self._screen.environment().items()
                          if name in ("DISPLAY", "SDL_VIDEODRIVER", "LIBGL_ALWAYS_SOFTWARE")})
        return found

    def has_picture(self):
        """True if the screen shows something other than a black desktop."""
        return self._screen.picture().any()

    def wait_for_black_screen(self):
        """The window of the last command may need a moment to go."""
        deadline = time.monotonic() + PATIENCE_S
        while self.has_picture():
            if time.monotonic() > deadline:
                raise Failure("the screen still shows a picture of the command before")
            time.sleep(0.1)

    def used_count(self, stream):
        """How many frames of the stream the server has taken, and told their publisher so."""
        return next((entry["used_count"] for entry in self.lists.read("streams")
                     if entry["name"] == stream), 0)

    def atlas_counts(self):
        """How many atlases each watched display has had."""
        return {entry["id"]: entry["atlas_count"] for entry in self.lists.read("displays")}

    def wait_for_stream(self, command, stream):
        before = self.used_count(stream)
        command.wait_for(lambda: self.used_count(stream) > before,
                         f"frames of the stream {stream}", PATIENCE_S)

    def _started(self, text):
        path = f"{self._workplace.viewloom.parent}:{self._workplace.environment()['PATH']}"
        return Running(text.replace("viewloom ", f"{self._workplace.viewloom} ", 1),
                       self._workplace, PATH=path)

    def _start_server(self):
        if self._server:
            return
        wait_for_free_ports(PORTS)
        self.lists.forget()
        self._server = Running("viewloomd serve", self._workplace)
        self._server.wait_for(lambda: "listening" in self._server.said(), "its addresses",
                              PATIENCE_S)

    def _stop_demo(self):
        if self._demo:
            self._demo.stop(PATIENCE_S)
            self._demo = None

    def _stop_server(self):
        self._stop_demo()
        if self._server:
            self._server.stop(PATIENCE_S)
            self._server = None

    def stop(self):
        """In order. Raises what the server or its publisher did wrong."""
        self._stop_server()

    def kill(self):
        """Everything that still runs."""
        for one in (self._demo, self._server):
            if one:
                one.kill()
        if self._front:
            self._front.close()
        if self._screen:
            self._screen.close()
        if self.bridge:
            self.bridge.stop()
        self._demo = self._server = self._screen = self._front = self.bridge = None
