# SPDX-License-Identifier: Apache-2.0
"""Each change that breaks programs is found between two small protos, and additions are not."""

import pathlib
import sys
import tempfile
import unittest

import declarations
import incompatible

PROTOC = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else "protoc"


def declared(files):
    """What protos of {name: text after the package} declare; a text alone is a.proto."""
    if isinstance(files, str):
        files = {"a.proto": files}
    with tempfile.TemporaryDirectory() as folder:
        package = pathlib.Path(folder) / "viewloom" / "v1"
        package.mkdir(parents=True)
        for name, text in files.items():
            (package / name).write_text(f'syntax = "proto3";\npackage viewloom.v1;\n{text}\n',
                                        encoding="utf-8")
        return declarations.read(declarations.text_of(folder, PROTOC))


def breaks(before, after):
    return [str(one).removeprefix("viewloom.v1.")
            for one in incompatible.breaks(declared(before), declared(after))]


def message(*lines):
    return "message B {}\nmessage A {\n" + "\n".join(lines) + "\n}"


class Fields(unittest.TestCase):
    def between(self, before, after):
        return breaks(message(*before), message(*after))

    def test_a_field_that_is_removed(self):
        found = ["A: x is removed; its number 1 and its name stay reserved"]
        self.assertEqual(self.between(["int32 x = 1;"], []), found)
        self.assertEqual(self.between(["int32 x = 1;"], ['reserved 1; reserved "x";']), found)

    def test_a_field_with_another_number(self):
        self.assertEqual(self.between(["int32 x = 1;"], ["int32 x = 2;"]),
                         ["A: x had number 1, now 2"])

    def test_a_field_with_another_name(self):
        self.assertEqual(self.between(["int32 x = 1;"], ["int32 y = 1;"]),
                         ["A: field 1 was named x, now y"])
        self.assertEqual(self.between(["int32 x = 1;"], ['int32 x = 1 [json_name = "z"];']),
                         ['A: x was "x" in JSON, now "z"'])

    def test_two_fields_that_change_places(self):
        self.assertEqual(self.between(["int32 x = 1;", "int32 y = 2;"],
                                      ["int32 y = 1;", "int32 x = 2;"]),
                         ["A: x had number 1, now 2", "A: y had number 2, now 1"])

    def test_a_field_of_another_type(self):
        self.assertEqual(self.between(["int32 x = 1;"], ["int64 x = 1;"]),
                         ["A: x was of type int32, now int64"])
        self.assertEqual(self.between(["B x = 1;"], ["A x = 1;"]),
                         ["A: x was of type viewloom.v1.B, now viewloom.v1.A"])
        self.assertEqual(self.between(["map<string, B> x = 1;"], ["map<int32, B> x = 1;"]),
                         ["A: x was of type map<string, viewloom.v1.B>, "
                          "now map<int32, viewloom.v1.B>"])

    def test_a_field_with_another_label(self):
        self.assertEqual(self.between(["int32 x = 1;"], ["repeated int32 x = 1;"]),
                         ["A: x was singular, now repeated"])
        self.assertEqual(self.between(["optional int32 x = 1;"], ["int32 x = 1;"]),
                         ["A: x was optional, now singular"])

    def test_a_field_that_enters_or_leaves_a_oneof(self):
        inside = ["oneof kind { int32 x = 1; }"]
        self.assertEqual(self.between(["int32 x = 1;"], inside),
                         ["A: x was in no oneof, now in kind"])
        self.assertEqual(self.between(inside, ["int32 x = 1;"]),
                         ["A: x was in kind oneof, now in none"])
        self.assertEqual(self.between(inside, ["oneof sort { int32 x = 1; }"]),
                         ["A: x was in kind oneof, now in sort"])

    def test_a_reserved_number_or_name_that_is_used(self):
        self.assertEqual(self.between(["reserved 2 to 4;"], ["int32 x = 3;"]),
                         ["A: x takes the reserved number 3"])
        self.assertEqual(self.between(['reserved "x";'], ["int32 x = 3;"]),
                         ["A: takes the reserved name x"])

    def test_a_number_or_name_that_is_no_longer_reserved(self):
        self.assertEqual(self.between(["reserved 2 to 4;", 'reserved "x";'], ["reserved 2, 3;"]),
                         ["A: 2..4 is no longer reserved", "A: the name x is no longer reserved"])
        self.assertEqual(self.between(["reserved 2 to 4;"], ["reserved 2, 3 to max;"]), [])


class Others(unittest.TestCase):
    def test_a_message_an_enum_or_a_service_that_is_removed(self):
        self.assertEqual(breaks(message(), "message B {}"), ["A: the message is removed"])
        self.assertEqual(breaks(message("message C {}"), message()),
                         ["A.C: the message is removed"])
        self.assertEqual(breaks("enum E { E_X = 0; }", ""), ["E: the enum is removed"])
        self.assertEqual(breaks("service S {}", ""), ["S: the service is removed"])
        self.assertEqual(breaks("message C {}", "enum C { C_X = 0; }"),
                         ["C: the message is removed"])

    def test_a_declaration_in_another_file(self):
        self.assertEqual(breaks({"a.proto": "message C {}"}, {"b.proto": "message C {}"}),
                         ["C: was declared in viewloom/v1/a.proto, now in viewloom/v1/b.proto"])

    def test_an_enum_value_that_is_removed_renamed_or_renumbered(self):
        before = "enum E { E_X = 0; E_Y = 1; }"
        self.assertEqual(breaks(before, "enum E { E_X = 0; reserved 1; }"), ["E: E_Y is removed"])
        self.assertEqual(breaks(before, "enum E { E_X = 0; E_Z = 1; }"),
                         ["E: E_Y is renamed to E_Z"])
        self.assertEqual(breaks(before, "enum E { E_X = 0; E_Y = 2; }"),
                         ["E: E_Y had number 1, now 2"])

    def test_a_reserved_value_that_is_used(self):
        self.assertEqual(breaks("enum E { E_X = 0; reserved 1; }", "enum E { E_X = 0; E_Y = 1; }"),
                         ["E: E_Y takes the reserved number 1"])

    def test_a_call_that_is_removed_or_changed(self):
        def service(call):
            return message() + "service S { " + call + " }"
        before = service("rpc Do(A) returns (stream B);")
        for call, found in (
                ("", ["S: call Do is removed"]),
                ("rpc Do(B) returns (stream B);",
                 ["S: Do took viewloom.v1.A, now viewloom.v1.B"]),
                ("rpc Do(A) returns (stream A);",
                 ["S: Do gave viewloom.v1.B, now viewloom.v1.A"]),
                ("rpc Do(stream A) returns (stream B);",
                 ["S: request of Do was one message, now a stream"]),
                ("rpc Do(A) returns (B);",
                 ["S: response of Do was a stream, now one message"])):
            self.assertEqual(breaks(before, service(call)), found)


class Additions(unittest.TestCase):
    def test_what_is_added_breaks_nothing(self):
        before = message("oneof kind { int32 x = 1; }") + \
            "enum E { E_X = 0; } service S { rpc Do(A) returns (B); }"
        after = message("oneof kind { int32 x = 1; int32 y = 2; }", "map<string, E> z = 3;",
                        "reserved 8;", "message C {}", "enum F { F_X = 0; }") + \
            "enum E { E_X = 0; E_Y = 1; } message D {} " \
            "service S { rpc Do(A) returns (B); rpc Undo(A) returns (B); } service T {}"
        self.assertEqual(breaks(before, after), [])

    def test_comments_and_deprecation_break_nothing(self):
        self.assertEqual(breaks(message("int32 x = 1;"),
                                message("int32 x = 1 [deprecated = true];  // see y")), [])


if __name__ == "__main__":
    unittest.main()
