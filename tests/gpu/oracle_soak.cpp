// SPDX-License-Identifier: Apache-2.0
// viewloom-oracle-soak [sweep|cube|sources|beside] [first seed [count]]: random scenes and views by
// the thousand against the oracle, walked or swept, walked as cube maps, as several sources, or as
// a cube map beside other sources. Prints every seed that differs; exit code 1 when one did.
#include <cctype>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string>

#include "gpu/cube_beside_sources.h"
#include "gpu/cube_under_test.h"
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

int soakCube(uint64_t first, uint64_t count) {
  const Device device(DeviceOptions{});
  SourcesUnderTest tracer(device);
  return soak(first, count, [&](uint64_t seed) {
    const JudgedCube judged = judgeCube(tracer, seed);
    return JudgedSeed{"cube map", judged.complaints, {.verdict = judged.verdict}};
  });
}

template <typename Judge>
int soakSources(const char* name, uint64_t first, uint64_t count, const Judge& judge) {
  const Device device(DeviceOptions{});
  SourcesUnderTest tracer(device);
  return soak(first, count, [&](uint64_t seed) {
    return JudgedSeed{name, {}, {.verdict = judge(tracer, seed)}};
  });
}

// Soaks in the mode that main() is given.
int soakAs(const std::string& mode, uint64_t first, uint64_t count) {
  if (mode == "sweep") return soakSweep(first, count);
  if (mode == "cube") return soakCube(first, count);
  if (mode == "sources") return soakSources("sources", first, count, judgeSources);
  if (mode == "beside") return soakSources("beside", first, count, judgeCubeBesideSources);
  return soakWalk(first, count);
}

}  // namespace
}  // namespace viewloom

int main(int argument_count, char** arguments) {
  const std::string first_argument = argument_count > 1 ? arguments[1] : "";
  const bool has_mode = !first_argument.empty() && std::isalpha(first_argument.front()) != 0;
  const int at = has_mode ? 2 : 1;
  const uint64_t first = viewloom::numberOr(argument_count > at ? arguments[at] : nullptr, 0);
  const uint64_t count =
      viewloom::numberOr(argument_count > at + 1 ? arguments[at + 1] : nullptr, 10000);
  return viewloom::soakAs(first_argument, first, count);
}
