// SPDX-License-Identifier: Apache-2.0
// All fuzzers in one program: NAME_fuzzer, a link to it, searches the target NAME.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <google/protobuf/stubs/logging.h>

#include "fuzz/fuzz_target.h"

namespace {

const viewloom::FuzzTarget* target = nullptr;

}  // namespace

// libFuzzer calls these by their names.
extern "C" int LLVMFuzzerInitialize(int*, char*** argv) {
  const std::string program = **argv;
  const std::string file = program.substr(program.rfind('/') + 1);
  target = viewloom::findFuzzTarget(file.substr(0, file.find("_fuzzer")));
  google::protobuf::SetLogHandler(nullptr);  // it would write of each message that is none
  if (target != nullptr) return 0;
  std::fprintf(stderr, "fuzzer: call it as NAME_fuzzer, by one of its links\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t count) {
  target->reads({bytes, count});
  return 0;
}
