// SPDX-License-Identifier: Apache-2.0
// A colour picture and a depth picture of few px in a folder of their own.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test {

using inputs::InputKind;
using inputs::InputSettings;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

class WrittenPairTest : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  void writeColor() const { writePng(file("color.png"), 4, 2, 3, 8, std::vector<uint16_t>(24, 9)); }
  void writeGrey(uint32_t bits, const std::vector<uint16_t>& codes) const {
    writePng(file("depth.png"), static_cast<uint32_t>(codes.size()), 1, 1, bits, codes);
  }
  inputs::ReadInput readPair(const InputSettings& settings) const {
    return readInput(settings, {.color = file("color.png"), .depth = file("depth.png")});
  }

  const files::TestFolder folder_;
};

}  // namespace viewloom::test
