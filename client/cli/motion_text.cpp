// SPDX-License-Identifier: Apache-2.0
#include "cli/motion_text.h"

#include "base/str_cat.h"
#include "cli/status_line.h"

namespace viewloom::cli {

std::string clockText(const ClockOffset& server) {
  return strCat("server's clock ", formatNumber(double(server.ahead_ns) * 1e-9, 6), " s ahead, to ",
                formatNumber(double(server.error_ns) * 1e-6, 2), " ms");
}

std::string motionText(const MotionLatency& latency) {
  const auto ms = [](double seconds) { return formatNumber(1e3 * seconds, 1); };
  return strCat("motion to picture ", ms(latency.total_s), " ms (there ", ms(latency.to_server_s),
                ", waited ", ms(latency.waited_s), ", made ", ms(latency.made_s), ", back ",
                ms(latency.back_s), ")");
}

}  // namespace viewloom::cli
