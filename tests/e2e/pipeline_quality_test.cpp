// SPDX-License-Identifier: Apache-2.0
// Displays of one stream that ask for different quality.
#include <cstdlib>

#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"
#include "support/eyes/head_truth.h"
#include "support/truth/scenes.h"

namespace viewloom::test {
namespace {

using testing::SizeIs;

constexpr SizePx kSource_px{320, 240};
constexpr double kFocal_px = 280;
constexpr SizePx kView_px{240, 180};
constexpr double kExactTolerance_px = 0.01;
// A column of a Portrait's eyes, turned a little: such views are walked.
const Pose kEye{.position_m = {0.15, 0.02, 0},
                .orientation = glm::angleAxis(0.03, glm::dvec3(0, 1, 0))};

DisplaySpec viewOf(Quality quality, double tolerance_px = 0) {
  const Intrinsics lens = intrinsicsFromFov(fovOf(kSource_px, kFocal_px), kView_px);
  return *completeDisplaySpec(
      {.kind = CamerasSpec{.cameras = {{kEye, lens}}, .tile_size_px = kView_px, .columns = 1},
       .tolerance_px = tolerance_px,
       .quality = quality});
}

class PipelineQualityTest : public PipelineFixture {
 protected:
  static std::vector<uint8_t> colorOf(const Viewer& viewer) {
    const std::vector<AtlasPtr> atlases = viewer.subscriber->waitForAtlases(1);
    std::vector<uint8_t> color;
    for (const EncodedBand& band : atlases.at(0)->bands) {
      color.insert(color.end(), band.bytes->begin(), band.bytes->end());
    }
    return color;
  }

  static size_t differingCount(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.size(); ++i) count += std::abs(int(a[i]) - int(b.at(i))) > 1;
    return count;
  }
};

TEST_F(PipelineQualityTest, givesEachDisplayItsOwn) {
  Server server(device());
  const EncodingSpec raw{.color = BandEncoding::kRaw};
  const Viewer draft = watch(server, viewOf(Quality::kDraft), raw);
  const Viewer best = watch(server, viewOf(Quality::kBest), raw);
  const Viewer exact = watch(server, viewOf(Quality::kBest, kExactTolerance_px), raw);
  server.offer(HeadTruth(truth::clutteredRoom(), kSource_px, kFocal_px, 2).frame());
  const std::vector<uint8_t> truth = colorOf(exact);
  ASSERT_THAT(truth, SizeIs(3 * kView_px.area()));
  const size_t of_draft = differingCount(colorOf(draft), truth);
  const size_t of_best = differingCount(colorOf(best), truth);
  EXPECT_LT(2 * of_best, of_draft);
  EXPECT_LT(of_best, truth.size() / 50);
  server.pipeline.drain();
  EXPECT_EQ(server.metrics.structures_built.value(), 1);
  EXPECT_EQ(tracedCount(server.metrics), 3);
}

}  // namespace
}  // namespace viewloom::test
