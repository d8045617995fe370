# SPDX-License-Identifier: Apache-2.0
"""Commands that run in another form here than in their document, and why.

Each entry replaces a pattern in the commands of the documents that it names. Options and files are
checked as they stand in the document. An entry that replaces nothing is a failure.
"""

import re
from typing import NamedTuple


class Short(NamedTuple):
    documents: tuple
    pattern: str
    instead: str
    why: str


BUILDING = "the suite has built everything; here the names of the targets have to exist"
LISTING = "the suite runs these tests; here the pattern has to find some"
FORMS = (
    Short(("CONTRIBUTING.md",), r"^ninja -C (\S+) ", r"ninja -C \1 -t query ", BUILDING),
    Short(("tests/README.md",), r"^cmake --build (\S+) --target ", r"ninja -C \1 -t query ",
          BUILDING),
    Short(("client/python/README.md",),
          r"^cmake --preset (\w+) && cmake --build (\S+) --target (\w+)$",
          r"cmake --list-presets | grep -w \1 && ninja -C \2 -t query \3", BUILDING),
    Short(("CONTRIBUTING.md", "tests/README.md"), r"^ctest (.*?)( +#.*)?$",
          r"ctest -N \1 | grep 'Total Tests: [1-9]'", LISTING),
    Short(("CONTRIBUTING.md", "tests/README.md"), r"compare_builds.py (.*?)( --quick)?$",
          r"compare_builds.py \1 --quick --only cameras", "all requests take minutes"),
    Short(("tests/README.md",), r"first_use.py --warm-up 45 BEFORE AFTER",
          "first_use.py --warm-up 0 --rounds 1 --only stereo BEFORE", "all kinds take minutes"),
    Short(("tests/README.md",), r"band_latency.py BEFORE AFTER",
          "band_latency.py --rounds 1 --frames 1 --warm-up 0 --only lens --size 160x90 BEFORE",
          "all kinds take minutes"),
    Short(("tests/README.md",), r"^tests/full.sh ([a-z].*)$",
          r'for part in \1; do tests/full.sh --list | grep "^$part " || exit 1; done',
          "these parts take hours; here they have to be in the list"),
    Short(("tests/README.md",), r"attack/main.py (\S+) --suite$",
          r"attack/main.py \1 --suite dns_rebinding ping", "all attacks take a minute"),
    Short(("tests/README.md",), r"(vulkan_faults/layers) --suite$", r"\1 --calls --stage start",
          "each fault has a server of its own"),
    Short(("client/publish.md", "client/watch.md"), r"--seconds 10\b", "--seconds 1",
          "one second is enough"),
    Short(("client/effects.md",), r"(--preset portrait) (--a.*|--reflections .*) --out",
          r"\1 --size 840x840 \2 --out",
          "without a GPU a lens, or mirrors, at full size take a minute"),
    Short(("client/panel.md",), r"--monitor 1\b", "--monitor 0", "the tests have one monitor"),
    Short(("client/panel.md",), r"show --tune ", "show --tune --calibration visual.json ",
          "no panel is plugged in, so its file is named"),
    Short(("client/getting-started.md", "deploy/settings.md"), r"/etc/viewloom/viewloomd.toml",
          "deploy/viewloomd.example.toml", "the installation copies that file there"),
    Short(("deploy/lab.md", "deploy/lan.md"), r"\b0\.0\.0\.0:", "127.0.0.1:",
          "a test listens on this machine alone"),
    Short(("deploy/lab.md", "deploy/lan.md"), r"\bstudio\.local\b", "localhost",
          "the tests have one machine"),
    Short(("deploy/lan.md",), r"3A:F1:\.\.\.",
          "$(openssl x509 -in viewloomd.crt -noout -fingerprint -sha256 | cut -d= -f2)",
          "each certificate has a fingerprint of its own"),
    Short(("deploy/internet.md",), r"https://viewloom\.example(:443)?",
          "https://localhost:$FRONT_PORT", "the tests have no name in the DNS"),
    Short(("deploy/internet.md",), r"^curl ", 'curl --cacert "$VIEWLOOM_SERVER_CA" ',
          "no public authority made the certificate of the tests"),
    Short(("client/python/README.md",), r"( +)(print\(atlas\..*\))$", r"\1\2\n\1break",
          "the loop has no end"),
)
# A viewer beside a command that tells what viewers see.
BESIDE = {("client/publish.md", "viewloom publish --synthetic --size 960x540"):
          "viewloom watch demo --columns 3 --rows 3 --size 960x960 --cone 70 --fov 36 --quiet"}
# Commands that are recognised and never called.
SUITE = re.compile(r"^tests/run\.sh\b")


def shortened(document, text, used=None):
    """The text to run. Adds the entries that changed it to `used`."""
    for form in FORMS:
        if document in form.documents:
            text, count = re.subn(form.pattern, form.instead, text, flags=re.MULTILINE)
            if count and used is not None:
                used.append((document, form))
    return text
