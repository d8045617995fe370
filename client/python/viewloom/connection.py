# SPDX-License-Identifier: Apache-2.0
"""Where a server is, and the channel to it."""

from __future__ import annotations

import os
import re
from typing import Any, NamedTuple, Optional

from viewloom.errors import BadInput

DEFAULT_ADDRESS = "127.0.0.1:50051"
_DEFAULT_PORT = 50051
# Two connections of one process do not share a socket, and with it its flow control. Waiting is for
# those who retry: the channel itself tries again at once. Pings find out that a line is dead.
CHANNEL_OPTIONS = (("grpc.use_local_subchannel_pool", 1),
                   ("grpc.initial_reconnect_backoff_ms", 100),
                   ("grpc.max_reconnect_backoff_ms", 200),
                   ("grpc.min_reconnect_backoff_ms", 2000),  # how long one attempt may take
                   ("grpc.keepalive_time_ms", 15000),
                   ("grpc.keepalive_timeout_ms", 5000),
                   ("grpc.http2.max_pings_without_data", 0))


TOKEN_VARIABLE = "VIEWLOOM_TOKEN"

Metadata = tuple[tuple[str, str], ...]


class Connection(NamedTuple):
    """A grpc.Channel, blocking or of asyncio, the address that it goes to, and the metadata of its
    calls."""

    channel: Any
    address: str
    metadata: Metadata = ()


def token_metadata(token: Optional[str]) -> Metadata:
    """What each call shows. None: the token in VIEWLOOM_TOKEN; "": none. Raises BadInput, without
    the token."""
    text = os.environ.get(TOKEN_VARIABLE, "").strip() if token is None else token
    if not isinstance(text, str) or not re.fullmatch(r"[!-~]{0,8192}", text):
        raise BadInput("token", "is no access token; it must be one line, as `viewloomd token add` "
                       "prints it")
    return (("authorization", f"Bearer {text}"),) if text else ()


def checked_address(address: Any) -> str:
    """HOST:PORT, with viewloomd's own port where none is given; https:// before it stays. Raises
    BadInput."""
    accepted = 'must be HOST:PORT, as "127.0.0.1:50051", "https://HOST:PORT" or "unix:PATH"'
    if not isinstance(address, str):
        raise BadInput("address", f"is a {type(address).__name__}, {accepted}")
    if address.startswith("https://"):
        return "https://" + checked_address(address.removeprefix("https://").removesuffix("/"))
    if re.match(r"(http|grpcs?|tcp)://", address):
        raise BadInput("address", f"is {address!r}, {accepted}: without another scheme in front, "
                       "and the port of gRPC, not that of the page")
    if not address or re.search(r"\s", address):
        raise BadInput("address", f"is {address!r}, {accepted}")
    if re.match(r"(unix|unix-abstract|dns|ipv4|ipv6|vsock|xds):", address):
        return address
    if address.count(":") > 1 and not address.startswith("["):  # a bare IPv6 address
        return f"[{address}]:{_DEFAULT_PORT}"
    if re.search(r":\d+$", address):
        return address
    return f"{address}:{_DEFAULT_PORT}"
