// SPDX-License-Identifier: Apache-2.0
#include "show/show_statistics.h"

#include <cstdio>
#include <numbers>

#include "base/str_cat.h"

namespace viewloom::show {
namespace {

constexpr int64_t kRateInterval_ns = 500'000'000;
constexpr double kDegPerRad = 180 / std::numbers::pi;

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

std::string describeMode(const ShowSettings& settings, const v1::AtlasLayout& layout) {
  const uint32_t view = firstView(settings, layout);
  switch (settings.mode) {
    case ShowMode::kView:
      return strCat("view ", view, " of ", layout.view_count());
    case ShowMode::kPair:
      return strCat("views ", view, " and ", secondView(settings, layout), " of ",
                    layout.view_count());
    case ShowMode::kWeave:
      return strCat("weave, ", layout.view_count(), " views, ",
                    settings.is_blended ? "blended" : "nearest");
    default:
      return std::string(nameOf(settings.mode));
  }
}

}  // namespace

double ShownRate::perSecond(int64_t now_ns) {
  const int64_t elapsed_ns = now_ns - since_ns_;
  if (elapsed_ns < kRateInterval_ns) return rate_;
  rate_ = static_cast<double>(count_ - counted_) * 1e9 / static_cast<double>(elapsed_ns);
  counted_ = count_;
  since_ns_ = now_ns;
  return rate_;
}

std::string describe(const ShowStatistics& statistics, const ShowSettings& settings,
                     const v1::AtlasLayout& layout) {
  std::string text =
      strCat("frame ", statistics.frame_number, statistics.is_connected ? "" : ", no server", "\n",
             fixed(statistics.rate_hz, 1), " /s, ", statistics.dropped_count, " dropped, latency ",
             statistics.latency_s ? fixed(1e3 * *statistics.latency_s, 0) + " ms" : "unknown", "\n",
             describeMode(settings, layout));
  if (layout.focal_distance_m() > 0) {
    text += strCat("\nfocal plane ", fixed(layout.focal_distance_m(), 3), " m");
  }
  if (layout.view_cone_rad() > 0) {
    text += strCat(", cone ", fixed(layout.view_cone_rad() * kDegPerRad, 1), " deg");
  }
  if (statistics.server_clock) {
    text += strCat("\nserver clock ", fixed(double(statistics.server_clock->ahead_ns) * 1e-9, 6),
                   " s ahead, within ", fixed(double(statistics.server_clock->error_ns) * 1e-6, 2),
                   " ms");
  }
  return text;
}

}  // namespace viewloom::show
