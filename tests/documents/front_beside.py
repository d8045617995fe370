# SPDX-License-Identifier: Apache-2.0
"""HAProxy with the reference configuration beside the commands of a document."""

import os
import pathlib
import sys

from running import Failure

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "attack"))
import front  # noqa: E402
from target import Address  # noqa: E402

KIND = "haproxy"


class FrontBeside:
    """`environment` tells commands its port, and whose certificates to accept."""

    def __init__(self, ports):
        if not front.program_of(KIND):
            raise Failure("there is no haproxy: install it with deploy/setup.sh --dev")
        self._front = front.Front(KIND, Address(*ports)).__enter__()
        self.environment = {
            "FRONT_PORT": str(self._front.port),
            "VIEWLOOM_SERVER_CA": os.path.join(self._front.folder.name, "front.crt")}

    def close(self):
        self._front.__exit__()
