// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_stereo.h"

#include <iostream>
#include <string>

#include <nlohmann/json.hpp>

#include "support/test_device.h"

namespace viewloom::bench::quality_stereo_test {
namespace {

class QualityStereoTest : public GpuTest {};

TEST_F(QualityStereoTest, servesAHeadThatMovesWhatItWouldSee) {
  const nlohmann::ordered_json rows = qualityOfStereo(device());
  std::cout << rows.dump(2) << "\n";
  for (const auto& scene : rows) {
    SCOPED_TRACE(scene.dump());
    EXPECT_GT(scene["inside_db"], 46);
    EXPECT_GT(scene["worst_known_db"], 28.5);
    EXPECT_GT(scene["full_db"], double(scene["still_db"]) + 6);
    EXPECT_LT(scene["outside_differs_share"], 0.008);
    EXPECT_LT(scene["depth_off_share"], 0.005);
  }
}

}  // namespace
}  // namespace viewloom::bench::quality_stereo_test
