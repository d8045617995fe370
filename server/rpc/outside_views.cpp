// SPDX-License-Identifier: Apache-2.0
#include "rpc/outside_views.h"

#include <utility>

#include "rpc/report_to_proto.h"

namespace viewloom {

void OutsideViews::addTo(std::span<const AtlasPtr> atlases, v1::Wanted& wanted) {
  std::map<uint64_t, Display> before = std::exchange(displays_, {});
  for (const AtlasPtr& atlas : atlases) {
    Display& display = displays_[atlas->display_id];
    if (const auto known = before.find(atlas->display_id); known != before.end()) {
      display = std::move(known->second);
    }
    const bool is_same = display.layout == atlas->layout &&
                         display.source_camera == atlas->source_camera &&
                         display.display_pose == atlas->display_pose;
    if (!is_same) {
      display = {.layout = atlas->layout,
                 .source_camera = atlas->source_camera,
                 .display_pose = atlas->display_pose,
                 .shares = {}};
    }
    const std::vector<ViewsOutside> runs = display.shares.settle(atlas->outside_shares);
    if (runs.empty()) continue;
    v1::DisplayOutside& outside = *wanted.add_outside();
    outside.set_display_id(atlas->display_id);
    for (const ViewsOutside& views : runs) *outside.add_views() = outsideToProto(views);
  }
}

}  // namespace viewloom
