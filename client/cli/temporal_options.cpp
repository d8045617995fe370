// SPDX-License-Identifier: Apache-2.0
#include "cli/temporal_options.h"
#include "usage/one_of.h"

#include <map>
#include <string>

namespace viewloom::cli {
namespace {

const std::map<std::string, v1::TemporalMode> kModes{
    {"predict", v1::TEMPORAL_MODE_PREDICT}, {"interpolate", v1::TEMPORAL_MODE_INTERPOLATE}};

}  // namespace

void addTemporalOptions(CLI::App& app, TemporalOptions& options, CLI::Option* file) {
  const char* const group = "Between frames";
  CLI::Option* const rate =
      app.add_option("--output-rate", options.output_rate_hz,
                     "Atlases a second, whatever the stream's rate is: in between, its camera is "
                     "carried on")
          ->check(CLI::Range(1.0, 240.0))
          ->excludes(file)
          ->group(group);
  const auto take = [&options](const std::string& word) { options.mode = kModes.at(word); };
  app.add_option_function<std::string>(
         "--between", take,
         "predict: from the newest frame; interpolate: one frame late, from two [predict]")
      ->check(usage::oneOf(kModes))
      ->needs(rate)
      ->group(group);
  app.add_option("--bridge", options.bridge_s,
                 "Seconds for which a late frame is bridged before the picture is held [0.25]")
      ->check(CLI::Range(0.001, 10.0))
      ->needs(rate)
      ->group(group);
}

void setTemporal(const TemporalOptions& options, v1::Display& display) {
  if (options.output_rate_hz == 0) return;
  v1::TemporalEffect& temporal = *display.mutable_effects()->mutable_temporal();
  temporal.set_output_rate_hz(options.output_rate_hz);
  temporal.set_mode(options.mode);
  temporal.set_bridge_s(options.bridge_s);
}

}  // namespace viewloom::cli
