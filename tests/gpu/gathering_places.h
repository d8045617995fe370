// SPDX-License-Identifier: Apache-2.0
// Tests of a lens that hold wherever its second stage is worked out.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "support/test_device.h"
#include "walk/offline_renderer.h"

namespace viewloom {

inline const auto kGatheringPlaces =
    testing::Values(GatheringPlace::kHost, GatheringPlace::kDevice);

inline std::string gatheringPlaceName(const testing::TestParamInfo<GatheringPlace>& place) {
  return place.param == GatheringPlace::kHost ? "host" : "device";
}

class GatheringTest : public GpuTest {
 protected:
  // The one of the program that gathers lenses there.
  static OfflineRenderer& rendererAt(GatheringPlace place) {
    if (place == GatheringPlace::kHost) return shared<OfflineRenderer>();
    return shared<GatheringOnDevice>();
  }

 private:
  struct GatheringOnDevice : OfflineRenderer {
    explicit GatheringOnDevice(const Device& device)
        : OfflineRenderer(device, GatheringPlace::kDevice) {}
  };
};

}  // namespace viewloom
