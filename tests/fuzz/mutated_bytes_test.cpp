// SPDX-License-Identifier: Apache-2.0
// A short, repeatable walk through what the fuzzers search at length: good bytes, spoilt a little.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "fuzz/fuzz_target.h"

namespace viewloom::mutated_bytes_test {
namespace {

using Bytes = std::vector<uint8_t>;
constexpr int kRounds = 2000;

// Flips, replaces, removes or repeats a few bytes.
Bytes mutated(Bytes bytes, std::mt19937& random) {
  for (uint32_t edits = 1 + random() % 4; edits > 0 && !bytes.empty(); --edits) {
    const auto at = bytes.begin() + static_cast<long>(random() % bytes.size());
    switch (random() % 5) {
      case 0:
        *at = static_cast<uint8_t>(*at ^ 1U << random() % 8);
        break;
      case 1:
        *at = static_cast<uint8_t>(random());
        break;
      case 2:
        bytes.erase(at);
        break;
      case 3:
        bytes.insert(at, *at);
        break;
      case 4:
        if (random() % 8 == 0) bytes.erase(at, bytes.end());
        break;
    }
  }
  return bytes;
}

class MutatedBytes : public testing::TestWithParam<FuzzTarget> {};

// Seeds are accepted as they are; spoilt they are accepted or refused. A broken promise aborts.
TEST_P(MutatedBytes, keepEveryPromise) {
  const FuzzTarget& target = GetParam();
  const SeedBytes seeds = target.seeds();
  for (size_t i = 0; i < seeds.size(); ++i) EXPECT_TRUE(target.reads(seeds[i])) << "seed " << i;
  std::mt19937 random(7);
  int accepted_count = 0;
  for (int round = 0; round < kRounds; ++round) {
    accepted_count += target.reads(mutated(seeds[random() % seeds.size()], random));
  }
  EXPECT_GT(accepted_count, 0);
  EXPECT_LT(accepted_count, kRounds);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, MutatedBytes, testing::ValuesIn(fuzzTargets()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace viewloom::mutated_bytes_test
