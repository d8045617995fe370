# SPDX-License-Identifier: Apache-2.0
"""Saves an atlas as a picture file."""

from __future__ import annotations

import errno
import io
import os
import pathlib
import re
import stat
import tempfile
from typing import TYPE_CHECKING, Union

from PIL import Image

from viewloom.errors import BadInput

if TYPE_CHECKING:
    from viewloom.atlas import Atlas

PathLike = Union[str, "os.PathLike[str]"]
_JPEG_ENDINGS = (".jpg", ".jpeg")
_REASONS = {errno.ENOSPC: "the disk is full", errno.EDQUOT: "the disk is full",
            errno.EFBIG: "it reached the largest size allowed"}
# Suffix that a server may add to the name of a file, and the characters of a stream's name.
_SUFFIX = re.compile(r"_qs\d{1,3}x\d{1,3}a\d{1,4}(\.\d{1,8})?")
_STREAM = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,63}")


def _file_name(atlas: Atlas) -> str:
    """"demo_000001_qs8x6a0.75.jpg": quilt players read the layout from it."""
    stream = atlas.stream if _STREAM.fullmatch(atlas.stream) else "atlas"
    suffix = atlas.layout.suffix if _SUFFIX.fullmatch(atlas.layout.suffix) else ""
    ending = ".jpg" if atlas.is_jpeg else ".png"
    return f"{stream}_{atlas.header.frame_number:06d}{suffix}{ending}"


def _target(atlas: Atlas, path: PathLike) -> pathlib.Path:
    given = os.fspath(path)
    if not isinstance(given, str) or not given:
        raise BadInput("path", f"is {path!r}, must be the name of a file or a folder")
    is_folder = given.endswith(os.sep) or os.path.isdir(given)
    file = pathlib.Path(os.path.realpath(given))  # a link stays, and what it names is replaced
    if is_folder:
        file.mkdir(parents=True, exist_ok=True)
        file /= _file_name(atlas)
    if not file.parent.is_dir():
        raise BadInput("path", f"is {given!r}, in a folder that does not exist: make it first")
    if os.path.lexists(file) and not stat.S_ISREG(os.lstat(file).st_mode):
        raise BadInput("path", f"is {given!r}, which is no regular file: only those are replaced")
    return file


def _png(atlas: Atlas) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(atlas.color).save(buffer, "PNG")
    return buffer.getvalue()


def _content(atlas: Atlas, ending: str) -> bytes:
    if ending == ".png":
        return _png(atlas)
    if ending not in _JPEG_ENDINGS:
        raise BadInput("path", f"ends in {ending!r}, must end in .jpg (the bytes as they came) or "
                       ".png, or be a folder")
    if not atlas.is_jpeg:
        raise BadInput("path", f"ends in {ending!r}, but the atlas did not come as one JPEG: save "
                       "it as .png, or ask for JPEG")
    return atlas.jpeg


def save(atlas: Atlas, path: PathLike) -> pathlib.Path:
    """See Atlas.save."""
    file = _target(atlas, path)
    content = _content(atlas, file.suffix.lower())
    descriptor, partial = tempfile.mkstemp(prefix=f".{file.name[:64]}.", dir=file.parent)
    try:
        with os.fdopen(descriptor, "wb") as out:
            umask = os.umask(0)
            os.umask(umask)
            os.fchmod(out.fileno(), 0o666 & ~umask)
            out.write(content)
        os.replace(partial, file)
    except OSError as error:
        os.unlink(partial)
        reason = _REASONS.get(error.errno, error.strerror)
        raise OSError(error.errno, f"cannot be written: {reason}", str(file)) from None
    except BaseException:
        os.unlink(partial)
        raise
    return file
