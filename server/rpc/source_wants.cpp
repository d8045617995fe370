// SPDX-License-Identifier: Apache-2.0
#include "rpc/source_wants.h"

#include <utility>
#include <vector>

#include "rpc/report_to_proto.h"
#include "rpc/wanted_to_proto.h"

namespace viewloom {

v1::Wanted SourceWants::wanted(std::span<const AtlasPtr> atlases, uint32_t display_count) {
  keepDisplays(atlases);
  std::vector<InvZRange> depths;
  for (const AtlasPtr& atlas : atlases) {
    depths.push_back(displays_[atlas->display_id].depths.settle(
        {.far = atlas->stats.inv_z_far, .near = atlas->stats.inv_z_near}));
  }
  v1::Wanted wanted = wantedToProto(atlases, depths, display_count);
  for (const AtlasPtr& atlas : atlases) {
    const std::vector<ViewsOutside> runs =
        displays_[atlas->display_id].shares.settle(atlas->outside_shares);
    if (runs.empty()) continue;
    v1::DisplayOutside& outside = *wanted.add_outside();
    outside.set_display_id(atlas->display_id);
    for (const ViewsOutside& views : runs) *outside.add_views() = outsideToProto(views);
  }
  return wanted;
}

void SourceWants::keepDisplays(std::span<const AtlasPtr> atlases) {
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
                 .shares = {},
                 .depths = {}};
    }
  }
}

}  // namespace viewloom
