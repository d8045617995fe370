# SPDX-License-Identifier: Apache-2.0
"""A connection to viewloomd, for callers that block."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Optional

import grpc

from viewloom.atlas import Atlas
from viewloom.atlas_inbox import AtlasInbox
from viewloom.connection import DEFAULT_ADDRESS, Connection, checked_address, token_metadata
from viewloom.display import DisplayLike, EncodingLike, display_from, open_request
from viewloom.errors import data_loss, error_from_rpc
from viewloom.frame_messages import settings_message
from viewloom.publisher import Publisher
from viewloom.tls import Tls, open_channel
from viewloom.v1 import catalog_service_pb2 as catalog
from viewloom.v1.catalog_service_pb2_grpc import CatalogServiceStub
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub
from viewloom.watcher import Watcher

IN_FLIGHT_MAX = 4  # one is decoded, one built, one traced: more would only be replaced


class Server:
    """A viewloomd. Thread-safety: all methods may be called from any thread."""

    def __init__(self, address: str = DEFAULT_ADDRESS, *, reconnect: bool = True,
                 token: Optional[str] = None, tls: Optional[Tls] = None) -> None:
        self._address = checked_address(address)
        self._channel = open_channel(grpc, self._address, tls)
        self._connection = Connection(self._channel, self._address, token_metadata(token))
        self._reconnects = reconnect
        self._catalog = CatalogServiceStub(self._channel)

    def publish(self, stream: str, *, session_id: str = "", zstd_level: int = 0,
                in_flight_max: int = IN_FLIGHT_MAX) -> Publisher:
        """Opens a stream; returns when the server has accepted it. Close it, or use `with`.

        stream:      its name, [A-Za-z0-9._-]{1,64}.
        session_id:  a secret, up to 128 bytes: who shows it again takes the stream over. None is
                     needed for this publisher to come back to its own stream.
        zstd_level:  1..22 packs planes on the wire; 0 sends them as they are.
        in_flight_max: frames sent and not yet reported; Publisher.send waits while there are more.
        """
        return Publisher(self._connection, settings_message(stream, session_id), zstd_level,
                         in_flight_max, self._reconnects)

    def watch(self, stream: str, display: DisplayLike, *, encoding: EncodingLike = None,
              wait_for_stream: bool = False) -> Watcher:
        """Atlases of a stream on a display, from now on. Close it, or use `with`.

        display:  the name of a device in presets(), a mapping {"quilt": {"columns": 8, ...}} or
                  a Display.
        encoding: of viewloom.encoding(), a mapping or an AtlasEncoding; None = JPEG.
        wait_for_stream: an unknown stream is waited for, instead of NOT_FOUND.
        """
        return Watcher(self._connection, open_request(stream, display, encoding, count=0,
                                                      wait_for_stream=wait_for_stream),
                       self._reconnects)

    def still(self, stream: str, display: DisplayLike, *, encoding: EncodingLike = None,
              wait_for_stream: bool = False, timeout_s: Optional[float] = None) -> Atlas:
        """One atlas, of the newest frame. Arguments as of watch(); waits for at most timeout_s."""
        request = open_request(stream, display, encoding, count=1, wait_for_stream=wait_for_stream)
        inbox = AtlasInbox(stream)
        try:
            call = DisplayServiceStub(self._channel).StreamAtlases(
                iter([request]), timeout=timeout_s, metadata=self._connection.metadata)
            for response in call:
                inbox.add(response)
        except grpc.RpcError as problem:
            raise error_from_rpc(problem, self._address) from None
        atlas = inbox.take()
        if atlas is None:
            raise data_loss("the server ended before an atlas was whole")
        return atlas

    def streams(self) -> list[catalog.StreamEntry]:
        """All streams, sorted by name."""
        return list(self._ask(self._catalog.ListStreams, catalog.ListStreamsRequest()).streams)

    def displays(self) -> list[catalog.DisplayEntry]:
        """All displays that are watched now."""
        return list(self._ask(self._catalog.ListDisplays, catalog.ListDisplaysRequest()).displays)

    def presets(self) -> list[catalog.Preset]:
        """All named devices, sorted by name."""
        return list(self._ask(self._catalog.ListPresets, catalog.ListPresetsRequest()).presets)

    def server_info(self) -> catalog.GetServerInfoResponse:
        """Version, device and limits."""
        answer: catalog.GetServerInfoResponse = self._ask(self._catalog.GetServerInfo,
                                                          catalog.GetServerInfoRequest())
        return answer

    def advise_source(self, display: DisplayLike, near_m: float,
                      far_m: float) -> catalog.AdviseSourceResponse:
        """Which source would serve a display of a scene between two depths.

        display: as of watch(); it has to state its own fov_y_rad, as there is no stream.
        near_m, far_m: in front of the display's middle eye, 1e-6..1e9.
        """
        answer: catalog.AdviseSourceResponse = self._ask(
            self._catalog.AdviseSource,
            catalog.AdviseSourceRequest(display=display_from(display), near_m=near_m, far_m=far_m))
        return answer

    def _ask(self, method: Any, request: Any) -> Any:
        try:
            return method(request, metadata=self._connection.metadata)
        except grpc.RpcError as problem:
            raise error_from_rpc(problem, self._address) from None

    def __repr__(self) -> str:
        return f"<viewloom.Server at {self._address}>"

    def close(self) -> None:
        """Ends the connection, and what still runs on it."""
        self._channel.close()

    def __enter__(self) -> Server:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()


def connect(address: str = DEFAULT_ADDRESS, *, reconnect: bool = True,
            token: Optional[str] = None, tls: Optional[Tls] = None) -> Server:
    """A connection to the viewloomd at HOST:PORT or https://HOST:PORT. Connects when first used.

    reconnect: when the server restarts or the line breaks, publishers and watchers call again until
               it is back: publishers send what stands once more. False: they raise instead.
    token:     access token for the server; None is the one in VIEWLOOM_TOKEN, "" is none.
               Without https:// it crosses the network as it is.
    tls:       how client and server know each other; None = by the authorities of the system.
    """
    return Server(address, reconnect=reconnect, token=token, tls=tls)
