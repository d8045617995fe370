// SPDX-License-Identifier: Apache-2.0
#include "inputs/used_options.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/str_cat.h"
#include "files/container.h"

namespace viewloom::inputs {
namespace {

// Options that an interpretation can use.
struct Uses {
  InputKind kind = InputKind::kPlain;
  bool is_between = false;  // depth lies between a nearest and a farthest distance
  bool is_2d_plus_z = false;
  bool is_window = false;
  bool has_scale = false;  // --depth-scale is given
  bool has_exr_camera = false;
};

struct OptionUse {
  const char* option;
  bool (*is_used)(const Uses& uses);
  const char* belongs_to;
};

bool isOf(InputKind kind, std::initializer_list<InputKind> kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

bool isHalves(const Uses& uses) {
  return isOf(uses.kind, {InputKind::kRgbd, InputKind::k2dPlusZ});
}
bool isTmiv(const Uses& uses) {
  return uses.kind == InputKind::kTmiv;
}
bool is2dPlusZ(const Uses& uses) {
  return uses.is_2d_plus_z;
}
bool isScaled(const Uses& uses) {
  return !uses.is_2d_plus_z && !uses.is_window;
}

constexpr const char* kOfWindow = "--depth-meaning window and --input openxr";
constexpr const char* kBetween =
    "--depth-meaning window, and to --input rgbd, openxr, iphone and relative without "
    "--depth-scale";

constexpr std::array<OptionUse, 15> kUses{{
    {"--depth-side", isHalves, "--input rgbd and 2d+z"},
    {"--screen", is2dPlusZ, "--input 2d+z"},
    {"--factor", is2dPlusZ, "--input 2d+z"},
    {"--screen-code", is2dPlusZ, "--input 2d+z"},
    {"--camera", isTmiv, "--input tmiv"},
    {"--camera-name", isTmiv, "--input tmiv"},
    {"--black-near",
     [](const Uses& uses) {
       return isOf(uses.kind, {InputKind::kRgbd, InputKind::kIphone, InputKind::kRelative}) &&
              !uses.has_scale;
     },
     "--input rgbd, iphone and relative without --depth-scale"},
    {"--depth-white",
     [](const Uses& uses) { return uses.is_between || uses.is_2d_plus_z || uses.is_window; },
     "--depth-meaning window, and to --input rgbd, 2d+z, openxr, iphone and relative without "
     "--depth-scale"},
    {"--depth-meaning", [](const Uses& uses) { return !uses.is_2d_plus_z; },
     "every --input but 2d+z"},
    {"--depth-scale", isScaled, "every --input but 2d+z and openxr, and no --depth-meaning window"},
    {"--depth-offset",
     [](const Uses& uses) { return isScaled(uses) && (!uses.is_between || uses.has_scale); },
     "depth that has a scale: --depth-scale with --input rgbd, iphone and relative, or another "
     "--input but 2d+z and openxr"},
    {"--depth-near", [](const Uses& uses) { return uses.is_between || uses.is_window; }, kBetween},
    {"--depth-far", [](const Uses& uses) { return uses.is_between || uses.is_window; }, kBetween},
    {"--depth-min", [](const Uses& uses) { return uses.is_window; }, kOfWindow},
    {"--depth-max", [](const Uses& uses) { return uses.is_window; }, kOfWindow},
}};

absl::Status refuseOption(const std::string& option, InputKind kind, const std::string& rest) {
  return absl::InvalidArgumentError(
      strCat(option, " has no effect with --input ", nameOf(kind), rest));
}

// The options that have a value of their own whether they were given by name or not.
std::set<std::string> givenOptions(const InputSettings& settings) {
  std::set<std::string> given = settings.given;
  const auto add = [&given](bool is_given, const char* option) {
    if (is_given) given.insert(option);
  };
  add(settings.near_m.has_value(), "--depth-near");
  add(settings.far_m.has_value(), "--depth-far");
  add(settings.min_depth.has_value(), "--depth-min");
  add(settings.max_depth.has_value(), "--depth-max");
  add(settings.white_code.has_value(), "--depth-white");
  return given;
}

absl::Status refuseContradictions(const InputSettings& settings, const InputFiles& files,
                                  const Uses& uses) {
  const bool is_strange = settings.depth_meaning == v1::DEPTH_MEANING_WINDOW ||
                          settings.depth_meaning == v1::DEPTH_MEANING_RAY_DISTANCE;
  if (uses.is_between && is_strange) {
    return absl::InvalidArgumentError(
        strCat("--depth-meaning window and ray do not fit --input ", nameOf(uses.kind),
               ". Accepted are disparity (linear in 1/Z) and planar (linear in Z)"));
  }
  if (settings.depth_invalid_is_far && !settings.depth_invalid) {
    return absl::InvalidArgumentError(
        "--depth-invalid-is-far works only with --depth-invalid. Give the value that is infinitely "
        "far");
  }
  if (settings.given.contains("--camera-forward") && !uses.has_exr_camera) {
    return absl::InvalidArgumentError(
        strCat("--camera-forward has no effect, because ", files.color,
               " is read without the worldToCamera matrix of an EXR file. Leave it out"));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status refuseUnusedOptions(const InputSettings& settings, const InputFiles& files,
                                 const Interpretation& how) {
  const v1::DepthMeaning meaning = how.source.layers(0).depth().depth().meaning();
  const Uses uses{
      .kind = how.kind,
      .is_between = how.range == DepthRange::kNormalised || how.range == DepthRange::kBetween,
      .is_2d_plus_z = how.range == DepthRange::k2dPlusZ,
      .is_window = how.range == DepthRange::kStated && meaning == v1::DEPTH_MEANING_WINDOW,
      .has_scale = settings.depth_scale.has_value(),
      .has_exr_camera = files::isExr(files.color) && how.kind != InputKind::kUnreal};
  const std::set<std::string> given = givenOptions(settings);
  for (const OptionUse& use : kUses) {
    if (!given.contains(use.option) || use.is_used(uses)) continue;
    return refuseOption(use.option, how.kind,
                        strCat(" here. It belongs to ", use.belongs_to, ". Leave it out"));
  }
  return refuseContradictions(settings, files, uses);
}

}  // namespace viewloom::inputs
