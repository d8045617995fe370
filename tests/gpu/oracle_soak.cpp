// SPDX-License-Identifier: Apache-2.0
// viewloom-oracle-soak [first seed [count]]: random scenes and views by the thousand against the
// oracle. Prints every seed that differs; exit code 1 when one did.
#include <charconv>
#include <cstdio>
#include <cstring>

#include "gpu/judge_seed.h"

namespace viewloom {
namespace {

constexpr uint64_t kProgressEvery = 100;

uint64_t numberOr(const char* text, uint64_t otherwise) {
  uint64_t number = otherwise;
  if (text) std::from_chars(text, text + std::strlen(text), number);
  return number;
}

bool agrees(WalkUnderTest& walk, uint64_t seed, JudgedViews& sum) {
  const JudgedSeed judged = judgeSeed(walk, seed);
  sum.add(judged.judged);
  if (!judged.agrees()) std::printf("%s\n", judged.text().c_str());
  return judged.agrees();
}

int soak(uint64_t first, uint64_t count) {
  const Device device(DeviceOptions{});
  WalkUnderTest walk(device);
  JudgedViews sum;
  uint64_t failed_count = 0;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    failed_count += !agrees(walk, seed, sum);
    if ((seed + 1 - first) % kProgressEvery == 0) {
      std::printf("%llu seeds, %llu failed\n", static_cast<unsigned long long>(seed + 1 - first),
                  static_cast<unsigned long long>(failed_count));
      std::fflush(stdout);
    }
  }
  std::printf("%s\n", sum.summary().c_str());
  return failed_count == 0 ? 0 : 1;
}

}  // namespace
}  // namespace viewloom

int main(int argument_count, char** arguments) {
  return viewloom::soak(viewloom::numberOr(argument_count > 1 ? arguments[1] : nullptr, 0),
                        viewloom::numberOr(argument_count > 2 ? arguments[2] : nullptr, 10000));
}
