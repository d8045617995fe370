# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and SIGTERM while a command of the client waits: for a connection, an answer, a retry, a
stream, a file. Argument: viewloom."""
import contextlib
import http.server
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

CLIENT = sys.argv.pop(1)
PATIENCE_S = 120
# Commands end within a second on a machine that does nothing else. None of these waits ends by
# itself before half a minute.
LIMIT_S = 10
SECONDS = "60"  # that `cast` waits for each answer
DISPLAY = {"index": 1, "hwid": "LKG-P00000", "calibration": "{}",
           "defaultQuilt": json.dumps({"quiltX": 64, "quiltY": 64, "tileX": 2, "tileY": 2,
                                       "quiltAspect": 1})}
LAYOUT = {"columns": 2, "rows": 2, "view_count": 4, "aspect": 1}


def wrapped(value):
    return {"name": "x", "payload": {"value": value}, "status": {"value": "Completion"}}


class Answers(http.server.BaseHTTPRequestHandler):
    """A Bridge and a page in one, which fall silent at one path."""
    silent_at = ""
    asked = threading.Event()
    end = threading.Event()

    def answer(self, status, value, **headers):
        body = json.dumps(value).encode()
        self.send_response(status)
        for name, text in {"Content-Length": str(len(body)), **headers}.items():
            self.send_header(name, text)
        self.end_headers()
        self.wfile.write(body)

    def is_silent(self):
        if not self.silent_at or self.silent_at not in self.path:
            return False
        self.asked.set()
        self.end.wait(PATIENCE_S)
        return True

    def do_GET(self):
        self.rfile.read(int(self.headers.get("Content-Length") or 0))
        if self.is_silent():
            return
        if "moved" in self.path:
            self.answer(200, LAYOUT)
        else:
            self.answer(302, {}, Location="moved.json?x=1")

    def do_PUT(self):
        self.rfile.read(int(self.headers.get("Content-Length") or 0))
        if self.is_silent():
            return
        values = {"/enter_orchestration": "token",
                  "/available_output_devices": {"0": {"value": {
                      name: {"value": value} for name, value in DISPLAY.items()}}}}
        self.answer(200, wrapped(values.get(self.path, "")))

    def log_message(self, *_):
        pass


@contextlib.contextmanager
def answering(silent_at=""):
    handler = type("Silent", (Answers,), {"silent_at": silent_at, "asked": threading.Event(),
                                          "end": threading.Event()})
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", handler
    finally:
        handler.end.set()
        server.shutdown()
        thread.join()
        server.server_close()


@contextlib.contextmanager
def nobody():
    """A port that refuses connections."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        yield f"127.0.0.1:{taken.getsockname()[1]}"


@contextlib.contextmanager
def hung():
    """Takes connections, and never says a word."""
    with socket.create_server(("127.0.0.1", 0), backlog=64) as listener:
        yield f"127.0.0.1:{listener.getsockname()[1]}"


@contextlib.contextmanager
def full():
    """Its queue of connections is full, so that further ones do not come about."""
    with contextlib.ExitStack() as stack:
        listener = stack.enter_context(socket.create_server(("127.0.0.1", 0), backlog=0))
        for _ in range(4):
            waiting = stack.enter_context(socket.socket())
            waiting.setblocking(False)
            waiting.connect_ex(listener.getsockname())
        yield f"127.0.0.1:{listener.getsockname()[1]}"


class Signals(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def ends(self, words, signal_, wait=lambda: time.sleep(1.5)):
        """Exit code and error output of a command that gets a signal while it waits."""
        errors = self.folder / "errors"
        with open(errors, "w", encoding="utf-8") as log, \
                subprocess.Popen([CLIENT, *map(str, words)], stdin=subprocess.DEVNULL,
                                 stdout=subprocess.DEVNULL, stderr=log) as process:
            try:
                wait()
                self.assertIsNone(process.poll(), f"{words}: does not wait: {errors.read_text()}")
                begun = time.monotonic()
                process.send_signal(signal_)
                code = process.wait(LIMIT_S)
                print(f"{time.monotonic() - begun:5.2f} s  {signal_.name:7}  {code:3}",
                      " ".join(map(str, words)), flush=True)
            finally:
                process.kill()
        return code, errors.read_text()

    def each(self, *commands, wait=lambda: time.sleep(1.5)):
        for words in commands:
            for signal_ in (signal.SIGINT, signal.SIGTERM):
                with self.subTest(words=words, signal=signal_.name):
                    self.ends(words, signal_, wait)

    def waiting_commands(self, address):
        server = ("--server", address)
        return ((*server, "watch", "nothere"),
                (*server, "record", "nothere", "--out", self.folder / "r.vlr"),
                (*server, "publish", "--synthetic", "--size", "64x36"),
                (*server, "publish", "--synthetic", "--size", "64x36", "--record",
                 self.folder / "p.vlr"),
                (*server, "publish", "--watch-folder", self.folder))

    def test_a_server_that_is_not_there(self):
        with nobody() as address:
            self.each(*self.waiting_commands(address))

    def test_a_server_that_never_answers(self):
        with hung() as address:
            self.each(*self.waiting_commands(address), ("--server", address, "list"),
                      ("--server", address, "advise", "--preset", "portrait", "--fov", "14",
                       "--near", "0.5", "--far", "3"),
                      ("--server", "https://" + address, "--fingerprint", "00" * 32, "watch"))

    def test_a_server_whose_queue_is_full(self):
        with full() as address:
            self.each(*self.waiting_commands(address)[:3], ("--server", address, "list"))

    def test_input_that_never_comes(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        with nobody() as address:
            server = ("--server", address)
            self.each((*server, "--token-file", pipe, "watch"), wait=lambda: time.sleep(0.5))

    def cast(self, bridge, address):
        return ("cast", "--bridge", bridge, "--address", address, "--timeout", SECONDS)

    def test_cast_while_an_answer_is_missing(self):
        places = ("enter_orchestration", "available_output_devices", "/still/demo",
                  "moved.json", "show_window", "instance_playlist", "insert_playlist_entry",
                  "play_playlist")
        for place in places:
            for signal_ in (signal.SIGINT, signal.SIGTERM):
                with self.subTest(place, signal=signal_.name), answering(place) as (url, handler):
                    code, errors = self.ends(self.cast(url, url), signal_,
                                             lambda asked=handler.asked: asked.wait(PATIENCE_S))
                    self.assertEqual(code, 1, errors)
                    self.assertIn("interrupted before the display showed", errors)

    def test_cast_while_it_leaves(self):
        with answering("exit_orchestration") as (url, handler):
            code, errors = self.ends(self.cast(url, url), signal.SIGINT,
                                     lambda: handler.asked.wait(PATIENCE_S))
            self.assertEqual(code, 0, errors)

    def test_cast_while_it_connects(self):
        with answering() as (url, _), hung() as silent, full() as unreachable:
            self.each(self.cast("http://" + silent, url), self.cast("http://" + unreachable, url),
                      self.cast(url, "http://" + silent), self.cast(url, "http://" + unreachable),
                      (*self.cast(url, "https://" + silent), "--fingerprint", "00" * 32))

    def test_the_last_line_of_a_publisher_counts_what_arrived(self):
        for place, words in ((nobody, "no server at"), (hung, "has not answered")):
            with self.subTest(place.__name__), place() as address:
                code, errors = self.ends(("--server", address, "publish", "--synthetic", "--size",
                                          "64x36", "--fps", "50"), signal.SIGINT)
                self.assertEqual(code, 3, errors)
                self.assertIn("; 0 sent, ", errors.splitlines()[-2], errors)
                self.assertIn(words, errors.splitlines()[-1], errors)


if __name__ == "__main__":
    unittest.main()
