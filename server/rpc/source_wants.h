// SPDX-License-Identifier: Apache-2.0
// Wants of a stream's displays, seen from its source → proto Wanted. A publisher keeps being told
// the same while depth merely trembles.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "display/source_demand.h"
#include "display/views_outside.h"
#include "encode/encoded_band.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// From the newest atlas of each display, and the depths (of as many) between which its views are to
// find something; a display without one adds nothing but its count.
v1::Wanted wantedToProto(std::span<const AtlasPtr> atlases, std::span<const InvZRange> depths,
                         uint32_t display_count);

// Thread-safety: none; one owner.
class SourceWants {
 public:
  // From the newest atlas of each display; those without one are forgotten, and add nothing but to
  // the count.
  v1::Wanted wanted(std::span<const AtlasPtr> atlases, uint32_t display_count);

 private:
  // The properties of a display that shares and depths depend on, beside the scene: if one changes,
  // they are settled anew.
  struct Display {
    std::shared_ptr<const AtlasLayout> layout;
    Camera source_camera;
    Pose display_pose;
    SettledShares shares;
    SettledRange depths;
  };

  void keepDisplays(std::span<const AtlasPtr> atlases);

  std::map<uint64_t, Display> displays_;  // by id
};

}  // namespace viewloom
