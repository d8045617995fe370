// SPDX-License-Identifier: Apache-2.0
// Layers, channels and views of EXR files whose names are mistyped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test::exr_names_test {
namespace {

using files::TestFolder;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

WrittenChannel constant(const std::string& name, float value, Imf::PixelType type = Imf::HALF) {
  return {name, type, [value](int, int) { return value; }};
}

TEST(ExrNames, areSuggestedByTheNearestLayersAndChannels) {
  const TestFolder folder;
  const std::string path = folder.path() / "render.exr";
  writeExr(path, 4, 4,
           {constant("beauty.R", 0.25F), constant("beauty.G", 0.25F), constant("beauty.B", 0.25F),
            constant("distance.V", 2, Imf::FLOAT)});
  const auto refused = [&](const std::string& color, const std::string& depth) {
    return refusalOf({.color_channels = color, .depth_channel = depth}, {.color = path});
  };
  EXPECT_THAT(refused("beuaty", ""), EndsWith("; did you mean \"beauty\"?"));
  EXPECT_THAT(refused("beauty.R,beauty.G,beaty.B", ""), HasSubstr("; did you mean \"beauty.B\""));
  EXPECT_THAT(refused("", "distanse.V"), EndsWith("; did you mean \"distance.V\"?"));
  EXPECT_THAT(refused("", "distnace"), EndsWith("; did you mean \"distance\"?"));
  EXPECT_THAT(refused("", "albedo"), Not(HasSubstr("did you mean")));
}

}  // namespace
}  // namespace viewloom::test::exr_names_test
