# SPDX-License-Identifier: Apache-2.0
"""The stages of a server's life in which Vulkan fails. As a program it prints their names."""

import enum
from dataclasses import dataclass

import scene
from scene import FIRST, LAYERED, SECOND


class Moment(enum.Enum):
    """From when on calls are counted."""
    START = "before the process starts"
    SERVING = "once the frames before are served"
    STOPPING = "right before SIGTERM"


@dataclass(frozen=True)
class Stage:
    """before: frames that are served first. frames: those that are then to be served, one after
    the other, on `display` and on the one that is watched all the time; in turn while the server
    stops."""
    name: str
    display: str = "watched"
    before: tuple = (FIRST,)
    frames: tuple = (FIRST, SECOND)
    moment: Moment = Moment.SERVING
    warms_up: bool = False

    @property
    def watched(self):
        """The display that clients watch while the server is made to stop."""
        return self.display if self.moment is Moment.STOPPING else "watched"

    @property
    def is_mirroring(self):
        return self.display == "mirrors"


STAGES = [
    Stage("start", before=(), moment=Moment.START),
    Stage("warm up", before=(), warms_up=True),
    Stage("first frame", before=()),
    Stage("next frame", frames=(SECOND, FIRST)),
    Stage("other shape", frames=(LAYERED, FIRST)),
    *(Stage(name, display=name) for name in scene.DISPLAYS
      if name not in ("watched", "large")),
    Stage("shut down", display="large", moment=Moment.STOPPING),
]
BY_NAME = {stage.name: stage for stage in STAGES}

if __name__ == "__main__":
    print("\n".join(BY_NAME))
