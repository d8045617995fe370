// SPDX-License-Identifier: Apache-2.0
// All readers of foreign bytes, as functions of any bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace viewloom {

using SeedBytes = std::vector<std::vector<uint8_t>>;

struct FuzzTarget {
  std::string_view name;
  // Reads the bytes. True if they were accepted; aborts when a promise is broken.
  bool (*reads)(std::span<const uint8_t> bytes);
  // Good bytes, from which a search starts.
  SeedBytes (*seeds)();
};

// Sorted by name.
std::span<const FuzzTarget> fuzzTargets();
// nullptr = there is no such target.
const FuzzTarget* findFuzzTarget(std::string_view name);

}  // namespace viewloom
