// SPDX-License-Identifier: Apache-2.0
#include "rpc/limits_to_proto.h"

namespace viewloom {

v1::PublishAccepted limitsToProto(const FrameLimits& limits) {
  v1::PublishAccepted proto;
  proto.set_frame_bytes_max(limits.frame_bytes_max);
  proto.set_plane_side_px_max(limits.plane_side_px_max);
  proto.set_layer_count_max(limits.layer_count_max);
  proto.set_source_count_max(limits.source_count_max);
  return proto;
}

}  // namespace viewloom
