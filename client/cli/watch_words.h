// SPDX-License-Identifier: Apache-2.0
// Words of `viewloom watch` beside the atlases: the server's clock, latency, changed defaults.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lib/latency.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::cli {

// "server clock 0.001204 s ahead, within 0.05 ms"
std::string clockText(const ClockOffset& server);
// "motion to picture 23.1 ms (to server 0.4, waiting 3.0, rendering 18.2, back 1.5)"
std::string motionText(const MotionLatency& latency);

// "focal plane at 2.00 m", or the depths that the codes of an RGBD display span.
std::string planeText(const v1::AtlasLayout& layout);

// "video QP 32, " for H.264: the quantisation that the server has chosen. "" for other encodings.
// `rung`: see AtlasLayout; the second is named.
std::string videoText(const v1::AtlasHeader& header, uint32_t rung);

// Says when a stream's defaults, and with them a display, have changed.
// Thread-safety: none; one owner.
class DefaultsNews {
 public:
  // The next atlas, and what its display takes from the stream ("focal plane at 2 m"). Empty while
  // that stays, or moves for other reasons.
  std::optional<std::string> note(const v1::AtlasHeader& header, const std::string& taken);

 private:
  uint64_t count_ = 0;  // of the newest atlas; 0 = none yet
  std::string taken_;
};

}  // namespace viewloom::cli
