// SPDX-License-Identifier: Apache-2.0
#include "inputs/interpret_exr.h"

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "files/container.h"
#include "files/exr_description.h"
#include "files/exr_image.h"
#include "files/file_bytes.h"
#include "files/file_extension.h"
#include "inputs/exr_camera.h"
#include "inputs/exr_layers.h"
#include "inputs/unreal_camera.h"

namespace viewloom::inputs {
namespace {

// What Blender writes where a ray hits nothing.
constexpr double kBlenderNothing = 1e10;
constexpr double kMetresPerCentimetre = 0.01;

void setChannels(const ExrLayers& layers, v1::LayerFiles& layer) {
  layer.mutable_color()->mutable_channels()->Assign(layers.color.begin(), layers.color.end());
  layer.mutable_depth()->clear_channels();
  layer.mutable_depth()->add_channels(layers.depth);
}

absl::Status setChannelsOfView(const std::string& view, v1::PlaneFile& plane, bool is_color) {
  if (view.empty() || !files::isExr(plane.file())) return absl::OkStatus();
  const absl::StatusOr<files::ExrViewChannels> channels =
      files::exrChannelsOfView(plane.file(), view);
  if (!channels.ok()) return channels.status();
  const std::vector<std::string>& names = is_color ? channels->color : channels->depth;
  plane.mutable_channels()->Assign(names.begin(), names.end());
  return absl::OkStatus();
}

class ExrInterpreter {
 public:
  ExrInterpreter(const InputSettings& settings, const InputFiles& files,
                 const files::ExrDescription& description, Interpretation& result)
      : settings_(settings), files_(files), description_(description), result_(result) {}

  absl::Status interpret() {
    if (!settings_.pixel_aspect && description_.pixel_aspect > 0.01 &&
        description_.pixel_aspect < 100) {
      result_.pixel_aspect = description_.pixel_aspect;
    }
    VIEWLOOM_RETURN_IF_ERROR(findLayers());
    return result_.kind == InputKind::kUnreal ? findUnrealCamera() : findCamera();
  }

 private:
  v1::LayerFiles& layer() { return *result_.source.mutable_layers(0); }
  v1::DepthFormat& depth() { return *layer().mutable_depth()->mutable_depth(); }
  bool mayDetect() const { return settings_.kind == InputKind::kAuto && files_.depth.empty(); }

  absl::Status findLayers() {
    if (result_.kind == InputKind::kUnreal || mayDetect()) {
      if (const auto layers = unrealLayers(description_)) {
        readUnreal(*layers);
        return absl::OkStatus();
      }
    }
    if (result_.kind == InputKind::kBlender || mayDetect()) {
      if (const auto layers = blenderLayers(description_, files_.view)) {
        readBlender(*layers);
        return absl::OkStatus();
      }
    }
    if (result_.kind == InputKind::kUnreal) {
      return refuse(
          "has no channel that ends in WorldDepth.R beside FinalImage's or plain R, G, B");
    }
    if (result_.kind == InputKind::kBlender) return readPlainBlender();
    VIEWLOOM_RETURN_IF_ERROR(setChannelsOfView(files_.view, *layer().mutable_color(), true));
    return setChannelsOfView(files_.view, *layer().mutable_depth(), false);
  }

  absl::Status refuse(const std::string& problem) const {
    return files::refuseFile(files_.color, absl::StrCat(problem,
                                                        "; --input plain reads R, G, B and "
                                                        "Z by any other name"));
  }

  void readUnreal(const ExrLayers& layers) {
    result_.kind = InputKind::kUnreal;
    setChannels(layers, layer());
    depth().set_scale(kMetresPerCentimetre);
    result_.notes.push_back(absl::StrCat("Unreal: colour in ", layers.color.front(), ", depth in ",
                                         layers.depth, " in cm"));
  }

  void readBlender(const ExrLayers& layers) {
    setChannels(layers, layer());
    setBlenderDepth();
    result_.notes.push_back(absl::StrCat(
        "Blender: colour in ", layers.color.front(), ", depth in ", layers.depth,
        " in scene units along the view axis (--depth-meaning ray for Cycles before 2.8)"));
  }

  // A file of a single layer has its channels without prefix.
  absl::Status readPlainBlender() {
    setBlenderDepth();
    VIEWLOOM_RETURN_IF_ERROR(setChannelsOfView(files_.view, *layer().mutable_color(), true));
    return setChannelsOfView(files_.view, *layer().mutable_depth(), false);
  }

  void setBlenderDepth() {
    result_.kind = InputKind::kBlender;
    depth().set_invalid_value(kBlenderNothing);
    depth().set_invalid_is_far(true);
  }

  absl::Status findUnrealCamera() {
    const files::ExrDescribedPart& part = description_.parts.front();
    auto camera = unrealCamera(files_.color, description_.texts, double(part.width_px),
                               double(part.height_px), result_.pixel_aspect);
    if (!camera.ok()) return camera.status();
    if (!*camera) {
      result_.notes.push_back("Unreal: no camera in the header");
      return absl::OkStatus();
    }
    *result_.source.mutable_camera() = **std::move(camera);
    return absl::OkStatus();
  }

  absl::Status findCamera() {
    const files::ExrDescribedPart& part = description_.parts.front();
    auto camera = exrCamera(files_.color, description_,
                            {.width_px = double(part.width_px),
                             .height_px = double(part.height_px),
                             .metres_per_unit = settings_.depth_scale.value_or(1),
                             .looks_along_minus_z = settings_.looks_along_minus_z});
    if (result_.kind == InputKind::kPlain && settings_.kind == InputKind::kPlain) {
      return absl::OkStatus();  // what the user says holds, whatever the header has
    }
    if (!camera.ok()) return camera.status();
    if (!*camera) return absl::OkStatus();
    v1::Camera& stated = *result_.source.mutable_camera();
    *stated.mutable_pose() = (*camera)->pose;
    if ((*camera)->intrinsics) *stated.mutable_intrinsics() = *(*camera)->intrinsics;
    result_.notes.push_back(
        absl::StrCat("camera of worldToCamera", (*camera)->intrinsics ? " and worldToNDC" : "",
                     ", which looks along ", settings_.looks_along_minus_z ? "-z" : "+z",
                     " (--camera-forward)"));
    return absl::OkStatus();
  }

  const InputSettings& settings_;
  const InputFiles& files_;
  const files::ExrDescription& description_;
  Interpretation& result_;
};

}  // namespace

absl::Status interpretExr(const InputSettings& settings, const InputFiles& files,
                          Interpretation& result) {
  const absl::StatusOr<files::ExrDescription> description = files::describeExr(files.color);
  if (!description.ok()) return description.status();
  return ExrInterpreter(settings, files, *description, result).interpret();
}

}  // namespace viewloom::inputs
