# SPDX-License-Identifier: Apache-2.0
"""What the image must be: Debian 12 and its packages alone, and a server without rights."""

import re

DEBIAN = re.compile(r"debian:bookworm(-slim)?(@sha256:[0-9a-f]{64})?")
SETUP = ("deploy/setup.sh", "/opt/setup.sh")  # installs packages of Debian by apt-get
PROGRAMS = {*SETUP, "apt-get", "cmake", "rm", "useradd"}
ADDRESSES = {"VIEWLOOM_GRPC_ADDRESS": "grpc", "VIEWLOOM_HTTP_ADDRESS": "http"}


def check_images(stages):
    names = set()
    for stage in stages:
        if not DEBIAN.fullmatch(stage.image) and stage.image not in names:
            yield stage.line, f"image {stage.image}: accepted is debian:bookworm or bookworm-slim"
        names.add(stage.name)
    if len(stages) < 2:
        yield stages[0].line, "what builds the programs must not be in the image that runs them"


def check_runs(stages):
    """Each command of a RUN is one of few programs: nothing comes from outside Debian."""
    for run in (run for stage in stages for run in stage.of("RUN")):
        if re.search(r"[|`<>]|\$\(", run.text):
            yield run.line, "RUN takes plain commands, joined by && alone"
        for command in re.split(r"&&|;", run.text):
            program = (command.split() or [""])[0]
            if program not in PROGRAMS:
                yield run.line, f"RUN {program}: accepted is {', '.join(sorted(PROGRAMS))}"


def check_copies(stages, has_source):
    """has_source(path): whether the tree has such a file or folder."""
    names = set()
    for stage in stages:
        for copy in stage.of("COPY"):
            *sources, target = copy.words()
            if not sources:
                yield copy.line, f"COPY {target} says no target"
            origin = copy.flags.get("from")
            if origin is not None and origin not in names:
                yield copy.line, f"--from={origin}: there is no such stage above"
            for source in sources if origin is None else ():
                if source.startswith("/") or ".." in source.split("/") or not has_source(source):
                    yield copy.line, f"COPY {source}: the tree has no such file or folder"
        names.add(stage.name)


def check_build(stages, folders):
    """folders: what the top CMakeLists.txt adds, which the stage that builds must have."""
    copied = {source.rstrip("/") for copy in stages[0].of("COPY")
              for source in copy.words()[:-1]}
    for folder in folders:
        if folder not in copied and "." not in copied:
            yield stages[0].line, f"{folder} is not copied, and CMakeLists.txt adds it"


def check_user(stages):
    users = stages[-1].of("USER")
    if not users or re.fullmatch(r"(root|0+)(:.*)?", users[-1].text):
        yield stages[-1].line, "the last USER must not be root"
        return
    for run in stages[-1].of("RUN"):
        if run.line > users[0].line:
            yield run.line, "RUN after USER: install before rights are given up"


def check_ports(stages, ports):
    """ports: {"grpc": ..., "http": ...}, where the server listens unless it is told otherwise."""
    last = stages[-1]
    exposed = {word.removesuffix("/tcp") for one in last.of("EXPOSE") for word in one.words()}
    if exposed != set(ports.values()):
        yield last.line, f"EXPOSE {' '.join(sorted(exposed))}: the server listens on " \
            f"{' and '.join(sorted(ports.values()))}"
    variables = dict(word.partition("=")[::2] for one in last.of("ENV") for word in one.words())
    for name, kind in ADDRESSES.items():
        if variables.get(name) != f"0.0.0.0:{ports[kind]}":
            yield last.line, f"ENV {name} must be 0.0.0.0:{ports[kind]}: loopback of a container " \
                "is reached by nobody"
    if variables.get("VIEWLOOM_OPEN") != "true":
        yield last.line, "ENV VIEWLOOM_OPEN must be true: -p decides who reaches the server"


def health_command(stages):
    """The words of HEALTHCHECK's command; None where there is none."""
    for check in stages[-1].of("HEALTHCHECK"):
        if check.text.startswith("CMD "):
            return type(check)(check.line, "CMD", check.text.removeprefix("CMD ").strip()).words()
    return None


def check_start(stages):
    last = stages[-1]
    for word, program in (("ENTRYPOINT", "viewloomd"), ("CMD", "serve")):
        said = last.of(word)
        if len(said) != 1 or not said[0].is_exec_form() or said[0].words()[0] != program:
            yield last.line, f"{word} must be [\"{program}\", ...]: signals reach the server then"
    command = health_command(stages)
    if command is None or "/healthz" not in " ".join(command):
        yield last.line, "HEALTHCHECK must ask for /healthz"


def check(stages, has_source, folders, ports):
    """(line, what is wrong) of each broken rule."""
    for found in (check_images(stages), check_runs(stages), check_copies(stages, has_source),
                  check_build(stages, folders), check_user(stages), check_ports(stages, ports),
                  check_start(stages)):
        yield from found
