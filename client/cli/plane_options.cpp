// SPDX-License-Identifier: Apache-2.0
#include "cli/plane_options.h"

#include <cmath>
#include <map>
#include <numbers>

namespace viewloom::cli {
namespace {

const std::map<std::string, v1::DepthMeaning> kMeanings{{"planar", v1::DEPTH_MEANING_PLANAR},
                                                        {"ray", v1::DEPTH_MEANING_RAY_DISTANCE},
                                                        {"window", v1::DEPTH_MEANING_WINDOW},
                                                        {"disparity", v1::DEPTH_MEANING_DISPARITY}};
const std::map<std::string, v1::ColorTransfer> kTransfers{{"srgb", v1::COLOR_TRANSFER_SRGB},
                                                          {"linear", v1::COLOR_TRANSFER_LINEAR}};
const std::map<std::string, v1::AlphaMode> kAlphas{{"opaque", v1::ALPHA_MODE_OPAQUE},
                                                   {"premultiplied", v1::ALPHA_MODE_PREMULTIPLIED},
                                                   {"straight", v1::ALPHA_MODE_STRAIGHT}};

// Options that set a field of the proto.
using SetDouble = void (v1::DepthFormat::*)(double);
CLI::Option* addDepthNumber(CLI::App& app, const std::string& name, v1::DepthFormat& format,
                            SetDouble set, const std::string& description) {
  const auto take = [&format, set](double value) { (format.*set)(value); };
  return app.add_option_function<double>(name, take, description)->group("Depth");
}

void addDepthOptions(CLI::App& app, PlaneOptions& options) {
  app.add_option("--depth-meaning", options.depth_meaning,
                 "What a depth sample measures: planar (along the view axis), ray (from the eye), "
                 "window (graphics depth 0..1), disparity (1/Z)")
      ->check(CLI::IsMember(kMeanings))
      ->capture_default_str()
      ->group("Depth");
  using Format = v1::DepthFormat;
  addDepthNumber(app, "--depth-scale,--scale", options.depth, &Format::set_scale,
                 "Metres (disparity: 1/m) per unit of a sample; 0.001 for millimetres [1]");
  addDepthNumber(app, "--depth-offset", options.depth, &Format::set_offset,
                 "Added after the scale [0]");
  addDepthNumber(app, "--depth-near", options.depth, &Format::set_near_z_m,
                 "window: metres to the near plane; larger than far for reversed depth");
  addDepthNumber(app, "--depth-far", options.depth, &Format::set_far_z_m,
                 "window: metres to the far plane; may be inf");
  addDepthNumber(app, "--depth-min", options.depth, &Format::set_min_depth,
                 "window: smallest depth value [0]");
  addDepthNumber(app, "--depth-max", options.depth, &Format::set_max_depth,
                 "window: largest depth value [1]");
  app.add_option("--depth-invalid", options.depth_invalid,
                 "A sample with exactly this value is no surface")
      ->group("Depth");
  app.add_flag_function(
         "--depth-invalid-is-far",
         [&options](int64_t count) { options.depth.set_invalid_is_far(count > 0); },
         "... is infinitely far instead, like a sky")
      ->group("Depth");
  app.add_flag("--depth-far-zero", options.depth_far_zero,
               "Depth 0 is infinitely far: --depth-invalid 0 --depth-invalid-is-far")
      ->group("Depth");
  app.add_option("--connection-tolerance", options.connection_tolerance,
                 "Largest step in 1/Z (1/m) inside one surface; 0 = measured")
      ->check(CLI::NonNegativeNumber)
      ->group("Depth");
}

}  // namespace

void addPlaneOptions(CLI::App& app, PlaneOptions& options) {
  addDepthOptions(app, options);
  app.add_option("--transfer", options.transfer,
                 "How colour is stored: srgb or linear [by the file]")
      ->check(CLI::IsMember(kTransfers))
      ->group("Colour");
  app.add_option("--alpha", options.alpha,
                 "What alpha says: opaque, premultiplied or straight [by the file]")
      ->check(CLI::IsMember(kAlphas))
      ->group("Colour");
  app.add_option("--fov", options.fov_y_deg, "Vertical field of view of the camera, degrees")
      ->check(CLI::Range(0.1, 170.0))
      ->capture_default_str()
      ->group("Camera");
  app.add_option("--focal-px", options.focal_px,
                 "Focal length in pixels of the depth, instead of --fov")
      ->check(CLI::PositiveNumber)
      ->group("Camera");
  app.add_option("--principal-px", options.principal_px,
                 "Where the view axis meets the image: X Y from the top left [the middle]")
      ->expected(2)
      ->group("Camera");
}

v1::DepthFormat depthFormat(const PlaneOptions& options) {
  v1::DepthFormat format = options.depth;
  format.set_meaning(kMeanings.at(options.depth_meaning));
  if (options.depth_invalid) format.set_invalid_value(*options.depth_invalid);
  if (options.depth_far_zero) {
    format.set_invalid_value(0);
    format.set_invalid_is_far(true);
  }
  return format;
}

void setColorMeaning(const PlaneOptions& options, v1::PlaneFile& color) {
  if (!options.transfer.empty()) color.set_transfer(kTransfers.at(options.transfer));
  if (!options.alpha.empty()) color.set_alpha(kAlphas.at(options.alpha));
}

v1::Camera camera(const PlaneOptions& options, const v1::SizePx& size) {
  const double half_height_px = 0.5 * size.height();
  const double half_fov_rad = 0.5 * options.fov_y_deg * std::numbers::pi / 180;
  const double focal_px =
      options.focal_px > 0 ? options.focal_px : half_height_px / std::tan(half_fov_rad);
  const bool is_given = options.principal_px.size() == 2;
  v1::Camera camera;
  v1::Intrinsics& intrinsics = *camera.mutable_intrinsics();
  intrinsics.set_focal_x_px(focal_px);
  intrinsics.set_focal_y_px(focal_px);
  intrinsics.set_principal_x_px(is_given ? options.principal_px[0] : 0.5 * size.width());
  intrinsics.set_principal_y_px(is_given ? options.principal_px[1] : half_height_px);
  return camera;
}

}  // namespace viewloom::cli
