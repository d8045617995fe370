// SPDX-License-Identifier: Apache-2.0
#include "cli/lens_options.h"
#include "usage/one_of.h"

#include <map>
#include <string>

namespace viewloom::cli {
namespace {

const std::map<std::string, v1::Quality> kQualities{
    {"draft", v1::QUALITY_DRAFT}, {"balanced", v1::QUALITY_BALANCED}, {"best", v1::QUALITY_BEST}};

}  // namespace

void addLensOptions(CLI::App& app, LensOptions& options, CLI::Option* file) {
  const char* const group = "Lens";
  CLI::Option* const radius =
      app.add_option("--aperture", options.aperture_radius_m,
                     "Radius of the opening of a lens before every view, m: blurs what is not in "
                     "focus")
          ->check(CLI::Range(1e-6, 10.0))
          ->excludes(file)
          ->group(group);
  app.add_flag("--auto-aperture", options.has_automatic_aperture,
               "As wide as surfaces beyond the ghosting limit need it")
      ->excludes(file)
      ->excludes(radius)
      ->group(group);
  app.add_option("--lens-focus", options.focus_distance_m,
                 "Distance at which it is sharp, m [the focal plane]")
      ->check(CLI::Range(1e-6, 1e9))
      ->excludes(file)
      ->group(group);
  app.add_option("--blades", options.blades, "Straight sides of the opening; 0 = round")
      ->check(CLI::Range(0, 16))
      ->excludes(file)
      ->group(group);
  app.add_option("--lens-samples", options.walked_count, "Walked rays a px [by --effort]")
      ->check(CLI::Range(1, 64))
      ->excludes(file)
      ->group(group);
  app.add_option("--lens-gathered", options.gathered_count,
                 "Further rays a px, compared with what the walked ones met [by --effort]")
      ->check(CLI::Range(0, 256))
      ->excludes(file)
      ->group(group);
  const auto walk_doubtful = [&options] { options.mode = v1::GATHER_MODE_EXACT; };
  app.add_flag_callback("--lens-exact", walk_doubtful,
                        "Walk those that something else may stand in the way of")
      ->excludes(file)
      ->group(group);
  const auto take = [&options](const std::string& word) { options.quality = kQualities.at(word); };
  app.add_option_function<std::string>(
         "--effort", take, "draft, balanced or best: what is spent on what is left open [balanced]")
      ->check(usage::oneOf(kQualities))
      ->excludes(file);
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

}  // namespace viewloom::cli
