// SPDX-License-Identifier: Apache-2.0
#include "cli/watch_words.h"

#include <utility>

#include "base/str_cat.h"
#include "cli/status_line.h"

namespace viewloom::cli {

std::string clockText(const ClockOffset& server) {
  return strCat("server clock ", formatNumber(double(server.ahead_ns) * 1e-9, 6),
                " s ahead, within ", formatNumber(double(server.error_ns) * 1e-6, 2), " ms");
}

std::string motionText(const MotionLatency& latency) {
  const auto ms = [](double seconds) { return formatNumber(1e3 * seconds, 1); };
  return strCat("motion to picture ", ms(latency.total_s), " ms (to server ",
                ms(latency.to_server_s), ", waiting ", ms(latency.waited_s), ", rendering ",
                ms(latency.made_s), ", back ", ms(latency.back_s), ")");
}

std::string planeText(const v1::AtlasLayout& layout) {
  if (!layout.has_depth_codes()) {
    return strCat("focal plane at ", formatNumber(layout.focal_distance_m(), 2), " m");
  }
  const v1::DepthCodes& codes = layout.depth_codes();
  const std::string far =
      codes.inv_z_far() < 0 ? "beyond infinity" : strCat(1 / codes.inv_z_far(), " m");
  return strCat(codes.bits(), " bits of depth from ", 1 / codes.inv_z_near(), " m to ", far);
}

std::string videoText(const v1::AtlasHeader& header, uint32_t rung) {
  if (header.video_qp() == 0) return "";
  return strCat("video QP ", header.video_qp(), rung > 1 ? " (second rung), " : ", ");
}

std::optional<std::string> DefaultsNews::note(const v1::AtlasHeader& header,
                                              const std::string& taken) {
  const uint64_t before = std::exchange(count_, header.defaults_count());
  const bool is_other = std::exchange(taken_, taken) != taken;
  if (before == 0 || count_ <= before || !is_other) return std::nullopt;
  const bool has_moved = header.defaults_reason() == v1::DEFAULTS_REASON_DEPTH_MOVED;
  return strCat(has_moved ? "the depth of the stream has changed by more than a factor of four: "
                          : "the stream has a new publisher: ",
                taken);
}

}  // namespace viewloom::cli
