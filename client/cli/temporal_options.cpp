// SPDX-License-Identifier: Apache-2.0
#include "cli/temporal_options.h"

#include <map>
#include <string>

#include "cli/field_range.h"

namespace viewloom::cli {
namespace {

const std::map<std::string, v1::TemporalMode> kModes{
    {"predict", v1::TEMPORAL_MODE_PREDICT}, {"interpolate", v1::TEMPORAL_MODE_INTERPOLATE}};

}  // namespace

void addTemporalOptions(const usage::Command& app, TemporalOptions& options, usage::Option file) {
  const char* const group = "Between frames";
  const usage::Option rate =
      within(app.add("--output-rate", options.output_rate_hz,
                     "Atlases a second, whatever the stream's rate is: in between, its camera is "
                     "carried on"),
             "effects.temporal.output_rate_hz")
          .excludes(file)
          .group(group);
  app.addWord("--between", options.mode, kModes,
              "predict: from the newest frame; interpolate: one frame late, from two [predict]")
      .needs(rate)
      .group(group);
  app.add("--bridge", options.bridge_s,
          "Seconds for which a late frame is bridged before the picture is held [0.25]")
      .between(0.001, 10.0)
      .needs(rate)
      .group(group);
}

void setTemporal(const TemporalOptions& options, v1::Display& display) {
  if (options.output_rate_hz == 0) return;
  v1::TemporalEffect& temporal = *display.mutable_effects()->mutable_temporal();
  temporal.set_output_rate_hz(options.output_rate_hz);
  temporal.set_mode(options.mode);
  temporal.set_bridge_s(options.bridge_s);
}

}  // namespace viewloom::cli
