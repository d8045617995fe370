# SPDX-License-Identifier: Apache-2.0
"""Programs and data in documents: each is run, compiled or read, with what its page says before."""

import json
import re
import shlex
import subprocess
import textwrap
import tomllib

from running import Failure, Running

PATIENCE_S = 90
# Names that the page explains in prose.
PYTHON_NAMES = """
import asyncio
import numpy as np
import viewloom

y, x = np.mgrid[0:120, 0:160]
color = front = behind = np.stack([x, y, x + y], axis=-1).astype(np.uint8)
depth_m = np.where(np.hypot(x - 80, y - 60) < 30, 1.5, 3.0)
front_mm, behind_mm = (1000 * depth_m).astype(np.uint16), np.full((120, 160), 4000, np.uint16)
world_from_camera = np.eye(4)
source = viewloom.Source(color, depth_m, fov_y_rad=0.6)
server = viewloom.connect()
publisher = server.publish("layered")
"""
PYTHON_END = """
publisher.close()
server.close()
"""
NODE_NAMES = "const call = {{write() {{}}}}, bands = [];\nasync function program() {{\n{text}\n}}\n"
GLSL_SHADER = """#version 330 core
uniform sampler2D inv_z_before;
in float inv_z;
void main() {{
{text}
}}
"""
SERVER = "http://127.0.0.1:8080"
WEBSOCKET = ("Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13",
             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==")
CURL_TIMEOUT = 28
# Commands of the build that compile the client's own users of the library.
COMPILED_LIKE = "client/cli/CMakeFiles/viewloom_cli.dir/"
KEPT_FLAGS = re.compile(r"^-(I|D|std=)")


def _run(text, workplace, **environment):
    running = Running(text, workplace, **environment)
    try:
        running.wait(PATIENCE_S)
    finally:
        running.kill()


def run_python(_, text, workplace):
    if re.search(r"^(async|await) ", text, re.MULTILINE):
        text = f"async def program():\n{textwrap.indent(text, '    ')}\nasyncio.run(program())"
    file = workplace.root / "snippet.py"
    file.write_text(f"{PYTHON_NAMES}\n{text}\n{PYTHON_END}", encoding="utf-8")
    _run("/usr/bin/python3 snippet.py", workplace,
         PYTHONPATH=str(workplace.build / "client" / "python"))


def parse_javascript(_, text, workplace):
    lines = text.splitlines()
    imports = [line for line in lines if line.startswith("import ")]
    rest = "\n".join(line for line in lines if line not in imports)
    (workplace.root / "snippet.mjs").write_text(
        "\n".join([*imports, NODE_NAMES.format(text=rest)]), encoding="utf-8")
    _run("node --check snippet.mjs", workplace)


def compile_cpp(_, text, workplace):
    commands = json.loads((workplace.build / "compile_commands.json").read_text(encoding="utf-8"))
    words = next(shlex.split(entry["command"]) for entry in commands
                 if COMPILED_LIKE in entry["command"])
    flags = [f"-I{workplace.build}/client/package/include"]  # as they are installed
    for place, word in enumerate(words):
        if word == "-isystem":
            flags += [word, words[place + 1]]
        elif KEPT_FLAGS.match(word):
            flags.append(word)
    (workplace.root / "snippet.cpp").write_text(text, encoding="utf-8")
    _run("g++ -fsyntax-only snippet.cpp " + shlex.join(flags), workplace)


def compile_glsl(_, text, workplace):
    (workplace.root / "snippet.frag").write_text(GLSL_SHADER.format(text=text), encoding="utf-8")
    _run("glslangValidator snippet.frag", workplace)


def _message_of(document, value):
    """The message that a page means by JSON of its kind, as `from MODULE import NAME`."""
    if "sources" in value and document == "proto/README.md":
        return "frame_pb2", "FrameHeader"
    return None


def read_json(document, text, workplace):
    """A manifest is rendered, and a message is read as one. `...` leaves something out."""
    text = text.strip()
    if text.startswith('"'):
        text = "{" + text + "}"
    try:
        value = json.loads(text.replace(": ...", ": null"))
    except ValueError as problem:
        raise Failure(f"is no JSON: {problem}\n{text}") from None
    file = workplace.root / "snippet.json"
    file.write_text(text, encoding="utf-8")
    message = _message_of(document, value)
    if message:
        module, name = message
        _run(f"/usr/bin/python3 -c 'from google.protobuf import json_format\n"
             f"from viewloom.v1 import {module}\n"
             f"json_format.Parse(open(\"snippet.json\").read(), {module}.{name}())'", workplace,
             PYTHONPATH=str(workplace.build / "client" / "python"))
    elif "sources" in value:
        _run(f"{workplace.viewloom} inspect --manifest snippet.json", workplace)


def fetch_addresses(_, text, workplace):
    """Each line is an address of the server: a picture, or a WebSocket that sends until curl
    leaves."""
    for address in text.splitlines():
        url = shlex.quote(SERVER + address)
        if address.startswith("/ws"):
            headers = " ".join(f"-H {shlex.quote(header)}" for header in WEBSOCKET)
            _run(f"curl -gsS -N --max-time 1 {headers} -o answer {url} "
                 f"|| test $? = {CURL_TIMEOUT}\ntest -s answer", workplace)
        else:
            _run(f"curl -gsSL -o answer {url}\ntest -s answer", workplace)


def check_settings(_, text, workplace):
    """Settings of the server: each is an option of `viewloomd`."""
    try:
        found = tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise Failure(f"is no TOML: {problem}\n{text}") from None
    known = subprocess.run([workplace.viewloomd, "--help"], check=True, capture_output=True,
                           text=True, timeout=PATIENCE_S).stdout.split()
    for name in _names(found):
        if f"--{name}" not in known:
            raise Failure(f"viewloomd has no setting {name}")


def _names(table, before=""):
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _names(value, f"{before}{name}.")
        else:
            yield before + name


CHECKS = {"cpp": compile_cpp, "glsl": compile_glsl, "http": fetch_addresses,
          "js": parse_javascript, "json": read_json, "python": run_python, "toml": check_settings}
