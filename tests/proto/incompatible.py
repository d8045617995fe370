# SPDX-License-Identifier: Apache-2.0
"""Which changes of protos break a program that was made with them before.

A program may have generated code, bytes that it kept, or JSON: so numbers, types, names and the
files to import count. Additions break nothing.
"""

from typing import NamedTuple


class Break(NamedTuple):
    """declaration: full name of the message, enum or service that changed."""

    declaration: str
    what: str

    def __str__(self):
        return f"{self.declaration}: {self.what}"


def _is_covered(first, last, spans):
    """Whether every number from first to last is in one of the spans."""
    for start, end in sorted(spans):
        if start <= first <= end:
            first = end + 1
    return first > last


def _changed_fields(before, after):
    new_numbers = {one.name: number for number, one in after.fields.items()}
    for number, old in before.fields.items():
        new = after.fields.get(number)
        if new_numbers.get(old.name, number) != number:
            yield f"{old.name} had number {number}, now {new_numbers[old.name]}"
        elif new is None:
            yield f"{old.name} is removed; its number {number} and its name stay reserved"
        elif new != old:
            yield from _changed_field(number, old, new)


def _changed_field(number, old, new):
    if new.name != old.name:
        yield f"field {number} was named {old.name}, now {new.name}"
    if new.type != old.type:
        yield f"{new.name} was of type {old.type}, now {new.type}"
    if new.label != old.label:
        yield f"{new.name} was {old.label or 'singular'}, now {new.label or 'singular'}"
    if new.oneof != old.oneof:
        yield f"{new.name} was in {old.oneof or 'no'} oneof, now in {new.oneof or 'none'}"
    if new.json_name != old.json_name:
        yield (f"{new.name} was \"{old.json_name or old.name}\" in JSON, "
               f"now \"{new.json_name or new.name}\"")


def _changed_values(before, after):
    for name, number in before.values.items():
        if name not in after.values:
            named = [new for new, same in after.values.items() if same == number]
            yield f"{name} is " + (f"renamed to {named[0]}" if named else "removed")
        elif after.values[name] != number:
            yield f"{name} had number {number}, now {after.values[name]}"


def _changed_calls(before, after):
    for name, old in before.calls.items():
        new = after.calls.get(name)
        if new is None:
            yield f"call {name} is removed"
            continue
        if new.request != old.request:
            yield f"{name} took {old.request}, now {new.request}"
        if new.response != old.response:
            yield f"{name} gave {old.response}, now {new.response}"
        for way, was, now in (("request", old.request_stream, new.request_stream),
                              ("response", old.response_stream, new.response_stream)):
            if was != now:
                yield f"{way} of {name} was {'a stream' if was else 'one message'}, now " + (
                    "a stream" if now else "one message")


def _broken_reservations(before, after):
    used = {number: one.name for number, one in after.fields.items()}
    used.update({number: name for name, number in after.values.items()})
    for first, last in before.reserved:
        taken = [number for number in used if first <= number <= last]
        for number in sorted(taken):
            yield f"{used[number]} takes the reserved number {number}"
        if not taken and not _is_covered(first, last, after.reserved):
            yield f"{first}..{last} is no longer reserved" if last > first else \
                f"{first} is no longer reserved"
    for name in sorted(before.reserved_names - after.reserved_names):
        yield f"takes the reserved name {name}" if name in used.values() else \
            f"the name {name} is no longer reserved"


def breaks(before, after):
    """Each incompatible change between two results of declarations.read, sorted by names."""
    found = []
    for name, old in sorted(before.items()):
        new = after.get(name)
        if new is None or new.kind != old.kind:
            found.append(Break(name, f"the {old.kind} is removed"))
            continue
        if new.file != old.file:
            found.append(Break(name, f"was declared in {old.file}, now in {new.file}"))
        for changed in (_changed_fields, _changed_values, _changed_calls, _broken_reservations):
            found += [Break(name, what) for what in changed(old, new)]
    return found
