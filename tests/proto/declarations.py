# SPDX-License-Identifier: Apache-2.0
"""What protos declare, as text with a line for each field, enum value and call, and read back.

    message viewloom.v1.Fov (viewloom/v1/geometry.proto)
      1 double angle_left_rad
      reserved 7 to 9
"""

import pathlib
import re
import subprocess
import tempfile
from dataclasses import dataclass, field
from typing import NamedTuple

from google.protobuf import descriptor_pb2

PACKAGES = "viewloom."
_PROTO = descriptor_pb2.FieldDescriptorProto
_HEAD = re.compile(r"(message|enum|service) ([\w.]+) \(([\w./]+)\)")
_FIELD = re.compile(r"  (\d+) (?:(optional|repeated) )?(map<.*?>|[\w.]+) (\w+)"
                    r"(?: in oneof (\w+))?(?: as \"([^\"]*)\")?")
_RESERVED = re.compile(r"  reserved (?:(\d+)(?: to (\d+))?|\"(\w+)\")")
_VALUE = re.compile(r"  (\d+|-\d+) (\w+)")
_CALL = re.compile(r"  rpc (\w+)\((stream )?([\w.]+)\) returns \((stream )?([\w.]+)\)")


class Field(NamedTuple):
    """One field of a message. label: "", "optional" or "repeated"."""

    label: str
    type: str
    name: str
    oneof: str
    json_name: str  # "": the one that follows from the name


class Call(NamedTuple):
    """One call of a service."""

    request_stream: bool
    request: str
    response_stream: bool
    response: str


@dataclass
class Declaration:
    """A message with its fields, an enum with its values, or a service with its calls."""

    kind: str
    file: str
    fields: dict = field(default_factory=dict)    # number: Field
    values: dict = field(default_factory=dict)    # name: number
    calls: dict = field(default_factory=dict)     # name: Call
    reserved: list = field(default_factory=list)  # (first, last), both reserved
    reserved_names: set = field(default_factory=set)


def _json_name(name):
    return re.sub(r"_+([a-zA-Z0-9])", lambda match: match.group(1).upper(), name).replace("_", "")


def _type_text(one, entries):
    if one.type_name in entries:
        key, value = entries[one.type_name].field
        return f"map<{_type_text(key, entries)}, {_type_text(value, entries)}>"
    if one.type_name:
        return one.type_name.lstrip(".")
    return _PROTO.Type.Name(one.type).removeprefix("TYPE_").lower()


def _field_line(one, message, entries):
    label = "optional " if one.proto3_optional else ""
    if one.label == _PROTO.LABEL_REPEATED and one.type_name not in entries:
        label = "repeated "
    line = f"  {one.number} {label}{_type_text(one, entries)} {one.name}"
    if one.HasField("oneof_index") and not one.proto3_optional:
        line += f" in oneof {message.oneof_decl[one.oneof_index].name}"
    if one.json_name and one.json_name != _json_name(one.name):
        line += f' as "{one.json_name}"'
    return line


def _reserved_lines(of, last_of):
    for span in sorted(of.reserved_range, key=lambda span: span.start):
        last = last_of(span)
        yield f"  reserved {span.start}" + (f" to {last}" if last != span.start else "")
    for name in sorted(of.reserved_name):
        yield f'  reserved "{name}"'


def _message_lines(message, scope):
    """(full name, kind, lines) of a message and of what is declared in it."""
    name = f"{scope}.{message.name}"
    entries = {f".{name}.{one.name}": one for one in message.nested_type if one.options.map_entry}
    lines = [_field_line(one, message, entries)
             for one in sorted(message.field, key=lambda one: one.number)]
    yield name, "message", lines + list(_reserved_lines(message, lambda span: span.end - 1))
    for nested in message.nested_type:
        if not nested.options.map_entry:
            yield from _message_lines(nested, name)
    for enum in message.enum_type:
        yield _enum_lines(enum, name)


def _enum_lines(enum, scope):
    values = sorted((value.number, value.name) for value in enum.value)
    return f"{scope}.{enum.name}", "enum", [f"  {number} {name}" for number, name in values] + list(
        _reserved_lines(enum, lambda span: span.end))


def _service_lines(service, scope):
    return f"{scope}.{service.name}", "service", sorted(
        f"  rpc {call.name}({'stream ' * call.client_streaming}{call.input_type.lstrip('.')}) "
        f"returns ({'stream ' * call.server_streaming}{call.output_type.lstrip('.')})"
        for call in service.method)


def text_of(folder, protoc="protoc"):
    """The text of all protos in the folder whose package is ours, sorted by full names."""
    files = sorted(str(file.relative_to(folder))
                   for file in pathlib.Path(folder).rglob("*.proto"))
    with tempfile.NamedTemporaryFile() as output:
        subprocess.run([protoc, f"--descriptor_set_out={output.name}", "-I", ".", *files],
                       cwd=folder, check=True)
        descriptors = descriptor_pb2.FileDescriptorSet.FromString(output.read())
    found = []
    for file in descriptors.file:
        if file.package.startswith(PACKAGES):
            parts = [_enum_lines(one, file.package) for one in file.enum_type]
            parts += [_service_lines(one, file.package) for one in file.service]
            for one in file.message_type:
                parts += _message_lines(one, file.package)
            found += [(name, kind, file.name, lines) for name, kind, lines in parts]
    return "\n\n".join("\n".join([f"{kind} {name} ({file})", *lines])
                       for name, kind, file, lines in sorted(found)) + "\n"


def _read_line(line, into):
    if match := _RESERVED.fullmatch(line):
        first, last, name = match.groups()
        if name:
            into.reserved_names.add(name)
        else:
            into.reserved.append((int(first), int(last or first)))
    elif into.kind == "message" and (match := _FIELD.fullmatch(line)):
        number, *rest = match.groups(default="")
        into.fields[int(number)] = Field(*rest)
    elif into.kind == "enum" and (match := _VALUE.fullmatch(line)):
        into.values[match.group(2)] = int(match.group(1))
    elif into.kind == "service" and (match := _CALL.fullmatch(line)):
        name, takes, request, gives, response = match.groups()
        into.calls[name] = Call(bool(takes), request, bool(gives), response)
    else:
        return False
    return True


def read(text):
    """{full name: Declaration} of such a text. Lines that begin with # are comments."""
    declared, current = {}, None
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        if match := _HEAD.fullmatch(line):
            current = declared[match.group(2)] = Declaration(match.group(1), match.group(3))
        elif current is None or not _read_line(line, current):
            raise ValueError(f"line {number} declares nothing: {line!r}")
    return declared
