// SPDX-License-Identifier: Apache-2.0
#include "cli/effect_options.h"

#include <map>
#include <string>

#include "cli/bounded_options.h"

namespace viewloom::cli {
namespace {

const std::map<std::string, v1::Quality> kQualities{
    {"draft", v1::QUALITY_DRAFT}, {"balanced", v1::QUALITY_BALANCED}, {"best", v1::QUALITY_BEST}};
const std::map<std::string, v1::TemporalMode> kModes{
    {"predict", v1::TEMPORAL_MODE_PREDICT}, {"interpolate", v1::TEMPORAL_MODE_INTERPOLATE}};

}  // namespace

void addLensOptions(const usage::Command& app, LensOptions& options, usage::Option file) {
  const char* const group = "Lens";
  const usage::Option radius =
      within(app.add("--aperture", options.aperture_radius_m,
                     "Radius of the opening of a lens before every view, m: blurs what is not in "
                     "focus"),
             "effects.lens.aperture_radius_m")
          .positive()
          .excludes(file)
          .group(group);
  app.addFlag("--auto-aperture", options.has_automatic_aperture,
              "As wide as surfaces beyond the ghosting limit need it")
      .excludes(file)
      .excludes(radius)
      .group(group);
  within(app.add("--lens-focus", options.focus_distance_m,
                 "Distance at which it is sharp, m [the focal plane]"),
         "effects.lens.focus_distance_m")
      .excludes(file)
      .group(group);
  upTo(app.add("--blades", options.blades, "Straight sides of the opening; 0 = round"),
       "effects.lens.blades")
      .excludes(file)
      .group(group);
  within(app.add("--lens-samples", options.walked_count, "Walked rays a px [by --effort]"),
         "effects.lens.samples")
      .excludes(file)
      .group(group);
  within(app.add("--lens-gathered", options.gathered_count,
                 "Further rays a px, compared with what the walked ones met [by --effort]"),
         "effects.lens.gathered_samples")
      .excludes(file)
      .group(group);
  const auto walk_doubtful = [&options] { options.mode = v1::GATHER_MODE_EXACT; };
  app.addAction("--lens-exact", walk_doubtful,
                "Walk those that something else may stand in the way of")
      .excludes(file)
      .group(group);
  app.addWord("--effort", options.quality, kQualities,
              "draft, balanced or best: what is spent on what is left open [balanced]")
      .excludes(file);
}

void setLens(const LensOptions& options, v1::Display& display) {
  display.set_quality(options.quality);
  if (options.aperture_radius_m == 0 && !options.has_automatic_aperture) return;
  v1::LensEffect& lens = *display.mutable_effects()->mutable_lens();
  lens.set_aperture_radius_m(options.aperture_radius_m);
  lens.set_automatic_aperture(options.has_automatic_aperture);
  if (options.focus_distance_m) lens.set_focus_distance_m(*options.focus_distance_m);
  lens.set_blades(options.blades);
  lens.set_samples(options.walked_count);
  if (options.gathered_count) lens.set_gathered_samples(*options.gathered_count);
  lens.set_mode(options.mode);
}

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
  within(app.add("--bridge", options.bridge_s,
                 "Seconds for which a late frame is bridged before the picture is held [0.25]"),
         "effects.temporal.bridge_s")
      .positive()
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
