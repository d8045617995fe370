// SPDX-License-Identifier: Apache-2.0
#include "cli/rgbd_options.h"

#include <map>
#include <string>

#include "cli/bounded_options.h"

namespace viewloom::cli {
namespace {

const std::map<std::string, v1::RgbdForm> kForms{{"color-depth", v1::RGBD_FORM_COLOR_DEPTH},
                                                 {"two-layers", v1::RGBD_FORM_TWO_LAYERS}};
const std::map<std::string, v1::DepthPlacement> kPlacements{{"right", v1::DEPTH_PLACEMENT_RIGHT},
                                                            {"left", v1::DEPTH_PLACEMENT_LEFT},
                                                            {"top", v1::DEPTH_PLACEMENT_TOP},
                                                            {"bottom", v1::DEPTH_PLACEMENT_BOTTOM}};

}  // namespace

void addRgbdOptions(const usage::Command& app, RgbdOptions& options,
                    const std::vector<usage::Option>& others) {
  const char* const group = "Colour and depth";
  const usage::Option size =
      addSizeOption(app, "--rgbd", options.view_size_px, sideMax("rgbd.view_size.width"),
                    "Send one view of this size with its depth as grey, instead of many views")
          .group(group);
  for (usage::Option other : others) size.excludes(other);
  app.addWord("--rgbd-form", options.form, kForms,
              "Colour beside depth, or two layers: hidden surfaces below both")
      .defaultText("color-depth")
      .group(group)
      .needs(size);
  app.addWord("--depth-side", options.placement, kPlacements, "Side of colour on which depth lies")
      .defaultText("right")
      .group(group)
      .needs(size);
  app.add("--depth-bits", options.depth_bits,
          "Bits of a depth sample; 16 saves PNG files of 16 bits")
      .oneOf({"8", "16"})
      .showDefault()
      .group(group)
      .needs(size);
  app.addFlag("--black-near", options.is_black_near, "Make black near, not white")
      .group(group)
      .needs(size);
  const auto addDistance = [&](const char* name, double& value_m, const char* text,
                               const char* default_text) {
    app.add(name, value_m, text)
        .valueName("METRES")
        .defaultText(default_text)
        .group(group)
        .needs(size);
  };
  addDistance("--depth-near", options.near_m, "Distance of the nearest code", "from the content");
  addDistance("--depth-far", options.far_m, "Distance of the farthest code; may be inf",
              "from the content");
  addDistance("--screen", options.screen_m,
              "Distance of the screen, which gets the middle code, as 2D+Z displays expect",
              "the preset's, else none");
}

v1::RgbdDisplay makeRgbd(const RgbdOptions& options, double fov_y_rad) {
  v1::RgbdDisplay rgbd;
  rgbd.mutable_view_size()->set_width(options.view_size_px.width);
  rgbd.mutable_view_size()->set_height(options.view_size_px.height);
  rgbd.set_form(options.form);
  rgbd.set_depth_placement(options.placement);
  rgbd.set_black_near(options.is_black_near);
  rgbd.set_near_m(options.near_m);
  rgbd.set_far_m(options.far_m);
  rgbd.set_screen_m(options.screen_m);
  rgbd.set_fov_y_rad(fov_y_rad);
  rgbd.set_depth_bits(options.depth_bits);
  return rgbd;
}

}  // namespace viewloom::cli
