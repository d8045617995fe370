# SPDX-License-Identifier: Apache-2.0
"""Encryption of the connection to a server, and how the two know each other."""

from __future__ import annotations

import hashlib
import os
import re
import socket
import ssl
from typing import Any, NamedTuple, Optional, Union

import grpc

from viewloom.connection import CHANNEL_OPTIONS
from viewloom.errors import BadInput, ViewloomError

_SCHEME = "https://"
_ANSWER_S = 5.0  # for a server to show its certificate
_Path = Union[str, "os.PathLike[str]"]


class Tls(NamedTuple):
    """What a connection to https://HOST:PORT needs beside the authorities of the system.

    fingerprint: SHA-256 of the server's certificate, as the server prints it: the server is known
                 by it alone. connect() then asks the server for its certificate, and waits for it.
    ca:          file of certificates in PEM that the server's must come from.
    certificate, key: files in PEM that this client shows to a server that asks; both or none.
    """

    fingerprint: str = ""
    ca: _Path = ""
    certificate: _Path = ""
    key: _Path = ""


class _Shown(NamedTuple):
    """A server's certificate."""

    der: bytes
    names: list[str]  # known once it is trusted


def open_channel(module: Any, address: str, tls: Optional[Tls]) -> Any:
    """A channel of grpc or of grpc.aio to HOST:PORT or https://HOST:PORT."""
    if not address.startswith(_SCHEME):
        if tls is not None:
            raise BadInput("tls", f"is given, and the address {address} has no encryption; "
                           "must be with an address https://HOST:PORT")
        return module.insecure_channel(address, options=CHANNEL_OPTIONS)
    chosen = tls or Tls()
    target = address.removeprefix(_SCHEME)
    if bool(chosen.certificate) != bool(chosen.key):
        raise BadInput("tls", "has a certificate without its key, or a key without its "
                       "certificate; must have both or none")
    roots = _read(chosen.ca) if chosen.ca else None
    options: tuple[tuple[str, Any], ...] = CHANNEL_OPTIONS
    if chosen.fingerprint:
        shown = _pinned(target, chosen)
        roots = ssl.DER_cert_to_PEM_cert(shown.der).encode()
        # gRPC compares names, too, and this one is in the certificate.
        options += (("grpc.ssl_target_name_override", _name_of(shown)),)
    own = (_read(chosen.key), _read(chosen.certificate)) if chosen.key else (None, None)
    return module.secure_channel(target, grpc.ssl_channel_credentials(roots, *own), options=options)


def _read(path: _Path) -> bytes:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as problem:
        raise BadInput("tls", f"{os.fspath(path)} cannot be read ({problem.strerror}); must be a "
                       "file in PEM") from None


def _parsed_fingerprint(text: str) -> bytes:
    digits = re.sub("^sha256:", "", text.strip(), flags=re.IGNORECASE).replace(":", "")
    if not re.fullmatch("[0-9A-Fa-f]{64}", digits):
        raise BadInput("tls", f"has the fingerprint {text!r}, must be SHA-256 in 64 hexadecimal "
                       "digits, as `viewloomd serve` prints it")
    return bytes.fromhex(digits)


def _pinned(target: str, tls: Tls) -> _Shown:
    wanted = _parsed_fingerprint(tls.fingerprint)
    shown = _shown(target, tls, None)
    if hashlib.sha256(shown.der).digest() != wanted:
        raise ViewloomError(grpc.StatusCode.UNAUTHENTICATED, "",
                            f"the certificate of {target} is not the pinned one; if the server has "
                            "a new certificate, give the fingerprint that the server itself prints")
    return _shown(target, tls, shown)


def _shown(target: str, tls: Tls, trusted: Optional[_Shown]) -> _Shown:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.set_alpn_protocols(["h2"])
    if trusted is None:
        context.verify_mode = ssl.CERT_NONE
    else:
        context.verify_flags |= 0x80000  # X509_V_FLAG_PARTIAL_CHAIN, which Python 3.9 does not name
        context.load_verify_locations(cadata=trusted.der)
    host, _, port = target.rpartition(":")
    try:
        if tls.certificate:
            context.load_cert_chain(tls.certificate, tls.key)
        with socket.create_connection((host.strip("[]"), int(port)), _ANSWER_S) as plain, \
                context.wrap_socket(plain) as secured:
            der = secured.getpeercert(binary_form=True) or b""
            facts: Any = secured.getpeercert() or {}
    except ssl.SSLError as problem:
        raise ViewloomError(grpc.StatusCode.UNAVAILABLE, "",
                            f"no connection with TLS to {target} ({problem.reason}): check the "
                            "address, and the files of this client") from None
    except OSError as problem:
        raise ViewloomError(grpc.StatusCode.UNAVAILABLE, "",
                            f"no viewloomd answers at {target} ({problem.strerror or problem}): "
                            "start one, or correct the address") from None
    return _Shown(der, [name for kind, name in facts.get("subjectAltName", ())
                        if kind in ("DNS", "IP Address")])


def _name_of(shown: _Shown) -> str:
    return shown.names[0].replace("*", "any") if shown.names else "viewloomd"
