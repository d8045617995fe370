// SPDX-License-Identifier: Apache-2.0
// viewloom-oracle-soak [sweep] [first seed [count]]: random scenes and views by the thousand
// against the oracle, walked or swept. Prints every seed that differs; exit code 1 when one did.
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

// Judges a seed by itself; says what differs.
template <typename Judge>
int soak(uint64_t first, uint64_t count, const Judge& judge) {
  JudgedViews sum;
  uint64_t failed_count = 0;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    const JudgedSeed judged = judge(seed);
    sum.add(judged.judged);
    failed_count += !judged.agrees();
    if (!judged.agrees()) std::printf("%s\n", judged.text().c_str());
    if ((seed + 1 - first) % kProgressEvery == 0) {
      std::printf("%llu seeds, %llu failed\n", static_cast<unsigned long long>(seed + 1 - first),
                  static_cast<unsigned long long>(failed_count));
      std::fflush(stdout);
    }
  }
  std::printf("%s\n", sum.summary().c_str());
  return failed_count == 0 ? 0 : 1;
}

int soakWalk(uint64_t first, uint64_t count) {
  const Device device(DeviceOptions{});
  WalkUnderTest walk(device);
  return soak(first, count, [&](uint64_t seed) { return judgeSeed(walk, seed); });
}

int soakSweep(uint64_t first, uint64_t count) {
  SweepUnderTest sweep;
  return soak(first, count, [&](uint64_t seed) { return judgeSweptSeed(sweep, seed); });
}

}  // namespace
}  // namespace viewloom

int main(int argument_count, char** arguments) {
  const bool is_swept = argument_count > 1 && std::strcmp(arguments[1], "sweep") == 0;
  const int at = is_swept ? 2 : 1;
  const uint64_t first = viewloom::numberOr(argument_count > at ? arguments[at] : nullptr, 0);
  const uint64_t count =
      viewloom::numberOr(argument_count > at + 1 ? arguments[at + 1] : nullptr, 10000);
  return is_swept ? viewloom::soakSweep(first, count) : viewloom::soakWalk(first, count);
}
