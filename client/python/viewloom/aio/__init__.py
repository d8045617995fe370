# SPDX-License-Identifier: Apache-2.0
"""The same for asyncio: connect() gives a Server whose methods are awaited.

Nothing here is thread-safe: all belongs to one event loop.
"""

from viewloom.aio.publisher import Publisher
from viewloom.aio.server import Server, connect
from viewloom.aio.watcher import Watcher

__all__ = ["Publisher", "Server", "Watcher", "connect"]
