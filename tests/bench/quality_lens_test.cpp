// SPDX-License-Identifier: Apache-2.0
// A lens beside many exact rays, in small.
#include "bench/quality_lens.h"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "gpu/gathering_places.h"
#include "support/test_device.h"

namespace viewloom::bench::quality_lens_test {
namespace {

class QualityOfLens : public GatheringTest, public ::testing::WithParamInterface<GatheringPlace> {
 protected:
  std::vector<LensScore> scoresOf(const std::vector<LensWay>& ways, double aside_m,
                                  uint32_t true_ray_count = 256) {
    const LensScoring scoring{.source_width_px = 480,
                              .view_width_px = 160,
                              .true_ray_count = true_ray_count,
                              .round_count = 0,
                              .aside_m = aside_m};
    std::vector<LensScore> scores = lensScores(rendererAt(GetParam()), scoring, ways);
    for (const LensScore& score : scores) {
      std::cout << score.way.layer_count << " layers, " << score.way.walked_count << " + "
                << score.way.gathered_count << ": " << score.psnr_db << " dB, "
                << score.hidden_psnr_db << " dB in the " << score.hidden_px_share
                << " hidden ones, mean error " << score.mean_error << ", level " << score.level_db
                << " dB, seams " << score.seams << "\n";
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

// The kind of a block must not show in the picture, from beside the source either.
TEST_P(QualityOfLens, hasNoSeamsBetweenBlocks) {
  const auto scores = scoresOf({{.layer_count = 2, .walked_count = 8},
                                {.layer_count = 2, .walked_count = 8, .gathered_count = 32}},
                               0.15);
  EXPECT_GT(scores[1].psnr_db, scores[0].psnr_db + 1.8);
  EXPECT_LT(scores[1].seams, scores[0].seams + 0.1);
}

// dB that twice as many rays of both stages bring, at the least: half as much noise would be 3, and
// what is missed of the scene less.
constexpr double kGainOfRays_db = 0.6;
// dB that all of the light may be off by: 1 % of it.
constexpr double kLevelOff_db = 0.05;

TEST_P(QualityOfLens, comesNearerToTheTruthTheMoreRaysFindWhatThereIs) {
  constexpr uint32_t kTrueRays = 1024;
  std::vector<LensWay> ways;
  for (const uint32_t walked : {2, 4, 8, 16}) {
    ways.push_back({.layer_count = 2, .walked_count = walked, .gathered_count = 4 * walked});
  }
  // The same number of gathered rays: a single walked one finds less, so these lose.
  ways.push_back({.layer_count = 2, .walked_count = 1, .gathered_count = 128});
  ways.push_back({.layer_count = 2, .walked_count = 8, .gathered_count = 128});
  const auto scores = scoresOf(ways, 0, kTrueRays);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_LT(std::abs(scores[i].level_db), kLevelOff_db) << ways[i].walked_count;
  }
  for (size_t i = 1; i < 4; ++i) {
    EXPECT_GT(scores[i].psnr_db, scores[i - 1].psnr_db + kGainOfRays_db) << ways[i].walked_count;
  }
  EXPECT_GT(scores[5].hidden_psnr_db, scores[4].hidden_psnr_db + 1);
}

// Px beside blurred edges of what is in front.
TEST_P(QualityOfLens, comesNearerToTheTruthByDeeperLayers) {
  std::vector<LensWay> ways;
  for (const uint32_t layers : {1, 2, 3}) {
    ways.push_back({.layer_count = layers, .walked_count = 8, .gathered_count = 32});
  }
  const auto scores = scoresOf(ways, 0.05);
  // Share of all px; the rest look the same with one layer.
  EXPECT_GT(scores[0].hidden_px_share, 0.05);
  EXPECT_LT(scores[0].hidden_px_share, 0.2);
  EXPECT_GT(scores[1].hidden_psnr_db, scores[0].hidden_psnr_db + 6);
  EXPECT_GT(scores[1].psnr_db, scores[0].psnr_db + 3);
  // dB: little of this room is behind two things, and sheets of one more layer are other sheets.
  constexpr double kThirdLayerLoss_db = 0.3;
  EXPECT_GT(scores[2].hidden_psnr_db, scores[1].hidden_psnr_db - kThirdLayerLoss_db);
}

INSTANTIATE_TEST_SUITE_P(Places, QualityOfLens, kGatheringPlaces, gatheringPlaceName);

}  // namespace
}  // namespace viewloom::bench::quality_lens_test
