// SPDX-License-Identifier: Apache-2.0
// Reflections beside the true ones.
#include <iostream>
#include <map>

#include "bench/quality_reflections.h"
#include "gpu/test_device.h"

namespace viewloom {
namespace {

using QualityReflectionsTest = GpuTest;

// PSNR of what the source holds, dB, with a margin of 1 dB to what was measured.
const std::map<std::string, double> kKnownMin_db = {
    {"mirror floor", 25}, {"mirror sphere", 25}, {"facing mirrors", 25}, {"rough floor", 25}};

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
    EXPECT_GE(score.got.known_db, score.without.known_db + 6);
  }
}

}  // namespace
}  // namespace viewloom
