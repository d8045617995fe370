// SPDX-License-Identifier: Apache-2.0
// A device with memory of its own, into which planes are copied and bands out of it, answers as one
// whose memory is the CPU's.
#include "gpu/walk_under_test.h"
#include "support/test_device.h"

namespace viewloom::own_memory_test {
namespace {

constexpr double kTolerance_px = 0.05;
constexpr int kWidth = 37;
constexpr int kHeight = 29;
constexpr int kLayerCount = 3;

// Every sample of every layer has another colour, opaque.
Frame colored(const oracle::Scene& scene, oracle::Random& random) {
  Frame frame = *frameOf(scene);
  for (LayerPlanes& planes : frame.sources[0]) {
    auto bytes = std::make_shared<std::vector<uint8_t>>();
    for (int i = 0; i < kWidth * kHeight; ++i) {
      for (int channel = 0; channel < 3; ++channel) {
        bytes->push_back(uint8_t(random.integer(0, 255)));
      }
      bytes->push_back(255);
    }
    planes.color = bytes;
  }
  return frame;
}

class OwnMemoryTest : public GpuTest {};

TEST_F(OwnMemoryTest, answersAsSharedMemoryDoes) {
  const Device own_memory({.validation = true, .has_own_memory = true});
  ASSERT_FALSE(own_memory.info().shares_memory);
  WalkUnderTest walk(device());
  WalkUnderTest copying_walk(own_memory);
  oracle::Random random(7);
  const oracle::Scene scene = oracle::randomScene(21, kWidth, kHeight, kLayerCount);
  const Frame frame = colored(scene, random);
  const auto views = oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
  const auto slot = walk.build(frame);
  const auto copied_slot = copying_walk.build(frame);
  EXPECT_FALSE(copied_slot->colorIsInPlace());
  const auto expected = walk.trace(*slot, views, kTolerance_px);
  const auto copied = copying_walk.trace(*copied_slot, views, kTolerance_px);
  ASSERT_EQ(copied.size(), expected.size());
  for (size_t view = 0; view < views.size(); ++view) {
    EXPECT_EQ(copied[view].srgb, expected[view].srgb) << views[view].name;
  }
  EXPECT_EQ(own_memory.validationLog().messageCount(), 0u);
}

}  // namespace
}  // namespace viewloom::own_memory_test
