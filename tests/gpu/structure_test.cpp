// SPDX-License-Identifier: Apache-2.0
// The structure on the device against the oracle and against its own lower levels.
#include <algorithm>
#include <memory>

#include "gpu/structure_checks.h"
#include "gpu/walk_under_test.h"
#include "offline/effective_nodes.h"
#include "support/test_device.h"

namespace viewloom::structure_test {
namespace {

// Compares the parts that walks read.
bool isSame(const StructureImage& a, const StructureImage& b) {
  const auto isSameGrid = [](const NodeGrid& grid, const NodeGrid& other) {
    return grid.nodes == other.nodes;
  };
  return std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(),
                    [&](const LayerImage& layer, const LayerImage& other) {
                      return isSameGrid(layer.facets, other.facets) && layer.links == other.links &&
                             isSameGrid(layer.entries, other.entries) &&
                             std::equal(layer.levels.begin(), layer.levels.end(),
                                        other.levels.begin(), other.levels.end(), isSameGrid);
                    });
}

class StructureTest : public GpuTest {
 protected:
  Complaints check(const oracle::Scene& scene) {
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
    const StructureImage image = walk_.readBack(*slot);
    return checkStructure(image, sourceOf(scene, *slot));
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
};

TEST_F(StructureTest, isTheOraclesOnEveryKindAndSizeOfScene) {
  // All sizes of the generator with all layer counts, twice.
  for (uint64_t seed = 0; seed < 112; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed);
    const Complaints complaints = check(scene);
    EXPECT_TRUE(complaints.empty()) << "seed " << seed << " " << scene.name << scene.planes.width
                                    << "x" << scene.planes.height << "\n"
                                    << complaints.text();
  }
}

TEST_F(StructureTest, isTheOraclesWhereDepthIsCoarse) {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const oracle::Scene scene = oracle::coarseScene(seed, 201, 101, 1 + int(seed / 2));
    const SourceStats stats = walk_.build(*frameOf(scene))->stats();
    EXPECT_GT(stats.smoothing_reach, 0) << scene.name;
    const Complaints complaints = check(scene);
    EXPECT_TRUE(complaints.empty()) << "seed " << seed << " " << scene.name << "\n"
                                    << complaints.text();
  }
}

TEST_F(StructureTest, leavesFineDepthAsItIs) {
  const oracle::Scene scene = oracle::smoothScene(201, 101, 2);
  EXPECT_EQ(walk_.build(*frameOf(scene))->stats().smoothing_reach, 0);
}

// Two things, one behind the other, each without any slope: as few steps as coarse depth has.
TEST_F(StructureTest, leavesFlatThingsAsTheyAre) {
  for (const float behind : {0.5f, 0.95f}) {
    oracle::Scene scene = oracle::smoothScene(201, 101, 1);
    for (int row = 0; row < 101; ++row) {
      for (int column = 0; column < 201; ++column) {
        scene.planes.at(0, column, row) = column / 20 % 2 == 0 ? 1.0f : behind;
      }
    }
    EXPECT_EQ(walk_.build(*frameOf(scene))->stats().smoothing_reach, 0) << behind;
  }
}

TEST_F(StructureTest, isTheOraclesOverSeveralRoots) {
  for (uint64_t seed = 1000; seed < 1004; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed, 333, 201, 2);
    const Complaints complaints = check(scene);
    EXPECT_TRUE(complaints.empty()) << "seed " << seed << " " << scene.name << "\n"
                                    << complaints.text();
  }
}

// One column and one row of the last blocks lie in the image.
TEST_F(StructureTest, isTheSameWhateverItsMemoryHeld) {
  constexpr uint32_t kNan = 0xffffffff;
  for (const SizePx& size_px : {SizePx{1, 1}, SizePx{5, 1}, SizePx{1, 5}, SizePx{65, 69}}) {
    const oracle::Scene scene =
        oracle::smoothScene(int(size_px.width), int(size_px.height), abi::kLayerCountMax);
    const FramePtr frame = frameOf(scene);
    const StructureImage image = walk_.readBack(*walk_.build(*frame, 0));
    const StructureImage other = walk_.readBack(*walk_.build(*frame, kNan));
    EXPECT_TRUE(isSame(image, other)) << size_px.width << "x" << size_px.height;
  }
}

// The slots of a stream share memory in the same way.
TEST_F(StructureTest, staysWhenAnotherIsBuiltInTheSameMemory) {
  const FramePtr frame = frameOf(oracle::randomScene(1000, 97, 65, 2));
  const FramePtr other_frame = frameOf(oracle::randomScene(1001, 97, 65, 2));
  const auto memory = std::make_shared<BuildMemory>(device(), shapeOf(*frame));
  const std::unique_ptr<StructureSlot> first = walk_.buildIn(memory, *frame);
  const std::unique_ptr<StructureSlot> second = walk_.buildIn(memory, *other_frame);
  EXPECT_TRUE(isSame(walk_.readBack(*first), walk_.readBack(*walk_.build(*frame))));
  EXPECT_TRUE(isSame(walk_.readBack(*second), walk_.readBack(*walk_.build(*other_frame))));
}

TEST_F(StructureTest, aSmoothSceneTakesFewNodes) {
  const oracle::Scene scene = oracle::smoothScene(640, 480, 1);
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
  const StructureImage image = walk_.readBack(*slot);
  const double nodes_per_pixel = effectiveNodesPerPixel(image);
  RecordProperty("nodes_per_pixel", std::to_string(nodes_per_pixel));
  EXPECT_LE(nodes_per_pixel, 0.03);
}

TEST_F(StructureTest, theBenchCountsItsNodesAsReadHere) {
  // Neither side a multiple of 4 px.
  const oracle::Scene scene = oracle::randomScene(7, 333, 201, 1);
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
  const StructureImage image = walk_.readBack(*slot);
  const std::vector<abi::uvec2> cells = walk_.cells(*slot, 0);
  EXPECT_DOUBLE_EQ(double(effectiveNodeCount(cells, slot->layout())) / (333 * 201),
                   effectiveNodesPerPixel(image));
}

}  // namespace
}  // namespace viewloom::structure_test
