# SPDX-License-Identifier: Apache-2.0
"""What goes wrong, as exceptions that say the status, the field and the reason."""

from __future__ import annotations

from typing import Any

import grpc
from google.rpc import error_details_pb2, status_pb2

_DETAILS_KEY = "grpc-status-details-bin"


class ViewloomError(Exception):
    """A call or a frame that was refused, or a connection that broke.

    status:  grpc.StatusCode, the same for refusals made here and by the server.
    field:   the path of what was wrong, "open.display.quilt.columns"; "" when it is no field.
    message: what came, what is accepted.
    """

    def __init__(self, status: Any, field: str, message: str) -> None:
        super().__init__(f"{status.name}: {message}" if not field
                         else f"{status.name}: {field}: {message}")
        self.status = status
        self.field = field
        self.message = message


class BadInput(ViewloomError, ValueError):
    """An argument that was refused here, before anything was sent."""

    def __init__(self, field: str, message: str) -> None:
        super().__init__(grpc.StatusCode.INVALID_ARGUMENT, field, message)


def data_loss(message: str) -> ViewloomError:
    """Bytes from the server that are not what they were announced to be."""
    return ViewloomError(grpc.StatusCode.DATA_LOSS, "", message)


def _violated_field(rpc_error: Any) -> str:
    """The field that a google.rpc.BadRequest in the trailing metadata names, or ""."""
    for key, value in rpc_error.trailing_metadata() or ():
        if key != _DETAILS_KEY:
            continue
        for detail in status_pb2.Status.FromString(value).details:
            bad_request = error_details_pb2.BadRequest()
            if detail.Unpack(bad_request) and bad_request.field_violations:
                return str(bad_request.field_violations[0].field)
    return ""


def error_from_rpc(rpc_error: Any) -> ViewloomError:
    """The grpc.RpcError of a blocking or of an asyncio call, in viewloom's words.

    Of calls that the caller has not cancelled himself: then it is gRPC that did. It does so with
    those that reach a server between the end of its drain and the end of its connections, which
    are to be tried again like all others that a leaving server turns away.
    """
    if rpc_error.code() == grpc.StatusCode.CANCELLED:
        return ViewloomError(grpc.StatusCode.UNAVAILABLE, "",
                             "the call was cut off as the server or the connection ended")
    field = _violated_field(rpc_error)
    # The server's message begins with the field, which stands beside it here.
    message = (rpc_error.details() or "").removeprefix(f"{field}: ")
    return ViewloomError(rpc_error.code(), field, message)
