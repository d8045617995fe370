# SPDX-License-Identifier: Apache-2.0
"""Plants what each rule forbids in a small tree and asks for exactly that finding."""

import unittest

import build_rules
import layering
import proto_rules
import schedule_rules
import text_rules
import user_texts
from planted_tree import rules_broken

LICENCE = "// SPDX-License-Identifier: Apache-2.0\n"


class Layers(unittest.TestCase):
    def broken(self, path, target, **others):
        files = {path: f"#include {target}\n"}
        files.update({name.replace("__", "/") + ".h": "" for name in others})
        return [rule for _, rule in rules_broken(layering.check, files)]

    def test_an_include_downwards_is_allowed(self):
        self.assertEqual(self.broken("server/engine/walk/trace/a.cpp", '"base/check.h"',
                                     server__core__base__check=1), [])

    def test_an_include_upwards_is_found(self):
        self.assertEqual(self.broken("server/core/base/a.h", '"frame/frame.h"',
                                     server__core__frame__frame=1), ["layers"])

    def test_a_relative_path_does_not_hide_an_upward_include(self):
        self.assertEqual(self.broken("server/core/base/a.h", '"../frame/frame.h"',
                                     server__core__frame__frame=1), ["layers"])

    def test_the_client_shares_the_core_alone(self):
        self.assertEqual(self.broken("client/lib/a.cpp", '"frame/frame.h"',
                                     server__core__frame__frame=1), [])
        self.assertEqual(self.broken("client/lib/a.cpp", '"rpc/peer.h"', server__rpc__peer=1),
                         ["layers"])

    def test_the_server_knows_no_client(self):
        self.assertEqual(self.broken("server/service.cpp", '"lib/channel.h"',
                                     client__lib__channel=1), ["layers"])

    def test_rpc_never_sees_the_gpu(self):
        self.assertEqual(self.broken("server/rpc/a.cpp", '"gpu/device.h"', server__gpu__device=1),
                         ["layers"])

    def test_a_single_header_opens_no_folder(self):
        self.assertEqual(self.broken("server/web/a.cpp", '"encode/encoded_band.h"',
                                     server__encode__encoded_band=1), [])
        self.assertEqual(self.broken("server/web/a.cpp", '"encode/jpeg_encoder.h"',
                                     server__encode__jpeg_encoder=1), ["layers"])

    def test_a_third_party_of_another_layer_is_found(self):
        self.assertEqual(self.broken("server/publish/a.h", "<grpcpp/server.h>"), ["layers"])
        self.assertEqual(self.broken("client/lib/a.h", "<vulkan/vulkan_raii.hpp>"), ["layers"])
        self.assertEqual(self.broken("server/rpc/a.h", "<grpcpp/server.h>"), [])

    def test_the_schedule_knows_no_pipeline(self):
        self.assertEqual(self.broken("server/schedule/a.h", '"pipeline/tick_loop.h"',
                                     server__pipeline__tick_loop=1), ["layers"])
        self.assertEqual(self.broken("server/pipeline/a.h", '"schedule/job_queue.h"',
                                     server__schedule__job_queue=1), [])

    def test_the_standard_library_is_everybodys(self):
        self.assertEqual(self.broken("server/core/base/a.h", "<vector>"), [])
        self.assertEqual(self.broken("server/core/base/a.h", "<sys/socket.h>"), [])

    def test_a_header_nobody_knows_is_found(self):
        self.assertEqual(self.broken("server/core/base/a.h", '"base/gone.h"'), ["layers"])

    def test_the_service_may_include_everything(self):
        self.assertEqual(self.broken("server/service.cpp", '"rpc/server.h"', server__rpc__server=1),
                         [])

    def test_the_oracle_is_independent_of_what_it_judges(self):
        self.assertEqual(self.broken("tests/oracle/a.h", '"shared/structure.h"',
                                     shaders__shared__structure=1), ["layers"])

    def test_a_shader_library_knows_no_entry_point(self):
        self.assertEqual(self.broken("shaders/lib/a.glsl", '"trace/walk.h"',
                                     shaders__trace__walk=1), ["layers"])


class Schedule(unittest.TestCase):
    def broken(self, text, path="server/schedule/a.cpp"):
        return [rule for _, rule in rules_broken(schedule_rules.check, {path: text + "\n"})]

    def test_threads_waits_and_clocks_are_found(self):
        for text in ("std::jthread thread_;", "std::thread thread;", "#include <thread>",
                     "#include <condition_variable>", "std::condition_variable_any changed_;",
                     "std::this_thread::sleep_for(nap);", "changed_.wait(lock);", "usleep (5);",
                     "std::binary_semaphore may_go_on_{0};",
                     "const auto now = std::chrono::steady_clock::now();", "SteadyClock clock;"):
            self.assertEqual(self.broken(text), ["schedule"], text)

    def test_clocks_that_are_handed_in_and_a_mutex_are_allowed(self):
        for text in ("explicit Board(const Clock& clock);", "std::mutex mutex_;",
                     "const int64_t now_ns = clock_.nowNs();", "std::lock_guard lock(mutex_);",
                     "int64_t eyesWaitUntilNs(int64_t now_ns);", "// no std::thread here"):
            self.assertEqual(self.broken(text), [], text)

    def test_other_folders_have_threads(self):
        self.assertEqual(self.broken("std::jthread thread_;", "server/pipeline/a.h"), [])


class UserTexts(unittest.TestCase):
    def broken(self, path, text):
        return [rule for _, rule in rules_broken(user_texts.check, {path: text})]

    def test_words_of_developers_are_found_in_what_users_read(self):
        for path, text in (("client/cli/a.cpp", 'line.say("the slot is full");\n'),
                           ("server/commands/a.cpp", 'std::cerr << "a scene was traced";\n'),
                           ("server/rpc/a.cpp",
                            'log(LogLevel::kInfo, name,\n    " is draining");\n')):
            self.assertEqual(self.broken(path, text), ["user text"], text)

    def test_names_and_texts_for_developers_are_free(self):
        for path, text in (("client/cli/a.cpp", 'json["trace"] = 1;\n'),
                           ("client/cli/a.cpp", '// "traced here"\n'),
                           ("server/rpc/a.cpp", 'log(LogLevel::kInfo, name);\nx("a slot");\n'),
                           ("server/engine/walk/trace/a.cpp", 'pass("trace the views");\n')):
            self.assertEqual(self.broken(path, text), [], text)


class Text(unittest.TestCase):
    def broken(self, path, text):
        return [rule for _, rule in rules_broken(text_rules.check, {path: text})]

    def test_a_clean_file_passes(self):
        self.assertEqual(self.broken("server/base/a.h", LICENCE + "// One sentence.\n"), [])

    def test_a_missing_licence_is_found(self):
        self.assertEqual(self.broken("server/base/a.h", "int a;\n"), ["licence"])
        self.assertEqual(self.broken("tests/CMakeLists.txt", "\n"), ["licence"])
        self.assertEqual(self.broken(
            "server/base/a.h", "// SPDX-License-Identifier: Apache-2.0 Counts frames.\n"),
            ["licence"])

    def test_long_files_and_lines_are_found(self):
        self.assertEqual(self.broken("a.cpp", LICENCE + "\n" * 299), [])
        self.assertEqual(self.broken("a.cpp", LICENCE + "\n" * 300), ["length"])
        self.assertEqual(self.broken("server/main.cpp", LICENCE + "\n" * 60), ["length"])
        self.assertEqual(self.broken("a.cpp", LICENCE + "/" * 101), ["columns"])

    def test_long_functions_are_found_in_each_language(self):
        body = "  call();\n" * 59
        for head in ("void run(int a) {", "void Type::run() const noexcept {"):
            self.assertEqual(self.broken("a.cpp", f"{LICENCE}{head}\n{body}}}\n"), ["function"])
        short = "  call();\n" * 58
        self.assertEqual(self.broken("a.cpp", f"{LICENCE}void run() {{\n{short}}}\n"), [])
        self.assertEqual(self.broken("a.js", f"{LICENCE}function run(a) {{\n{body}}}\n"),
                         ["function"])
        python = "# SPDX-License-Identifier: Apache-2.0\ndef run():\n" + "    call()\n" * 60
        self.assertEqual(self.broken("a.py", python), ["function"])

    def test_a_signature_over_two_lines_counts_whole(self):
        body = "  call();\n" * 57
        text = f"{LICENCE}void run(int a,\n         int b,\n         int c) {{\n{body}}}\n"
        self.assertEqual(self.broken("a.cpp", text), ["function"])

    def test_a_lambda_is_part_of_its_function(self):
        body = "  call();\n" * 40
        text = (f"{LICENCE}void a() {{\n  Server server(\n      [&](int b) {{\n        call();\n"
                f"      }});\n{body}}}\nvoid b() {{\n{body}}}\n")
        self.assertEqual(self.broken("a.cpp", text), [])

    def test_namespaces_and_classes_are_no_functions(self):
        body = "int a;\n" * 80
        self.assertEqual(self.broken("a.h", f"{LICENCE}namespace viewloom {{\n{body}}}\n"), [])

    def test_unfinished_work_is_found(self):
        for word in ("TO" "DO", "FIX" "ME", "HA" "CK", "X" "XX"):
            self.assertEqual(self.broken("a.cpp", LICENCE + f"// {word}: later\n"), ["unfinished"])

    def test_words_about_the_making_are_found(self):
        for words in ("as issue " "12 asked", "the proto" "type did it", "Co-auth" "ored-by: me"):
            self.assertEqual(self.broken("README.md", words + "\n"), ["making"])
        self.assertEqual(self.broken("a.js", LICENCE + "Array.proto" "type.map\n"), [])
        self.assertEqual(self.broken("a.cpp", LICENCE + "const auto* proto" "type = b;\n"), [])

    def test_machine_paths_are_found(self):
        self.assertEqual(self.broken("a.md", "see /wo" "rk/notes\n"), ["machine path"])
        self.assertEqual(self.broken("a.md", "in /ho" "me/me/viewloom\n"), ["machine path"])
        self.assertEqual(self.broken("a.md", "https://example.org/wo" "rk/a\n"), [])

    def test_vague_names_are_found(self):
        self.assertEqual(self.broken("a.h", LICENCE + "class BufferMan" "ager {};\n"), ["name"])
        self.assertEqual(self.broken("a.h", LICENCE + "namespace ut" "ils {}\n"), ["name"])
        self.assertEqual(self.broken("server/base/string_utils.h", LICENCE), ["name"])
        self.assertEqual(self.broken("server/base/ByteView.h", LICENCE), ["name"])


class Build(unittest.TestCase):
    def test_a_source_in_no_list_is_dead(self):
        listed = {"server/base/CMakeLists.txt": "add(SOURCES a.cpp)", "server/base/a.cpp": ""}
        self.assertEqual(rules_broken(build_rules.check, listed), [])
        dead = dict(listed, **{"server/base/b.cpp": ""})
        self.assertEqual(rules_broken(build_rules.check, dead), [("server/base/b.cpp", "dead")])

    def test_a_name_in_a_comment_lists_nothing(self):
        files = {"server/base/CMakeLists.txt": "# a.cpp", "server/base/a.cpp": ""}
        self.assertEqual(rules_broken(build_rules.check, files), [("server/base/a.cpp", "dead")])

    def test_a_list_may_name_a_file_by_a_variable_with_a_stem(self):
        files = {"tests/fuzz/CMakeLists.txt": "add(${kind}_fuzzer ${kind}_fuzzer.cpp)",
                 "tests/fuzz/jpeg_fuzzer.cpp": ""}
        self.assertEqual(rules_broken(build_rules.check, files), [])
        files = {"tests/fuzz/CMakeLists.txt": "foreach(kind a b) add(${kind}.cpp)",
                 "tests/fuzz/b.cpp": ""}
        self.assertEqual(rules_broken(build_rules.check, files), [])
        files = {"tests/fuzz/CMakeLists.txt": "foreach(kind b c) add(${kind}.cpp)",
                 "tests/fuzz/a.cpp": ""}
        self.assertEqual(rules_broken(build_rules.check, files), [("tests/fuzz/a.cpp", "dead")])

    def test_the_page_lives_through_the_list_that_embeds_it(self):
        files = {"server/web/CMakeLists.txt": "set(page a.js)", "client/web/a.js": "",
                 "client/web/b.js": ""}
        self.assertEqual(rules_broken(build_rules.check, files), [("client/web/b.js", "dead")])

    def test_a_header_lives_through_an_include(self):
        files = {"tests/CMakeLists.txt": "add(unit/a_test.cpp)", "tests/support/scene.h": "",
                 "tests/unit/a_test.cpp": '#include "support/scene.h"\n'}
        self.assertEqual(rules_broken(build_rules.check, files), [])
        files["tests/unit/a_test.cpp"] = ""
        self.assertEqual(rules_broken(build_rules.check, files),
                         [("tests/support/scene.h", "dead")])

    def test_a_source_that_includes_its_own_header_late_is_found(self):
        files = {"server/CMakeLists.txt": "add(base/a.cpp)", "server/base/a.h": "",
                 "server/base/a.cpp": '#include "base/a.h"\n#include <vector>\n'}
        self.assertEqual(rules_broken(build_rules.check, files), [])
        files["server/base/a.cpp"] = '#include <vector>\n#include "base/a.h"\n'
        self.assertEqual(rules_broken(build_rules.check, files),
                         [("server/base/a.cpp", "own header")])

    def test_globs_are_found(self):
        self.assertEqual(rules_broken(build_rules.check, {"CMakeLists.txt": "file(GLOB x *.cpp)"}),
                         [("CMakeLists.txt", "glob")])

    def test_only_shown_pictures_may_be_binary(self):
        self.assertEqual(rules_broken(build_rules.check, {"a.png": b"\x89PNG\0"}),
                         [("a.png", "binary")])
        self.assertEqual(rules_broken(build_rules.check, {"a.png": b"\x89PNG\0",
                                                          "README.md": "![a](a.png)"}), [])

    def test_generated_files_are_found(self):
        self.assertEqual(rules_broken(build_rules.check, {"client/python/frame_pb2.py": ""}),
                         [("client/python/frame_pb2.py", "dead"),
                          ("client/python/frame_pb2.py", "generated")])


class Proto(unittest.TestCase):
    def broken(self, text, path="proto/viewloom/v1/a.proto"):
        return [rule for _, rule in rules_broken(proto_rules.check, {path: text})]

    def test_a_clean_proto_passes(self):
        self.assertEqual(self.broken(
            "package viewloom.v1;\nenum TileOrder {\n  TILE_ORDER_UNSPECIFIED = 0;\n"
            "  TILE_ORDER_TOP_LEFT = 1;\n}\nmessage A {\n  double near_m = 1;\n"
            "  double gain = 2;  // linear factor, 0..1\n}\n"), [])

    def test_a_package_that_is_not_its_folder_is_found(self):
        self.assertEqual(self.broken("package viewloom.v2;\n"), ["proto"])

    def test_an_enum_without_an_unspecified_zero_is_found(self):
        self.assertEqual(self.broken("package viewloom.v1;\nenum Kind {\n  KIND_A = 0;\n}\n"),
                         ["proto"])

    def test_an_enum_value_without_its_prefix_is_found(self):
        self.assertEqual(self.broken(
            "package viewloom.v1;\nenum Kind {\n  KIND_UNSPECIFIED = 0;\n  OTHER = 1;\n}\n"),
                         ["proto"])

    def test_services_and_messages_are_named_after_their_verb(self):
        self.assertEqual(self.broken(
            "package viewloom.v1;\nservice Catalog {\n"
            "  rpc List(ListRequest) returns (stream Entry);\n}\n"), ["proto", "proto"])

    def test_a_number_without_unit_or_comment_is_found(self):
        self.assertEqual(self.broken("package viewloom.v1;\nmessage A {\n  float far = 1;\n}\n"),
                         ["proto unit"])


if __name__ == "__main__":
    unittest.main()
