// SPDX-License-Identifier: Apache-2.0
// Arrays that are larger than bindings: what is then written, or also read, by address is the same.
#include "gpu/judge_views.h"
#include "gpu/structure_checks.h"
#include "support/test_device.h"

namespace viewloom::small_bindings_test {
namespace {

// Less than any array of the scenes below takes.
constexpr uint64_t kFewBytes = 1024;
constexpr uint64_t kFewTexels = 256;
constexpr double kTolerance_px = 0.05;

class SmallBindingsTest : public DeviceNeededTest {
 protected:
  static void checkOn(const Device& device, bool reads_by_address) {
    WalkUnderTest walk(device);
    oracle::Random random(5);
    for (int layer_count = 1; layer_count <= int(abi::kLayerCountMax); ++layer_count) {
      const oracle::Scene scene = oracle::randomScene(uint64_t(layer_count), 37, 29, layer_count);
      const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(scene));
      EXPECT_TRUE(slot->writesByAddress());
      EXPECT_EQ(slot->readsByAddress(), reads_by_address);
      const oracle::OracleSource source = sourceOf(scene, *slot);
      const StructureImage image = walk.readBack(*slot);
      const Complaints complaints = checkStructure(image, source);
      EXPECT_TRUE(complaints.empty()) << scene.name << "\n" << complaints.text();
      const auto views = oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
      const JudgedViews judged = judgeViews(walk, *slot, source, views, kTolerance_px, scene.name);
      EXPECT_EQ(judged.verdict.differing, 0u) << judged.summary();
    }
    EXPECT_EQ(device.validationLog().messageCount(), 0u);
  }
};

TEST_F(SmallBindingsTest, storageIsWrittenByAddress) {
  checkOn(Device({.validation = true, .storage_bytes_max = kFewBytes}), false);
}

TEST_F(SmallBindingsTest, texelsAreReadByAddress) {
  checkOn(
      Device({.validation = true, .storage_bytes_max = kFewBytes, .texel_count_max = kFewTexels}),
      true);
}

}  // namespace
}  // namespace viewloom::small_bindings_test
