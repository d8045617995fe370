// SPDX-License-Identifier: Apache-2.0
// What a publisher is told of views that look past its source, and keeps being told while depth
// merely trembles.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "display/views_outside.h"
#include "encode/encoded_band.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// Thread-safety: none; one owner.
class OutsideViews {
 public:
  // From the newest atlas of each display; those without one are forgotten.
  void addTo(std::span<const AtlasPtr> atlases, v1::Wanted& wanted);

 private:
  // What shares hang on beside depth: with another of these they are settled anew.
  struct Display {
    std::shared_ptr<const AtlasLayout> layout;
    Camera source_camera;
    Pose display_pose;
    SettledShares shares;
  };

  std::map<uint64_t, Display> displays_;  // by id
};

}  // namespace viewloom
