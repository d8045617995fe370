# SPDX-License-Identifier: Apache-2.0
"""Light-field views of numpy pictures: publishes colour and depth, receives atlases and views.

    with viewloom.connect() as server, server.publish("demo") as publisher:
        publisher.send(viewloom.Source(color, depth_m, fov_y_rad=0.8))
        left_eye = server.still("demo", "portrait").view(20)

viewloom.aio is the same for asyncio; viewloom.v1 holds the messages of the API.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viewloom import aio
    from viewloom.atlas import Atlas
    from viewloom.clock import ClockOffset
    from viewloom.coded_color import CodedColor
    from viewloom.display import encoding
    from viewloom.errors import BadInput, UnlikelyInput, ViewloomError
    from viewloom.publisher import Publisher
    from viewloom.server import Server, connect
    from viewloom.source import Source
    from viewloom.tiles import view_window
    from viewloom.tls import Tls
    from viewloom.version import VERSION as __version__
    from viewloom.watcher import Watcher
else:
    _MODULES = {"Atlas": "atlas", "BadInput": "errors", "ClockOffset": "clock",
                "CodedColor": "coded_color",
                "Publisher": "publisher", "Server": "server", "Source": "source",
                "Tls": "tls", "UnlikelyInput": "errors", "ViewloomError": "errors",
                "Watcher": "watcher", "connect": "server", "encoding": "display",
                "view_window": "tiles"}

    def __getattr__(name: str) -> Any:
        # Imported when first asked for: who uses viewloom.v1 alone needs no numpy.
        if name == "aio":
            return importlib.import_module("viewloom.aio")
        if name == "__version__":
            return importlib.import_module("viewloom.version").VERSION
        if name not in _MODULES:
            raise AttributeError(f"module 'viewloom' has no attribute '{name}'")
        return getattr(importlib.import_module(f"viewloom.{_MODULES[name]}"), name)

__all__ = ["Atlas", "BadInput", "ClockOffset", "CodedColor", "Publisher", "Server", "Source",
           "Tls", "UnlikelyInput", "ViewloomError", "Watcher", "__version__", "aio",
           "connect", "encoding", "view_window"]
