# SPDX-License-Identifier: Apache-2.0
"""A Bridge that has no display to show on: answers PUT as the real one does, and fetches what it is
told to play."""
import http.server
import json
import threading
import urllib.request

TOKEN = "0b7c9d5e"
PORTRAIT = {"hwid": "LKG-P02283", "hardwareVersion": "portrait", "index": 1, "state": "ok",
            "windowCoords": {"x": 1920, "y": 0}, "calibration": '{"pitch":{"value":52.5}}',
            "defaultQuilt": json.dumps({"quiltX": 336, "quiltY": 336, "tileX": 8, "tileY": 6,
                                        "quiltAspect": 0.75})}
MONITOR = {"hwid": "", "hardwareVersion": "thirdparty", "index": 0, "state": "ok",
           "windowCoords": {"x": 0, "y": 0}, "calibration": "", "defaultQuilt": ""}


def wrapped(value):
    return {"name": "", "type": "", "value": value}


class FakeBridge(http.server.ThreadingHTTPServer):
    """`answers` maps an endpoint to what is answered instead: bytes, (status, bytes), or None for
    silence. `calls` are (endpoint, arguments), `shown` the bytes of each entry played."""

    def __init__(self, displays=(MONITOR, PORTRAIT), port=0):
        super().__init__(("127.0.0.1", port), Handler)
        self.displays = displays
        self.answers = {}
        self.calls = []
        self.shown = []
        self.playlists = {}
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.serve_forever, daemon=True)
        self.thread.start()

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_address[1]}"

    def stop(self):
        self.ended.set()
        self.shutdown()
        self.thread.join()
        self.server_close()

    def names(self):
        return [endpoint for endpoint, _ in self.calls]

    def payload(self, endpoint, arguments):
        """None for what Bridge does not know."""
        if endpoint == "enter_orchestration":
            return wrapped(TOKEN)
        if arguments.get("orchestration") != TOKEN:
            return None
        if endpoint == "available_output_devices":
            return wrapped({str(i): wrapped({name: wrapped(value) for name, value in one.items()})
                            for i, one in enumerate(self.displays)})
        if endpoint == "instance_playlist":
            self.playlists[arguments["name"]] = []
        elif endpoint == "insert_playlist_entry":
            self.playlists[arguments["name"]].insert(arguments["index"], arguments)
        elif endpoint == "play_playlist":
            (entry,) = self.playlists[arguments["name"]]
            with urllib.request.urlopen(entry["uri"], timeout=60) as reply:
                self.shown.append(reply.read(200) if ".mjpg" in entry["uri"] else reply.read())
        elif endpoint not in ("show_window", "exit_orchestration"):
            return None
        return wrapped("")


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def answer(self, status, body):
        self.send_response(status)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Access-Control-Allow-Origin", "*")
        self.end_headers()
        self.wfile.write(body)

    def do_OPTIONS(self):
        """What a browser asks before it sends a page's PUT."""
        self.send_response(204)
        self.send_header("Access-Control-Allow-Origin", "*")
        self.send_header("Access-Control-Allow-Methods", "PUT")
        self.send_header("Access-Control-Allow-Headers", "content-type")
        self.send_header("Access-Control-Allow-Private-Network", "true")
        self.end_headers()

    def do_POST(self):
        self.answer(200, b"")

    do_GET = do_POST

    def do_PUT(self):
        endpoint = self.path[1:]
        body = self.rfile.read(int(self.headers["Content-Length"]))
        arguments = json.loads(body)
        assert self.headers["Content-Type"] == "application/json"
        self.server.calls.append((endpoint, arguments))
        if endpoint in self.server.answers:
            instead = self.server.answers[endpoint]
            if instead is None:
                self.server.ended.wait(60)
                self.close_connection = True
                return
            self.answer(*(instead if isinstance(instead, tuple) else (200, instead)))
            return
        payload = self.server.payload(endpoint, arguments)
        envelope = {"name": endpoint, "orchestration": wrapped(TOKEN), "payload": payload,
                    "status": {"value": "Completion"}}
        self.answer(200, b"" if payload is None else json.dumps(envelope).encode())

    def log_message(self, *_):
        pass
