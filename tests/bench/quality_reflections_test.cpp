// SPDX-License-Identifier: Apache-2.0
// Reflections beside the true ones.
#include <iostream>
#include <map>

#include "bench/quality_reflections.h"
#include "gpu/test_device.h"

namespace viewloom {
namespace {

using QualityReflectionsTest = GpuTest;

// PSNR of what the source holds, dB: 1 dB below what was measured.
const std::map<std::string, double> kKnownMin_db = {
    {"mirror floor", 37.7}, {"mirror sphere", 36.2}, {"facing mirrors", 36}, {"rough floor", 33.2}};
// Above the same views without reflections.
constexpr double kGainMin_db = 20;
// What no source holds ends in the environment, and little else does.
constexpr double kEnvironmentBeyond = 0.02;

TEST_F(QualityReflectionsTest, mirrorsShowWhatTheSourceHolds) {
  for (const bench::ReflectionScore& score : bench::reflectionScores(device())) {
    SCOPED_TRACE(score.scene + ", view " + score.view);
    std::cout << score.scene << ", view " << score.view << ": known " << score.known_share
              << ", dB known / all: without " << score.without.known_db << " / "
              << score.without.all_db << ", got " << score.got.known_db << " / " << score.got.all_db
              << "; rays hit " << score.counts.hit << ", assumed " << score.counts.assumed
              << ", back " << score.counts.back << ", environment " << score.counts.environment
              << ", bent " << score.counts.bent << "\n";
    EXPECT_GE(score.got.known_db, kKnownMin_db.at(score.scene));
    EXPECT_GE(score.got.known_db, score.without.known_db + kGainMin_db);
    const double environment = double(score.counts.environment) / double(score.counts.rayCount());
    EXPECT_LE(environment, 1 - score.known_share + kEnvironmentBeyond);
  }
}

}  // namespace
}  // namespace viewloom
