// SPDX-License-Identifier: Apache-2.0
// Tests of a lens that hold wherever its second stage is worked out.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "walk/offline_renderer.h"

namespace viewloom {

inline const auto kGatheringPlaces =
    testing::Values(GatheringPlace::kHost, GatheringPlace::kDevice);

inline std::string gatheringPlaceName(const testing::TestParamInfo<GatheringPlace>& place) {
  return place.param == GatheringPlace::kHost ? "host" : "device";
}

}  // namespace viewloom
