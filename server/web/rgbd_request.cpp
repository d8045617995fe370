// SPDX-License-Identifier: Apache-2.0
#include "web/rgbd_request.h"

#include <array>
#include <numbers>
#include <string_view>
#include <utility>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

constexpr std::array kParameters = {
    ParameterField{"stream", "stream"},
    ParameterField{"rgbd", "rgbd.form"},
    ParameterField{"preset", "rgbd.preset"},
    ParameterField{"width", "rgbd.view_size.width"},
    ParameterField{"height", "rgbd.view_size.height"},
    ParameterField{"near_m", "rgbd.near_m"},
    ParameterField{"far_m", "rgbd.far_m"},
    ParameterField{"screen_m", "rgbd.screen_m"},
    ParameterField{"depth_side", "rgbd.depth_placement"},
    ParameterField{"black_near", "rgbd.black_near"},
    ParameterField{"fov_deg", "rgbd.fov_y_rad"},
    ParameterField{"quality", "jpeg_quality"},
    ParameterField{"chroma", "chroma"},
};

template <typename Value>
using Word = std::pair<std::string_view, Value>;

constexpr std::array kForms = {Word<RgbdForm>{"color-depth", RgbdForm::kColorDepth},
                               Word<RgbdForm>{"two-layers", RgbdForm::kTwoLayers}};
constexpr std::array kSides = {Word<DepthPlacement>{"right", DepthPlacement::kRight},
                               Word<DepthPlacement>{"left", DepthPlacement::kLeft},
                               Word<DepthPlacement>{"top", DepthPlacement::kTop},
                               Word<DepthPlacement>{"bottom", DepthPlacement::kBottom}};
constexpr std::array kSwitch = {Word<bool>{"0", false}, Word<bool>{"1", true}};

// Leaves `value` alone when the parameter is not given.
template <typename Words, typename Value>
absl::Status readWord(const QueryParameters& parameters, const char* name, const Words& words,
                      Value& value) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return absl::OkStatus();
  std::string accepted;
  for (const auto& [word, meaning] : words) {
    if (word == found->second) {
      value = meaning;
      return absl::OkStatus();
    }
    accepted += strCat(accepted.empty() ? "" : ", ", word);
  }
  return invalidField(name, strCat("got \"", found->second, "\", accepted are ", accepted));
}

}  // namespace

std::span<const ParameterField> rgbdParameters() {
  return kParameters;
}

absl::StatusOr<RgbdSpec> readRgbd(const QueryParameters& parameters) {
  RgbdSpec rgbd;
  if (const auto preset = parameters.find("preset"); preset != parameters.end()) {
    rgbd.preset = preset->second;
  }
  double fov_deg = 0;
  VIEWLOOM_RETURN_IF_ERROR(readWord(parameters, "rgbd", kForms, rgbd.form));
  VIEWLOOM_RETURN_IF_ERROR(readWord(parameters, "depth_side", kSides, rgbd.depth_placement));
  VIEWLOOM_RETURN_IF_ERROR(readWord(parameters, "black_near", kSwitch, rgbd.is_black_near));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "width", rgbd.view_size_px.width));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "height", rgbd.view_size_px.height));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "near_m", rgbd.near_m));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "far_m", rgbd.far_m));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "screen_m", rgbd.screen_m));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "fov_deg", fov_deg));
  rgbd.fov_y_rad = fov_deg * kRadPerDeg;
  return rgbd;
}

}  // namespace viewloom
