// SPDX-License-Identifier: Apache-2.0
// A lens beside many exact rays, in small.
#include "bench/quality_lens.h"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "gpu/test_device.h"

namespace viewloom::bench {
namespace {

class QualityOfLens : public GpuTest, public ::testing::WithParamInterface<GatheringPlace> {
 protected:
  std::vector<LensScore> scoresOf(const std::vector<LensWay>& ways, double aside_m) {
    const LensScoring scoring{.source_width_px = 480,
                              .view_width_px = 160,
                              .true_ray_count = 256,
                              .round_count = 0,
                              .aside_m = aside_m,
                              .place = GetParam()};
    std::vector<LensScore> scores = lensScores(device(), scoring, ways);
    for (const LensScore& score : scores) {
      std::cout << score.way.layer_count << " layers, " << score.way.walked_count << " + "
                << score.way.gathered_count << ": " << score.psnr_db << " dB, mean error "
                << score.mean_error << ", seams " << score.seams << "\n";
    }
    return scores;
  }
};

// dB: what as many rays as are walked and gathered lose that are not all walked.
constexpr double kGatheredLoss_db = 0.3;

TEST_P(QualityOfLens, growsWithTheRaysAndByTheSecondStage) {
  const auto scores =
      scoresOf({{.layer_count = 2, .walked_count = 2},
                {.layer_count = 2, .walked_count = 8},
                {.layer_count = 2, .walked_count = 8, .gathered_count = 32},
                {.layer_count = 2, .walked_count = 40},
                {.layer_count = 2, .walked_count = 8, .gathered_count = 32, .is_exact = true}},
               0);
  EXPECT_GT(scores[1].psnr_db, scores[0].psnr_db + 3);
  EXPECT_GT(scores[2].psnr_db, scores[1].psnr_db + 4);
  EXPECT_GT(scores[2].psnr_db, scores[3].psnr_db - kGatheredLoss_db);
  EXPECT_GT(scores[4].psnr_db, scores[1].psnr_db + 4);
  EXPECT_LT(std::abs(scores[2].mean_error), 1e-3);
}

// What a block was found to be must not be seen in the picture, from beside the source neither.
TEST_P(QualityOfLens, hasNoSeamsBetweenBlocks) {
  const auto scores = scoresOf({{.layer_count = 2, .walked_count = 8},
                                {.layer_count = 2, .walked_count = 8, .gathered_count = 32}},
                               0.15);
  EXPECT_GT(scores[1].psnr_db, scores[0].psnr_db + 1.8);
  EXPECT_LT(scores[1].seams, scores[0].seams + 0.1);
}

INSTANTIATE_TEST_SUITE_P(Places, QualityOfLens,
                         ::testing::Values(GatheringPlace::kHost, GatheringPlace::kDevice),
                         [](const auto& place) {
                           return place.param == GatheringPlace::kHost ? "host" : "device";
                         });

}  // namespace
}  // namespace viewloom::bench
