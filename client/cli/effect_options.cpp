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
                     "Radius of a lens in front of each view, up to 10; blurs what is out of "
                     "focus"),
             "effects.lens.aperture_radius_m")
          .positive()
          .valueName("METRES")
          .defaultText("no lens")
          .excludes(file)
          .group(group);
  app.addFlag("--auto-aperture", options.has_automatic_aperture,
              "Use the smallest lens that hides ghosting far from the focal plane")
      .excludes(file)
      .excludes(radius)
      .group(group);
  within(app.add("--lens-focus", options.focus_distance_m,
                 "Distance that is sharp through the lens, 1e-6 to 1e9"),
         "effects.lens.focus_distance_m")
      .valueName("METRES")
      .defaultText("the focal plane")
      .excludes(file)
      .group(group);
  upTo(app.add("--blades", options.blades,
               "Straight sides of the lens opening, 3 to 16; 0 is round"),
       "effects.lens.blades")
      .showDefault()
      .excludes(file)
      .group(group);
  within(app.add("--lens-samples", options.walked_count,
                 "Lens rays per pixel that look for surfaces, 1 to 64"),
         "effects.lens.samples")
      .defaultText("by --effort: 4, 8 or 16")
      .excludes(file)
      .group(group);
  within(
      app.add(
          "--lens-gathered", options.gathered_count,
          "Extra lens rays per pixel, tested against surfaces that --lens-samples found, 0 to 256"),
      "effects.lens.gathered_samples")
      .defaultText("by --effort: 16, 32 or 64")
      .excludes(file)
      .group(group);
  const auto walk_doubtful = [&options] { options.mode = v1::GATHER_MODE_EXACT; };
  app.addAction("--lens-exact", walk_doubtful,
                "Test each extra ray that another surface may block against all surfaces")
      .excludes(file)
      .group(group);
  app.addWord("--effort", options.quality, kQualities,
              "Quality of everything that no other option sets: draft, balanced or best")
      .excludes(file)
      .defaultText("balanced")
      .group("Display");
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
                     "Atlases per second whatever the stream's frame rate, 1 to 240; the camera "
                     "moves on between frames"),
             "effects.temporal.output_rate_hz")
          .valueName("HZ")
          .defaultText("one atlas per frame")
          .excludes(file)
          .group(group);
  app.addWord("--between", options.mode, kModes,
              "Pictures between frames: predict from the newest frame, or interpolate two, one "
              "frame late")
      .defaultText("predict")
      .needs(rate)
      .group(group);
  within(app.add("--bridge", options.bridge_s,
                 "Longest time to predict if a frame is late, up to 10; then the picture is held"),
         "effects.temporal.bridge_s")
      .positive()
      .valueName("SECONDS")
      .defaultText("0.25")
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
