// SPDX-License-Identifier: Apache-2.0
// Atlases between frames beside the frames that were dropped.
#include <iostream>

#include "bench/quality_time.h"
#include "gpu/test_device.h"

namespace viewloom {
namespace {

using QualityTimeTest = GpuTest;

// Above repeating the last frame, and above the row warp of the nearest: that knows how the camera
// moves, not how things do.
TEST_F(QualityTimeTest, carriesCameraAndThingsOnBetterThanRepeatingOrWarpingFrames) {
  for (const bench::TimeScore& score : bench::timeScores(device())) {
    SCOPED_TRACE(score.sequence + ", " + score.mode);
    std::cout << score.sequence << ", " << score.mode << ", one frame of " << score.kept_one_of
              << " kept: repeated " << score.repeated_db << " dB, warped " << score.warped_db
              << " dB, got " << score.got_db << " dB\n";
    const bool camera_moves = score.sequence == "camera motion";
    EXPECT_GE(score.got_db, score.repeated_db + (camera_moves ? 6.8 : 7));
    EXPECT_GE(score.got_db, score.warped_db + (camera_moves ? 6 : 7));
  }
}

}  // namespace
}  // namespace viewloom
