// SPDX-License-Identifier: Apache-2.0
#include "inputs/depth_format.h"

#include <cmath>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::inputs {
namespace {

constexpr double kDefaultNear_m = 2.0 / 3, kDefaultFar_m = 2;
constexpr double kDefaultRatio = kDefaultFar_m / kDefaultNear_m;

absl::Status checkNearAndFar(const NearAndFar& given, bool may_be_infinite) {
  const auto [near_m, far_m] = given;
  const bool is_far_enough = far_m > near_m && (may_be_infinite || std::isfinite(far_m));
  if (near_m > 0 && is_far_enough) return absl::OkStatus();
  return absl::InvalidArgumentError(
      strCat("--depth-near is ", near_m, " and --depth-far ", far_m,
             "; accepted are the metres of the nearest and of the farthest code, 0 < near < "
             "far",
             may_be_infinite ? " (which may be inf)" : ", finite where depth is planar"));
}

v1::DepthFormat withInvalid(v1::DepthFormat format, const InputSettings& settings) {
  if (settings.depth_invalid) format.set_invalid_value(*settings.depth_invalid);
  if (settings.depth_invalid_is_far) format.set_invalid_is_far(true);
  if (settings.depth_far_zero) {
    format.set_invalid_value(0);
    format.set_invalid_is_far(true);
  }
  return format;
}

}  // namespace

NearAndFar nearAndFar(const InputSettings& settings) {
  if (settings.near_m)
    return {*settings.near_m, settings.far_m.value_or(kDefaultRatio * *settings.near_m)};
  if (!settings.far_m) return {kDefaultNear_m, kDefaultFar_m};
  return {std::isfinite(*settings.far_m) ? *settings.far_m / kDefaultRatio : kDefaultNear_m,
          *settings.far_m};
}

bool choosesDistances(const InputSettings& settings) {
  return !settings.near_m || !settings.far_m;
}

v1::DepthFormat withSettings(v1::DepthFormat format, const InputSettings& settings) {
  if (settings.depth_meaning != v1::DEPTH_MEANING_UNSPECIFIED) {
    format.set_meaning(settings.depth_meaning);
  }
  if (settings.depth_scale) format.set_scale(*settings.depth_scale);
  if (settings.depth_offset) format.set_offset(*settings.depth_offset);
  if (format.meaning() == v1::DEPTH_MEANING_WINDOW) {
    if (settings.near_m) format.set_near_z_m(*settings.near_m);
    if (settings.far_m) format.set_far_z_m(*settings.far_m);
    if (settings.min_depth) format.set_min_depth(*settings.min_depth);
    if (settings.max_depth) format.set_max_depth(*settings.max_depth);
  }
  return withInvalid(std::move(format), settings);
}

absl::StatusOr<v1::DepthFormat> normalisedFormat(const InputSettings& settings,
                                                 const SampleRange& range) {
  const bool is_planar = settings.depth_meaning == v1::DEPTH_MEANING_PLANAR;
  const NearAndFar distances = nearAndFar(settings);
  VIEWLOOM_RETURN_IF_ERROR(checkNearAndFar(distances, !is_planar));
  // In Z, or in 1/Z.
  const double near_value = is_planar ? distances.near_m : 1 / distances.near_m;
  const double far_value = is_planar ? distances.far_m : 1 / distances.far_m;
  const double at_black = settings.is_black_near ? near_value : far_value;
  const double at_white = settings.is_black_near ? far_value : near_value;
  v1::DepthFormat format;
  format.set_meaning(is_planar ? v1::DEPTH_MEANING_PLANAR : v1::DEPTH_MEANING_DISPARITY);
  const double scale = (at_white - at_black) / (range.white - range.black);
  format.set_scale(scale);
  format.set_offset(at_black - range.black * scale);
  return withInvalid(std::move(format), settings);
}

absl::StatusOr<v1::DepthFormat> twoDPlusZFormat(const InputSettings& settings,
                                                const SampleRange& range) {
  const double strength = settings.factor / 64;
  const double black = 1 - strength * settings.screen_code / 255;
  if (!(settings.screen_m > 0) || !(strength > 0) || !(black >= 0)) {
    return absl::InvalidArgumentError(
        strCat("--screen ", settings.screen_m, " --factor ", settings.factor, " --screen-code ",
               settings.screen_code,
               " put black behind infinity; accepted are a screen and a factor above 0, and "
               "factor / 64 x screen-code / 255 up to 1"));
  }
  v1::DepthFormat format;
  format.set_meaning(v1::DEPTH_MEANING_DISPARITY);
  format.set_scale(strength / range.white / settings.screen_m);
  format.set_offset(black / settings.screen_m);
  return withInvalid(std::move(format), settings);
}

}  // namespace viewloom::inputs
