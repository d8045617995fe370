# SPDX-License-Identifier: Apache-2.0
"""Messages of the API from what callers may write in their place."""

from __future__ import annotations

from typing import Any, Mapping, TypeVar

from google.protobuf import json_format
from google.protobuf.message import Message

from viewloom.errors import BadInput

MessageT = TypeVar("MessageT", bound=Message)


def message_from(given: Any, message: MessageT, field: str, accepted: str) -> MessageT:
    """given itself, or message filled from a mapping of its fields, as in its JSON. BadInput."""
    if isinstance(given, type(message)):
        return given
    if not isinstance(given, Mapping):
        raise BadInput(field, f"is a {type(given).__name__}, must be {accepted}")
    try:
        json_format.ParseDict(dict(given), message)
    except json_format.ParseError as problem:
        raise BadInput(field, str(problem)) from None
    return message
