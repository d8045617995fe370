# SPDX-License-Identifier: Apache-2.0
"""deploy/Containerfile keeps its rules, read without a container tool, and each rule catches what
it forbids.

containerfile_test.py [VIEWLOOMD]
"""

import http.server
import os
import pathlib
import re
import subprocess
import sys
import threading
import tomllib
import unittest

import containerfile
import containerfile_rules

ROOT = pathlib.Path(__file__).parents[2]
SERVER = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None
TEXT = (ROOT / "deploy" / "Containerfile").read_text(encoding="utf-8")
PATIENCE_S = 60


def default_ports():
    with open(ROOT / "deploy" / "viewloomd.example.toml", "rb") as file:
        settings = tomllib.load(file)
    return {kind: settings[kind]["address"].rpartition(":")[2] for kind in ("grpc", "http")}


def built_folders():
    lists = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return [name for name in re.findall(r"add_subdirectory\((\w+)\)", lists) if name != "tests"]


def broken(text):
    """What is wrong with a Containerfile."""
    stages = containerfile.stages_of(text)
    return [what for _, what in containerfile_rules.check(
        stages, lambda path: (ROOT / path).exists(), built_folders(), default_ports())]


class TheFile(unittest.TestCase):
    def test_it_keeps_the_rules(self):
        self.assertEqual(broken(TEXT), [])

    def test_it_is_the_only_one(self):
        found = [file.name for folder in (ROOT, ROOT / "deploy") for file in folder.iterdir()
                 if re.match(r"(Docker|Container)file|.*\.dockerfile", file.name)]
        self.assertEqual(found, ["Containerfile"])


class Rules(unittest.TestCase):
    def changed(self, before, after):
        """What is wrong once a part of the file is another."""
        self.assertIn(before, TEXT)
        return "\n".join(broken(TEXT.replace(before, after)))

    def test_another_system_is_found(self):
        for image in ("alpine:3", "debian:latest", "debian", "ghcr.io/x/debian:bookworm-slim"):
            self.assertIn(f"image {image}", self.changed("FROM debian:bookworm-slim\n",
                                                         f"FROM {image}\n"))

    def test_software_from_elsewhere_is_found(self):
        for command in ("curl https://x.org/a", "pip install grpcio", "npm ci", "git clone x",
                        "env pip install x"):
            self.assertIn(f"RUN {command.split()[0]}: accepted is",
                          self.changed("RUN cmake", f"RUN {command} && cmake"))
        self.assertIn("plain commands", self.changed("RUN cmake", "RUN cmake | sh; cmake"))
        with self.assertRaisesRegex(containerfile.Unreadable, "ADD is not accepted"):
            broken(TEXT.replace("COPY proto", "ADD proto"))

    def test_sources_that_are_not_there_are_found(self):
        for source in ("gone", "/etc", "../secret"):
            self.assertIn(f"COPY {source}: the tree has no such",
                          self.changed("COPY deploy deploy/", f"COPY deploy {source} deploy/"))
        self.assertIn("shaders is not copied", self.changed("COPY shaders shaders/\n", ""))
        self.assertIn("no such stage", self.changed("--from=build", "--from=other"))

    def test_a_server_with_rights_is_found(self):
        for user in ("", "USER root\n", "USER 0\n", "USER viewloom\nUSER 0:0\n"):
            self.assertIn("must not be root", self.changed("USER viewloom\n", user))
        self.assertIn("RUN after USER", self.changed("USER viewloom\n",
                                                     "USER viewloom\nRUN rm -rf /x\n"))

    def test_other_ports_are_found(self):
        self.assertIn("EXPOSE 50051 8081", self.changed("EXPOSE 8080", "EXPOSE 8081"))
        self.assertIn("VIEWLOOM_HTTP_ADDRESS must be",
                      self.changed("ADDRESS=0.0.0.0:8080", "ADDRESS=127.0.0.1:8080"))
        self.assertIn("VIEWLOOM_OPEN must be", self.changed(" VIEWLOOM_OPEN=true", ""))

    def test_a_server_that_gets_no_signals_or_is_never_asked_is_found(self):
        self.assertIn("ENTRYPOINT must", self.changed('["viewloomd"]', "viewloomd"))
        self.assertIn("CMD must", self.changed('CMD ["serve"]', 'CMD ["doctor"]'))
        self.assertIn("/healthz", self.changed("GET /healthz", "GET /"))
        self.assertIn("/healthz", self.changed("HEALTHCHECK --interval=30s", "LABEL a=b"))

    def test_a_single_stage_is_found(self):
        only = TEXT[:TEXT.index("FROM debian:bookworm-slim\n")]
        self.assertIn("must not be in the image that runs them", "\n".join(broken(only)))

    def test_lines_that_no_tool_takes_are_refused(self):
        for text, words in (("RUN x\n", "before the first FROM"), ("", "no FROM"),
                            ("FROM debian:bookworm\nRUM x\n", "line 2: RUM is not accepted"),
                            ("FROM debian:bookworm\nRUN x \\\n", "ends in a backslash"),
                            ("FROM debian:bookworm\nUSER\n", "says nothing"),
                            ("FROM a b c\n", "FROM takes IMAGE")):
            with self.assertRaisesRegex(containerfile.Unreadable, words):
                broken(text)
        with self.assertRaisesRegex(containerfile.Unreadable, "line 2: "):
            broken('FROM debian:bookworm\nCMD ["a"\n')


class Image(unittest.TestCase):
    def test_an_engine_builds_it(self):
        """Not here: it compiles everything."""
        reasons = []
        for engine in ("podman", "docker"):
            try:
                subprocess.run([engine, "info"], check=True, capture_output=True,
                               timeout=PATIENCE_S)
                self.skipTest(f"{engine} answers: `tests/full.sh container` builds the image")
            except FileNotFoundError:
                reasons.append(f"there is no {engine}")
            except subprocess.SubprocessError as problem:
                said = (problem.stderr or b"").decode().strip().splitlines()[-1:]
                reasons.append(f"{engine} does not answer: {' '.join(said)}")
        self.skipTest("; ".join(reasons))


class Refusing(http.server.BaseHTTPRequestHandler):
    """A server that drains."""

    def do_GET(self):  # pylint: disable=invalid-name
        self.send_error(503)

    def log_message(self, *_):  # pylint: disable=arguments-differ
        pass


@unittest.skipUnless(SERVER, "this build has no viewloomd")
class Health(unittest.TestCase):
    def ask(self, url):
        """Whether HEALTHCHECK finds a server at this address well."""
        command = containerfile_rules.health_command(containerfile.stages_of(TEXT))
        address = url.removeprefix("http://").rstrip("/")
        return subprocess.run(command, env={**os.environ, "VIEWLOOM_HTTP_ADDRESS": address},
                              capture_output=True, timeout=PATIENCE_S, check=False).returncode == 0

    def test_the_health_check_tells_a_server_from_none(self):
        server = subprocess.Popen(
            [SERVER, "serve", "--grpc.address", "127.0.0.1:0", "--http.address", "127.0.0.1:0"],
            stdout=subprocess.PIPE, text=True)
        try:
            url = re.search(r"http=(\S+)", server.stdout.readline()).group(1)
            self.assertTrue(self.ask(url))
        finally:
            server.terminate()
            server.communicate(timeout=PATIENCE_S)
        self.assertFalse(self.ask(url))

    def test_a_server_that_drains_is_not_well(self):
        with http.server.HTTPServer(("127.0.0.1", 0), Refusing) as server:
            thread = threading.Thread(target=server.handle_request)
            thread.start()
            self.assertFalse(self.ask(f"http://127.0.0.1:{server.server_port}/"))
            thread.join(PATIENCE_S)


if __name__ == "__main__":
    unittest.main(verbosity=2)
