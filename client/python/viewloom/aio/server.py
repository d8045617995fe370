# SPDX-License-Identifier: Apache-2.0
"""A connection to viewloomd, for asyncio."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Optional

import grpc
import grpc.aio

from viewloom.aio.call import read_all
from viewloom.aio.publisher import Publisher
from viewloom.aio.watcher import Watcher
from viewloom.atlas import Atlas
from viewloom.atlas_inbox import AtlasInbox
from viewloom.connection import DEFAULT_ADDRESS, Connection, checked_address, token_metadata
from viewloom.display import DisplayLike, EncodingLike, display_from, open_request
from viewloom.errors import data_loss, error_from_rpc
from viewloom.frame_messages import settings_message
from viewloom.server import IN_FLIGHT_MAX
from viewloom.tls import Tls, open_channel
from viewloom.v1 import catalog_service_pb2 as catalog
from viewloom.v1.catalog_service_pb2_grpc import CatalogServiceStub
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub


class Server:
    """A viewloomd; arguments and errors as of the blocking Server."""

    def __init__(self, address: str = DEFAULT_ADDRESS, *, reconnect: bool = True,
                 token: Optional[str] = None, tls: Optional[Tls] = None) -> None:
        self._address = checked_address(address)
        self._channel = open_channel(grpc.aio, self._address, tls)
        self._connection = Connection(self._channel, self._address, token_metadata(token))
        self._reconnects = reconnect
        self._catalog = CatalogServiceStub(self._channel)

    def publish(self, stream: str, *, session_id: str = "", zstd_level: int = 0,
                in_flight_max: int = IN_FLIGHT_MAX) -> Publisher:
        """A stream, opened by `async with`."""
        return Publisher(self._connection, settings_message(stream, session_id), zstd_level,
                         in_flight_max, self._reconnects)

    def watch(self, stream: str, display: DisplayLike, *, encoding: EncodingLike = None,
              wait_for_stream: bool = False) -> Watcher:
        """Atlases from when `async with` opens it: `async for atlas in watcher`."""
        return Watcher(self._connection, open_request(stream, display, encoding, count=0,
                                                      wait_for_stream=wait_for_stream),
                       self._reconnects)

    async def still(self, stream: str, display: DisplayLike, *, encoding: EncodingLike = None,
                    wait_for_stream: bool = False, timeout_s: Optional[float] = None) -> Atlas:
        """One atlas, of the newest frame."""
        request = open_request(stream, display, encoding, count=1, wait_for_stream=wait_for_stream)
        inbox = AtlasInbox(stream)
        call = DisplayServiceStub(self._channel).StreamAtlases(
            iter([request]), timeout=timeout_s, metadata=self._connection.metadata)
        inbox.end(await read_all(call, inbox.add, self._address))
        atlas = inbox.take()
        if atlas is None:
            raise data_loss("the server ended before an atlas was whole")
        return atlas

    async def streams(self) -> list[catalog.StreamEntry]:
        """All streams, sorted by name."""
        return list((await self._ask(self._catalog.ListStreams,
                                     catalog.ListStreamsRequest())).streams)

    async def displays(self) -> list[catalog.DisplayEntry]:
        """All displays that are watched now."""
        return list((await self._ask(self._catalog.ListDisplays,
                                catalog.ListDisplaysRequest())).displays)

    async def presets(self) -> list[catalog.Preset]:
        """All named devices, sorted by name."""
        return list((await self._ask(self._catalog.ListPresets,
                                     catalog.ListPresetsRequest())).presets)

    async def server_info(self) -> catalog.GetServerInfoResponse:
        """Version, device and limits."""
        answer: catalog.GetServerInfoResponse = await self._ask(self._catalog.GetServerInfo,
                                                           catalog.GetServerInfoRequest())
        return answer

    async def advise_source(self, display: DisplayLike, near_m: float,
                            far_m: float) -> catalog.AdviseSourceResponse:
        """Which source would serve a display of a scene between two depths."""
        answer: catalog.AdviseSourceResponse = await self._ask(
            self._catalog.AdviseSource,
            catalog.AdviseSourceRequest(display=display_from(display), near_m=near_m, far_m=far_m))
        return answer

    async def _ask(self, method: Any, request: Any) -> Any:
        try:
            return await method(request, metadata=self._connection.metadata)
        except grpc.RpcError as problem:
            raise error_from_rpc(problem, self._address) from None

    def __repr__(self) -> str:
        return f"<viewloom.aio.Server at {self._address}>"

    async def close(self) -> None:
        """Ends the connection, and what still runs on it."""
        await self._channel.close()

    async def __aenter__(self) -> Server:
        return self

    async def __aexit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        await self.close()


def connect(address: str = DEFAULT_ADDRESS, *, reconnect: bool = True,
            token: Optional[str] = None, tls: Optional[Tls] = None) -> Server:
    """As the blocking connect(), within the running event loop."""
    return Server(address, reconnect=reconnect, token=token, tls=tls)
