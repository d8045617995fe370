// SPDX-License-Identifier: Apache-2.0
#include "inputs/exr_header_facts.h"

#include <algorithm>
#include <utility>

#include "base/str_cat.h"
#include "files/exr_description.h"
#include "files/file_bytes.h"
#include "files/plane_image.h"
#include "inputs/exr_camera.h"

namespace viewloom::inputs {
namespace {

using files::ExrWindow;

std::string textOf(const ExrWindow& window) {
  return strCat(window.width(), "x", window.height(), " px from ", window.min_x, ", ",
                window.min_y);
}

bool isInside(const ExrWindow& inner, const ExrWindow& outer) {
  return isSame(intersection(inner, outer), inner);
}

}  // namespace

ExrWindow intersection(const ExrWindow& a, const ExrWindow& b) {
  return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
          std::min(a.max_y, b.max_y)};
}

bool isSame(const ExrWindow& a, const ExrWindow& b) {
  return a.min_x == b.min_x && a.min_y == b.min_y && a.max_x == b.max_x && a.max_y == b.max_y;
}

void settleWindow(const ExrFrameWindows& windows, v1::ExrWindow& window, Interpretation& result) {
  const ExrWindow& display = windows.display;
  const ExrWindow& data = windows.data;
  if (isSame(display, data) || data.width() < 1 || data.height() < 1) return;
  const ExrWindow all{std::min(display.min_x, data.min_x), std::min(display.min_y, data.min_y),
                      std::max(display.max_x, data.max_x), std::max(display.max_y, data.max_y)};
  const std::string between =
      strCat("data window ", textOf(data), ", display window ", textOf(display));
  if (isInside(data, display)) {
    result.notes.push_back(between + ": pixels without data are no surface");
    return;
  }
  if (all.width() > files::kSideMax_px || all.height() > files::kSideMax_px) {
    result.notes.push_back(strCat(between,
                                  ": pixels outside the display window are left out, "
                                  "because planes have at most ",
                                  files::kSideMax_px, " px per side"));
    return;
  }
  window.set_min_x(all.min_x);
  window.set_min_y(all.min_y);
  window.mutable_size()->set_width(static_cast<uint32_t>(all.width()));
  window.mutable_size()->set_height(static_cast<uint32_t>(all.height()));
  result.display = DisplayFrame{.left_px = double(display.min_x) - all.min_x,
                                .top_px = double(display.min_y) - all.min_y,
                                .width_px = double(display.width()),
                                .height_px = double(display.height())};
  result.notes.push_back(between +
                         ": overscan is used, and --fov, --focal-px and --principal-px "
                         "are those of the display window");
}

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
    result.notes.push_back("chromaticities of the header: sent unchanged");
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
  // For a plain file, the user's words hold, whatever the header has.
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

absl::StatusOr<Interpretation> interpretDeep(const InputSettings& settings, v1::DeepFile& deep) {
  const absl::StatusOr<files::ExrDescription> description = files::describeExr(deep.file());
  if (!description.ok()) return description.status();
  Interpretation result;
  if (settings.pixel_aspect) result.pixel_aspect = *settings.pixel_aspect;
  readHeaderFacts(settings, *description, result);
  if (result.projection != Projection::kFlat) {
    return files::refuseFile(
        deep.file(),
        "is a deep panorama; accepted are panoramas in flat files. To read it as a flat "
        "picture, give --projection flat");
  }
  for (const files::ExrDescribedPart& part : description->parts) {
    if (!part.isDeep()) continue;
    settleWindow({part.display, part.data}, *deep.mutable_window(), result);
    break;
  }
  VIEWLOOM_RETURN_IF_ERROR(readHeaderCamera(settings, deep.file(), *description, result));
  return result;
}

}  // namespace viewloom::inputs
