# SPDX-License-Identifier: Apache-2.0
"""A frame as the messages that carry it: a header, then every plane in chunks."""

from __future__ import annotations

import secrets
from typing import Any, Iterator, Sequence, Union

import zstandard

from viewloom.errors import BadInput
from viewloom.planes import WirePlane
from viewloom.source import Source, source_header, wire_planes
from viewloom.v1 import frame_pb2
from viewloom.v1.ingest_service_pb2 import (FrameChunk, Heartbeat, PublishFramesRequest,
                                            PublishSettings)

CHUNK_BYTES_MAX = 1 << 20

# Already packed: zstd gains nothing, and servers refuse it around H.264.
_CODED = (frame_pb2.PLANE_ENCODING_JPEG, frame_pb2.PLANE_ENCODING_H264)

_TONE_MAPS = {"clip": frame_pb2.TONE_MAP_CLIP, "filmic": frame_pb2.TONE_MAP_FILMIC,
              "agx": frame_pb2.TONE_MAP_AGX}

# Says that the publisher lives, where it has nothing else to say.
HEARTBEAT = PublishFramesRequest(heartbeat=Heartbeat())

Sources = Union[Source, Sequence[Source]]


def _wire_bytes(plane: WirePlane, zstd_level: int) -> Any:
    """The plane's bytes as they travel; completes what the header says of them."""
    samples = plane.samples.data.cast("B")
    plane.declared.bytes_count = samples.nbytes
    if zstd_level == 0 or plane.declared.encoding in _CODED:
        return samples
    packed = zstandard.ZstdCompressor(level=zstd_level).compress(samples)
    plane.declared.compression = frame_pb2.PLANE_COMPRESSION_ZSTD
    plane.declared.bytes_count = len(packed)
    return packed


def _chunks(plane_index: int, wire_bytes: Any) -> Iterator[PublishFramesRequest]:
    for offset in range(0, len(wire_bytes), CHUNK_BYTES_MAX):
        yield PublishFramesRequest(chunk=FrameChunk(
            plane_index=plane_index, offset_bytes=offset,
            data=bytes(wire_bytes[offset:offset + CHUNK_BYTES_MAX])))


def tone_map_from(name: str) -> frame_pb2.ToneMap:
    """Raises BadInput for a name that is none."""
    if name not in _TONE_MAPS:
        raise BadInput("tone_map", f"is {name!r}, must be one of {', '.join(_TONE_MAPS)}")
    return _TONE_MAPS[name]


def frame_messages(number: int, sources: Sources, *, capture_time_ns: int, exposure_ev: float = 0.0,
                   tone_map: str = "clip", zstd_level: int = 0) -> list[PublishFramesRequest]:
    """What says and carries the frame. Raises BadInput for arrays that make no frame.

    The messages hold copies: the arrays may change at once.
    """
    header = frame_pb2.FrameHeader(number=number, capture_time_ns=capture_time_ns,
                                   exposure_ev=exposure_ev, tone_map=tone_map_from(tone_map))
    chunks: list[PublishFramesRequest] = []
    plane_count = 0
    for source in [sources] if isinstance(sources, Source) else sources:
        if not isinstance(source, Source):
            raise BadInput("sources", f"has a {type(source).__name__}, must be of viewloom.Source")
        planes = wire_planes(source)
        for plane in planes:
            chunks.extend(_chunks(plane_count, _wire_bytes(plane, zstd_level)))
            plane_count += 1
        header.sources.append(source_header(source, [plane.declared for plane in planes]))
    if not header.sources:
        raise BadInput("sources", "is empty, must have at least one viewloom.Source")
    return [PublishFramesRequest(header=header), *chunks]


def settings_message(stream: str, session_id: str) -> PublishFramesRequest:
    """What a call begins with.

    Without a session id it is given a secret one: so a publisher whose line broke takes its own
    stream over, also before the server knows that the line is dead.
    """
    return PublishFramesRequest(settings=PublishSettings(
        stream=stream, session_id=session_id or secrets.token_hex(16), sends_heartbeats=True))
