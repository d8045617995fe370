// SPDX-License-Identifier: Apache-2.0
// EXR files of Nuke, whose depth.Z is 1/Z or Z: the header does not tell.
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "inputs/exr_tool.h"
#include "inputs/nuke_depth.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test::nuke_inputs_test {
namespace {

using files::TestFolder;
using inputs::InputKind;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr int kWidth = 16, kHeight = 8;

WrittenChannel constant(const std::string& name, float value) {
  return {name, Imf::HALF, [value](int, int) { return value; }};
}

// 2 m on the left, 4 m on the right.
float depthOf(int x, int) {
  return x < kWidth / 2 ? 2.0F : 4.0F;
}

class NukeInputs : public ::testing::Test {
 protected:
  std::string write(const std::vector<WrittenChannel>& channels,
                    const std::function<void(Imf::Header&)>& edit) {
    const std::string path = folder_.path() / ("file" + std::to_string(count_++) + ".exr");
    writeExr(path, kWidth, kHeight, channels, edit);
    return path;
  }

 private:
  TestFolder folder_;
  int count_ = 0;
};

void nukeWrote(Imf::Header& header) {
  header.insert("nuke/version", Imf::StringAttribute("13.2v5"));
}

std::vector<WrittenChannel> withDepth(const std::string& channel,
                                      const std::function<float(int, int)>& depth) {
  return {constant("R", 1), constant("G", 1), constant("B", 1), {channel, Imf::FLOAT, depth}};
}

float farDepthOf(int x, int y) {
  return 10 * depthOf(x, y);
}

float inverseOf(float z) {
  return 1 / z;
}

TEST_F(NukeInputs, readDepthThatNukeMadeAsInverse) {
  const std::string path = write(
      withDepth("depth.Z", [](int x, int y) { return y == 0 ? 0 : inverseOf(farDepthOf(x, y)); }),
      nukeWrote);
  const auto read = readInput({}, {.color = path});
  EXPECT_EQ(read.how.kind, InputKind::kNuke);
  EXPECT_NEAR(depthAt(read, 12, 3), 40, 1e-3);
  EXPECT_TRUE(std::isinf(depthAt(read, 12, 0)));
  EXPECT_THAT(read.how.notes, Contains(AllOf(HasSubstr("read as inverse depth (1/Z), because"),
                                             HasSubstr("--input plain"))));
  EXPECT_NEAR(depthAt(readInput({.kind = InputKind::kPlain}, {.color = path}), 12, 3), 0.025, 1e-6);
}

TEST_F(NukeInputs, readDepthThatNukePassedOnAsDistance) {
  const std::string far = write(withDepth("depth.Z", farDepthOf), nukeWrote);
  const auto read = readInput({}, {.color = far});
  EXPECT_EQ(read.how.kind, InputKind::kPlain);
  EXPECT_NEAR(depthAt(read, 12, 3), 40, 1e-3);
  EXPECT_THAT(read.how.notes, Contains(AllOf(HasSubstr("read as distance (Z), because"),
                                             HasSubstr("--input nuke"))));
  for (const float nothing : {1e10F, 1e30F, std::numeric_limits<float>::infinity()}) {
    const std::string path =
        write(withDepth("depth.Z", [&](int x, int y) { return y == 0 ? nothing : depthOf(x, y); }),
              nukeWrote);
    const auto near = readInput({}, {.color = path});
    EXPECT_NEAR(depthAt(near, 12, 3), 4, 1e-5) << nothing;
    EXPECT_TRUE(std::isinf(depthAt(near, 12, 0))) << nothing;
  }
  const std::string negative =
      write(withDepth("depth.Z", [](int x, int y) { return -depthOf(x, y); }), nukeWrote);
  EXPECT_NEAR(depthAt(readInput({}, {.color = negative}), 12, 3), 4, 1e-5);
  // Other layers pass through Nuke as they came.
  const std::string other = write(withDepth("Z", depthOf), nukeWrote);
  EXPECT_NEAR(depthAt(readInput({}, {.color = other}), 12, 3), 4, 1e-5);
}

TEST_F(NukeInputs, refuseDepthOfNukeThatMayBeEither) {
  const std::string distance = write(withDepth("depth.Z", depthOf), nukeWrote);
  const std::string inverse =
      write(withDepth("depth.Z", [](int x, int y) { return inverseOf(depthOf(x, y)); }), nukeWrote);
  for (const std::string& path : {distance, inverse}) {
    EXPECT_THAT(refusalOf({}, {.color = path}),
                AllOf(HasSubstr("depth.Z from "), HasSubstr("--input nuke (1/Z)"),
                      HasSubstr("--input plain (Z)")));
  }
  EXPECT_NEAR(depthAt(readInput({.kind = InputKind::kNuke}, {.color = inverse}), 12, 3), 4, 1e-5);
  EXPECT_NEAR(depthAt(readInput({.kind = InputKind::kPlain}, {.color = distance}), 12, 3), 4, 1e-5);
  EXPECT_NEAR(
      depthAt(readInput({.depth_meaning = v1::DEPTH_MEANING_PLANAR}, {.color = distance}), 12, 3),
      4, 1e-5);
}

TEST_F(NukeInputs, readAllFramesOfNukeAlike) {
  const auto frame = [this](const std::function<float(int, int)>& depth) {
    return inputs::InputFiles{.color = write(withDepth("depth.Z", depth), nukeWrote)};
  };
  inputs::InputReader reader{{}};
  const auto nothing = reader.read(frame([](int, int) { return 0.0F; }));
  ASSERT_TRUE(nothing.ok()) << nothing.status();
  const auto first = reader.read(frame([](int x, int y) { return inverseOf(farDepthOf(x, y)); }));
  ASSERT_TRUE(first.ok()) << first.status();
  const auto nearer = reader.read(frame([](int x, int y) { return inverseOf(depthOf(x, y)); }));
  ASSERT_TRUE(nearer.ok()) << nearer.status();
  EXPECT_NEAR(depthAt(*nearer, 12, 3), 4, 1e-5);
  const auto other = reader.read(frame(farDepthOf));
  EXPECT_THAT(std::string(other.status().message()),
              AllOf(HasSubstr("as Z here"), HasSubstr("as 1/Z in the frames before")));
}

TEST(NukeDepth, isToldByWhereSamplesLie) {
  using inputs::judgeNukeDepth;
  using inputs::NukeDepth;
  constexpr float kFarAway = std::numeric_limits<float>::infinity();
  EXPECT_EQ(judgeNukeDepth({0.02F, 0.05F, 0.5F, 0}).depth, NukeDepth::kInverse);
  EXPECT_EQ(judgeNukeDepth({2, 3, 40, 50}).depth, NukeDepth::kDistance);
  EXPECT_EQ(judgeNukeDepth({2, 3, kFarAway}).depth, NukeDepth::kDistance);
  EXPECT_EQ(judgeNukeDepth({-2, -3, 0}).depth, NukeDepth::kDistance);
  EXPECT_FALSE(judgeNukeDepth({0.2F, 0.5F, 3}).depth);
  EXPECT_FALSE(judgeNukeDepth({0.02F, 0.05F, 0.06F, 50, 60}).depth) << "near and far at once";
  EXPECT_FALSE(judgeNukeDepth({0, 0}).depth);
}

TEST(NukeDepth, isInTheLayerDepth) {
  for (const char* channel : {"depth.Z", "Depth.z", "left.depth.Z", "depth.left.Z"}) {
    EXPECT_TRUE(inputs::isDepthOfNuke(channel)) << channel;
  }
  for (const char* channel : {"Z", "Z.Z", "mydepth.Z", "depth.R", "zdepth.Z"}) {
    EXPECT_FALSE(inputs::isDepthOfNuke(channel)) << channel;
  }
}

}  // namespace
}  // namespace viewloom::test::nuke_inputs_test
