# SPDX-License-Identifier: Apache-2.0
"""What goes wrong, as exceptions that say the status, the field and the reason."""

from __future__ import annotations

import re
from typing import Any, NamedTuple, Optional

import grpc

from viewloom.rpc import error_details_pb2, status_pb2

_DETAILS_KEY = "grpc-status-details-bin"


def _printable(text: str) -> str:
    """The text of whoever it is, without what would drive a terminal."""
    return "".join(character if character.isprintable() or character == "\n"
                   else character.encode("unicode_escape").decode() for character in text)


class ViewloomError(Exception):
    """A call or a frame that was refused, or a connection that broke.

    status:  grpc.StatusCode, the same for refusals made here and by the server.
    field:   the path of what was wrong, "open.display.quilt.columns"; "" when it is no field.
    message: what came, what is accepted: as it came, while str() shows control characters as codes.
    is_from_server: the server said so itself; else a proxy, the connection or this package did.
    retry_delay_s:  after how long the server says to ask again; None = it says nothing.
    """

    def __init__(self, status: Any, field: str, message: str, *, is_from_server: bool = False,
                 retry_delay_s: Optional[float] = None) -> None:
        super().__init__(_printable(f"{status.name}: {message}" if not field
                                    else f"{status.name}: {field}: {message}"))
        self.status = status
        self.field = field
        self.message = message
        self.is_from_server = is_from_server
        self.retry_delay_s = retry_delay_s


class BadInput(ViewloomError, ValueError):
    """An argument that was refused here, before anything was sent."""

    def __init__(self, field: str, message: str) -> None:
        super().__init__(grpc.StatusCode.INVALID_ARGUMENT, field, message)


class UnlikelyInput(UserWarning):
    """An argument that is taken as it is, and probably means something else."""


def data_loss(message: str) -> ViewloomError:
    """Bytes from the server that are not what they were announced to be."""
    return ViewloomError(grpc.StatusCode.DATA_LOSS, "", message)


class _Details(NamedTuple):
    """What the server tells beside its message."""

    is_there: bool = False
    field: str = ""
    retry_delay_s: Optional[float] = None


def _details_of(rpc_error: Any) -> _Details:
    details = _Details()
    for key, value in rpc_error.trailing_metadata() or ():
        if key != _DETAILS_KEY:
            continue
        details = details._replace(is_there=True)
        for detail in status_pb2.Status.FromString(value).details:
            if detail.TypeName() == "google.rpc.BadRequest":
                bad_request = error_details_pb2.BadRequest.FromString(detail.value)
                for violation in bad_request.field_violations[:1]:
                    details = details._replace(field=str(violation.field))
            elif detail.TypeName() == "google.rpc.RetryInfo":
                delay = error_details_pb2.RetryInfo.FromString(detail.value).retry_delay
                details = details._replace(retry_delay_s=delay.seconds + 1e-9 * delay.nanos)
    return details


def _no_server(address: str, reason: str) -> Optional[str]:
    """What to do where nobody answers, from gRPC's reason; None where it is another one."""
    if "http1.x" in reason.lower():
        return (f"what answers at {address} is no gRPC server: give the gRPC address of viewloomd, "
                "not that of its page; it is port 50051 unless you chose another")
    if "DNS resolution failed" in reason or "Domain name not found" in reason:
        return f"there is no host of that name: {address}; accepted is HOST:PORT"
    if "failed to connect" not in reason.lower():
        return None
    if re.search("certificate.verify.failed|hostname verification|not in peer certificate", reason,
                 re.IGNORECASE):
        return (f"the certificate of {address} is not accepted: connect by a name that it has, and "
                "name its authority with Tls(ca=FILE), or pin it with Tls(fingerprint=HEX)")
    if re.search("wrong.version.number", reason, re.IGNORECASE):
        return f"the server at {address} speaks no TLS: write its address without https://"
    cause = reason.rsplit(": ", 1)[-1].strip()
    if cause == "Socket closed":
        return (f"the server at {address} closed the connection before the call: if it speaks TLS, "
                "write its address as https://HOST:PORT; if it asks for certificates, give "
                "Tls(certificate=FILE, key=FILE)")
    return (f"no viewloomd answers at {address} ({cause}): start one with `viewloomd serve` or "
            "`deploy/demo.sh`, or say where it is: viewloom.connect(\"HOST:PORT\")")


def error_from_rpc(rpc_error: Any, address: str) -> ViewloomError:
    """The grpc.RpcError of a blocking or of an asyncio call, in viewloom's words.

    address: of the server that was called.
    Of calls that the caller has not cancelled himself: then it is gRPC that did. It does so with
    those that reach a server between the end of its drain and the end of its connections, which
    are to be tried again like all others that a leaving server turns away.
    """
    if rpc_error.code() == grpc.StatusCode.CANCELLED:
        return ViewloomError(grpc.StatusCode.UNAVAILABLE, "",
                             "the call was cut off as the server or the connection ended")
    details = _details_of(rpc_error)
    # The server's message begins with the field, which stands beside it here.
    message = (rpc_error.details() or "").removeprefix(f"{details.field}: ")
    if not details.is_there:
        message = _no_server(address, message) or message
    return ViewloomError(rpc_error.code(), details.field, message,
                         is_from_server=details.is_there, retry_delay_s=details.retry_delay_s)
