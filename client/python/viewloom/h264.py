# SPDX-License-Identifier: Apache-2.0
"""Decodes pictures of H.264 by the library OpenH264, through its C interface (wels/codec_api.h)."""

from __future__ import annotations

import ctypes
import ctypes.util
import functools
from typing import Any, NamedTuple, Optional

import grpc
import numpy as np
from numpy.typing import NDArray

from viewloom.errors import ViewloomError, data_loss

# File names where the system's list of libraries does not know the name.
_NAMES = ("libopenh264.so.7", "libopenh264.so.8", "libopenh264.so.6", "libopenh264.dylib",
          "openh264.dll")
# Versions whose table of functions is the one below.
_VERSION_MIN, _VERSION_END = (2, 1), (3, 0)
_QUIET = 0
_OPTION_TRACE_LEVEL = 9
_AVC = 0
_OUT_OF_MEMORY = 0x4000
# Types of units (ITU-T H.264, table 7-1).
_SLICE, _IDR_SLICE, _SUPPLEMENT, _SEQUENCE, _PICTURE, _DELIMITER = 1, 5, 6, 7, 8, 9
# Others belong to extensions that no encoder of ours uses.
_KNOWN = {_SLICE, _IDR_SLICE, _SUPPLEMENT, _SEQUENCE, _PICTURE, _DELIMITER}
_START_CODE = b"\x00\x00\x01"


class _Version(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint) for name in ("major", "minor", "revision", "reserved")]


class _DecodingParameters(ctypes.Structure):
    """SDecodingParam, with its SVideoProperty."""

    _fields_ = [("file_name", ctypes.c_char_p), ("cpu_load", ctypes.c_uint),
                ("target_layer", ctypes.c_ubyte), ("concealment", ctypes.c_int),
                ("parse_only", ctypes.c_bool), ("property_bytes", ctypes.c_uint),
                ("stream_type", ctypes.c_int)]


class _BufferInfo(ctypes.Structure):
    """SBufferInfo, with its SSysMEMBuffer."""

    _fields_ = [("status", ctypes.c_int), ("time_in", ctypes.c_ulonglong),
                ("time_out", ctypes.c_ulonglong), ("width", ctypes.c_int),
                ("height", ctypes.c_int), ("format", ctypes.c_int), ("strides", ctypes.c_int * 2),
                ("planes", ctypes.c_void_p * 3)]


_Planes = ctypes.c_void_p * 3
_Decoder = ctypes.c_void_p
_INITIALIZE = ctypes.CFUNCTYPE(ctypes.c_long, _Decoder, ctypes.POINTER(_DecodingParameters))
_UNINITIALIZE = ctypes.CFUNCTYPE(ctypes.c_long, _Decoder)
_DECODE = ctypes.CFUNCTYPE(ctypes.c_int, _Decoder, ctypes.c_char_p, ctypes.c_int,
                           ctypes.POINTER(_Planes), ctypes.POINTER(_BufferInfo))
_FLUSH = ctypes.CFUNCTYPE(ctypes.c_int, _Decoder, ctypes.POINTER(_Planes),
                          ctypes.POINTER(_BufferInfo))
_SET_OPTION = ctypes.CFUNCTYPE(ctypes.c_long, _Decoder, ctypes.c_int, ctypes.c_void_p)


class _Functions(ctypes.Structure):
    """ISVCDecoderVtbl. Those that are not used here are pointers."""

    _fields_ = [("initialize", _INITIALIZE), ("uninitialize", _UNINITIALIZE),
                ("decode_frame", ctypes.c_void_p), ("decode_frame_no_delay", _DECODE),
                ("decode_frame_2", ctypes.c_void_p), ("flush_frame", _FLUSH),
                ("decode_parser", ctypes.c_void_p), ("decode_frame_ex", ctypes.c_void_p),
                ("set_option", _SET_OPTION), ("get_option", ctypes.c_void_p)]


class Picture(NamedTuple):
    """Y'CbCr 4:2:0 of full range with the weights of BT.601, as in JPEG files."""

    luma: NDArray[np.uint8]  # [height_px][width_px]
    cb: NDArray[np.uint8]  # [height_px / 2][width_px / 2]
    cr: NDArray[np.uint8]  # the same


def _unavailable(problem: str) -> ViewloomError:
    return ViewloomError(
        grpc.StatusCode.UNIMPLEMENTED, "",
        f"{problem}; H.264 needs OpenH264 from version {_VERSION_MIN[0]}.{_VERSION_MIN[1]} on, "
        "which is libopenh264-7 in Debian: install it, or ask for JPEG")


def _opened() -> Optional[ctypes.CDLL]:
    for name in (ctypes.util.find_library("openh264"), *_NAMES):
        try:
            return ctypes.CDLL(name) if name else None
        except OSError:
            continue
    return None


@functools.cache
def _library() -> ctypes.CDLL:
    library = _opened()
    if library is None:
        raise _unavailable("there is no library OpenH264")
    version = _Version()
    library.WelsGetCodecVersionEx(ctypes.byref(version))
    if not _VERSION_MIN <= (version.major, version.minor) < _VERSION_END:
        raise _unavailable(f"the library OpenH264 has the version {version.major}.{version.minor}")
    library.WelsCreateDecoder.restype = ctypes.c_long
    library.WelsDestroyDecoder.restype = None
    return library


class Decoder:
    """Decodes one stream, picture by picture. Use it with `with`. Thread-safety: none.

    Damage is never concealed: a picture is right, or refused. Raises UNIMPLEMENTED where the
    library is missing.
    """

    def __init__(self) -> None:
        self._library = _library()
        self._decoder = ctypes.POINTER(ctypes.POINTER(_Functions))()
        self._needs_idr = True
        if self._library.WelsCreateDecoder(ctypes.byref(self._decoder)) != 0:
            raise MemoryError("there is no memory for a video decoder")
        quiet = ctypes.c_int(_QUIET)
        self._call.set_option(self._self, _OPTION_TRACE_LEVEL, ctypes.addressof(quiet))
        parameters = _DecodingParameters(property_bytes=8, stream_type=_AVC)
        if self._call.initialize(self._self, parameters) != 0:
            self.close()
            raise MemoryError("there is no memory for a video decoder")

    def __enter__(self) -> Decoder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def _self(self) -> ctypes.c_void_p:
        return ctypes.cast(self._decoder, ctypes.c_void_p)

    @property
    def _call(self) -> Any:
        return self._decoder.contents.contents

    def close(self) -> None:
        """Frees the decoder; what is decoded stays."""
        if self._decoder:
            self._call.uninitialize(self._self)
            self._library.WelsDestroyDecoder(self._decoder)
            self._decoder = ctypes.POINTER(ctypes.POINTER(_Functions))()

    def decode(self, access_unit: bytes, width: int, height: int) -> Picture:
        """One whole picture in Annex B format. Raises DATA_LOSS unless it is one of that size."""
        types = {unit[0] & 0x1F for unit in access_unit.split(_START_CODE)[1:] if unit}
        if not types <= _KNOWN:
            raise data_loss(f"H.264 has units of the types {sorted(types - _KNOWN)}, which are not "
                            "accepted")
        if self._needs_idr and _IDR_SLICE not in types:
            raise data_loss("a picture refers to one that is missing or damaged")
        # Versions of the library before 2.6 then use memory of another size (CVE-2025-27091).
        if _SEQUENCE in types and _IDR_SLICE not in types:
            raise data_loss("H.264 has sequence parameters before a picture that refers to others")
        self._needs_idr = True  # until this picture is known to be whole
        planes, info = _Planes(), _BufferInfo()
        state = self._call.decode_frame_no_delay(self._self, access_unit, len(access_unit),
                                                 planes, info)
        if state == _OUT_OF_MEMORY:
            raise MemoryError("there is no memory for a decoded picture")
        if state == 0 and info.status != 1:
            # The library keeps each picture of the main profile for the next call.
            self._call.flush_frame(self._self, planes, info)
        if state != 0 or info.status != 1:
            raise data_loss(f"a picture of H.264 is damaged (decoding state {state})")
        if (info.width, info.height) != (width, height):
            raise data_loss(f"a picture of H.264 has {info.width}x{info.height} px, the layout "
                            f"{width}x{height}")
        self._needs_idr = False
        luma, cb, cr = (address or 0 for address in planes)  # status 1: none of them is null
        return Picture(_copied(luma, info.strides[0], width, height),
                       _copied(cb, info.strides[1], width // 2, height // 2),
                       _copied(cr, info.strides[1], width // 2, height // 2))


def _copied(address: int, stride: int, width: int, height: int) -> NDArray[np.uint8]:
    """A plane of the library, which is valid until its next call."""
    size_bytes = stride * (height - 1) + width
    rows = np.ctypeslib.as_array((ctypes.c_uint8 * size_bytes).from_address(address))
    strided: NDArray[np.uint8] = np.lib.stride_tricks.as_strided(
        rows, (height, width), (stride, 1), writeable=False)
    return strided.copy()
