// SPDX-License-Identifier: Apache-2.0
#include "inputs/exr_header_facts.h"

#include <utility>

#include "base/str_cat.h"
#include "files/plane_image.h"
#include "inputs/exr_camera.h"
#include "inputs/unreal_camera.h"

namespace viewloom::inputs {
namespace {

using files::ExrEnvmap;

void readAspect(const InputSettings& settings, const files::ExrDescription& description,
                Interpretation& result) {
  const double aspect = description.pixel_aspect;
  if (settings.pixel_aspect || aspect == 1 || !(aspect > 0.01 && aspect < 100)) return;
  result.pixel_aspect = aspect;
  result.notes.push_back(strCat("pixelAspectRatio ", aspect,
                                " of the header "
                                "(--pixel-aspect)"));
}

void readEnvmap(const InputSettings& settings, const files::ExrDescription& description,
                Interpretation& result) {
  if (description.envmap != ExrEnvmap::kNone && !settings.projection) {
    result.projection =
        description.envmap == ExrEnvmap::kCube ? Projection::kCube : Projection::kEquirect;
  }
  if (description.envmap == ExrEnvmap::kNone || result.projection != Projection::kFlat) return;
  result.notes.push_back("envmap of the header is left alone: --projection flat");
}

void notePrimaries(const InputSettings& settings, const files::ExrDescription& description,
                   Interpretation& result) {
  if (!description.chromaticities) return;
  const auto known = files::knownPrimaries(*description.chromaticities);
  if (settings.primaries != v1::COLOR_PRIMARIES_UNSPECIFIED) {
    result.notes.push_back("chromaticities of the header are left alone: --primaries");
  } else if (!known) {
    const auto& [red, green, blue, white] = *description.chromaticities;
    result.notes.push_back(strCat("chromaticities of the header (red ", red.x, ", ", red.y,
                                  ", white ", white.x, ", ", white.y, "): converted to BT.2020"));
  } else if (*known != v1::COLOR_PRIMARIES_BT709) {
    result.notes.push_back("chromaticities of the header: sent as they are");
  }
}

void setCameraSize(const files::ExrDescription& description, Interpretation& result) {
  v1::SizePx& size = result.camera_size.emplace();
  size.set_width(uint32_t(description.parts.front().width_px));
  size.set_height(uint32_t(description.parts.front().height_px));
}

}  // namespace

void readHeaderFacts(const InputSettings& settings, const files::ExrDescription& description,
                     Interpretation& result) {
  readAspect(settings, description, result);
  readEnvmap(settings, description, result);
  notePrimaries(settings, description, result);
}

absl::Status readHeaderCamera(const InputSettings& settings, const std::string& file,
                              const files::ExrDescription& description, Interpretation& result) {
  const files::ExrDescribedPart& part = description.parts.front();
  v1::Camera& stated = *result.source.mutable_camera();
  if (result.kind == InputKind::kUnreal) {
    auto camera = unrealCamera(file, description.texts, double(part.width_px),
                               double(part.height_px), result.pixel_aspect);
    if (!camera.ok()) return camera.status();
    if (!*camera) {
      result.notes.push_back("Unreal: no camera in the header");
      return absl::OkStatus();
    }
    stated = **std::move(camera);
    setCameraSize(description, result);
    return absl::OkStatus();
  }
  // What the user says of a plain file holds, whatever the header has.
  if (settings.kind == InputKind::kPlain) return absl::OkStatus();
  auto camera = exrCamera(file, description,
                          {.width_px = double(part.width_px),
                           .height_px = double(part.height_px),
                           .metres_per_unit = settings.depth_scale.value_or(1),
                           .looks_along_minus_z = settings.looks_along_minus_z});
  if (!camera.ok()) return camera.status();
  if (!*camera) return absl::OkStatus();
  *stated.mutable_pose() = (*camera)->pose;
  if ((*camera)->intrinsics) {
    *stated.mutable_intrinsics() = *(*camera)->intrinsics;
    setCameraSize(description, result);
  }
  result.notes.push_back(strCat(
      "camera of worldToCamera", (*camera)->intrinsics ? " and worldToNDC" : "",
      ", which looks along ", settings.looks_along_minus_z ? "-z" : "+z", " (--camera-forward)"));
  return absl::OkStatus();
}

}  // namespace viewloom::inputs
