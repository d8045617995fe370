// SPDX-License-Identifier: Apache-2.0
#include "inputs/interpretation.h"

#include <array>
#include <utility>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"
#include "files/file_extension.h"
#include "files/yuv_image.h"
#include "inputs/depth_format.h"
#include "inputs/interpret_exr.h"
#include "inputs/interpret_photo.h"
#include "inputs/tmiv_camera.h"
#include "inputs/used_options.h"
#include "photos/photo.h"

namespace viewloom::inputs {
namespace {

constexpr std::array<std::pair<InputKind, const char*>, 11> kNames{
    {{InputKind::kAuto, "auto"},
     {InputKind::kPlain, "plain"},
     {InputKind::kBlender, "blender"},
     {InputKind::kUnreal, "unreal"},
     {InputKind::kRgbd, "rgbd"},
     {InputKind::k2dPlusZ, "2d+z"},
     {InputKind::kSensor, "sensor"},
     {InputKind::kOpenXr, "openxr"},
     {InputKind::kTmiv, "tmiv"},
     {InputKind::kIphone, "iphone"},
     {InputKind::kRelative, "relative"}}};

absl::Status refuseInput(InputKind kind, const std::string& problem) {
  return absl::InvalidArgumentError(absl::StrCat("--input ", nameOf(kind), " ", problem));
}

v1::ImagePart oppositeOf(v1::ImagePart part) {
  switch (part) {
    case v1::IMAGE_PART_LEFT:
      return v1::IMAGE_PART_RIGHT;
    case v1::IMAGE_PART_TOP:
      return v1::IMAGE_PART_BOTTOM;
    case v1::IMAGE_PART_BOTTOM:
      return v1::IMAGE_PART_TOP;
    default:
      return v1::IMAGE_PART_LEFT;
  }
}

// Colour and depth are halves of one picture.
absl::Status readHalves(const InputSettings& settings, Interpretation& result) {
  v1::LayerFiles& layer = *result.source.mutable_layers(0);
  if (layer.color().file() != layer.depth().file()) {
    return refuseInput(result.kind,
                       "has its depth beside the colour, in one file; --depth is given");
  }
  layer.mutable_depth()->set_part(settings.depth_side);
  layer.mutable_color()->set_part(oppositeOf(settings.depth_side));
  return absl::OkStatus();
}

absl::Status requireDepthFile(InputKind kind, const Interpretation& result) {
  const v1::LayerFiles& layer = result.source.layers(0);
  if (layer.color().file() != layer.depth().file()) return absl::OkStatus();
  return refuseInput(kind, "takes colour files and, with --depth, as many of depth");
}

absl::Status readTmiv(const InputSettings& settings, const InputFiles& files,
                      Interpretation& result) {
  if (settings.camera_file.empty()) {
    return refuseInput(result.kind, "needs --camera FILE, TMIV's camera parameters in JSON");
  }
  absl::StatusOr<TmivCamera> camera =
      readTmivCamera(settings.camera_file, settings.camera_name, files.depth);
  if (!camera.ok()) return camera.status();
  v1::LayerFiles& layer = *result.source.mutable_layers(0);
  *result.source.mutable_camera() = camera->camera;
  result.camera_size = camera->size;
  *layer.mutable_depth()->mutable_depth() = camera->depth;
  const auto setRaw = [&](v1::PlaneFile& plane, uint32_t bits, bool has_chroma) {
    if (!files::hasExtension(plane.file(), ".yuv")) return;
    v1::RawVideo& raw = *plane.mutable_raw();
    *raw.mutable_size() = camera->size;
    raw.set_sample_bits(bits);
    raw.set_luma_alone(!has_chroma);
    raw.set_frame_index(files.video_frame);
  };
  setRaw(*layer.mutable_color(), camera->color_bits, camera->color_has_chroma);
  setRaw(*layer.mutable_depth(), camera->depth_bits, camera->depth_has_chroma);
  for (const v1::PlaneFile* plane : {&layer.color(), &layer.depth()}) {
    if (!plane->has_raw()) continue;
    const absl::StatusOr<uint32_t> count = files::yuvFrameCount(plane->file(), plane->raw());
    if (!count.ok()) return count.status();
    if (result.video_frame_count != 1 && result.video_frame_count != *count) {
      return files::refuseFile(
          plane->file(), absl::StrCat("has ", *count, " frames, the colour ",
                                      result.video_frame_count, "; accepted is the same number"));
    }
    result.video_frame_count = *count;
  }
  result.notes.push_back(absl::StrCat("camera ", camera->name, " of ", settings.camera_file));
  return absl::OkStatus();
}

// Kinds that say what depth samples mean; where the files lie is settled.
absl::Status readDepthMeaning(const InputSettings& settings, Interpretation& result) {
  v1::DepthFormat& format = *result.source.mutable_layers(0)->mutable_depth()->mutable_depth();
  switch (result.kind) {
    case InputKind::kSensor:
      VIEWLOOM_RETURN_IF_ERROR(requireDepthFile(result.kind, result));
      format.set_scale(0.001);
      format.set_invalid_value(0);
      return absl::OkStatus();
    case InputKind::kOpenXr:
      format.set_meaning(v1::DEPTH_MEANING_WINDOW);
      if (settings.near_m && settings.far_m) return absl::OkStatus();
      return refuseInput(
          result.kind,
          "needs --depth-near and --depth-far, nearZ and farZ in metres: far inf for "
          "an infinite far plane, near above far for reversed depth");
    case InputKind::kIphone:
    case InputKind::kRelative:
      VIEWLOOM_RETURN_IF_ERROR(requireDepthFile(result.kind, result));
      [[fallthrough]];
    case InputKind::kRgbd:
      format.set_meaning(v1::DEPTH_MEANING_DISPARITY);
      if (!settings.depth_scale) result.range = DepthRange::kNormalised;
      return absl::OkStatus();
    case InputKind::k2dPlusZ:
      format.set_meaning(v1::DEPTH_MEANING_DISPARITY);
      result.range = DepthRange::k2dPlusZ;
      return absl::OkStatus();
    default:
      return absl::OkStatus();
  }
}

bool isExr(const std::string& file) {
  return files::hasExtension(file, ".exr");
}

absl::Status readByKind(const InputSettings& settings, const InputFiles& files,
                        Interpretation& result) {
  if (photos::isPhoto(files.color)) {
    VIEWLOOM_RETURN_IF_ERROR(interpretPhoto(settings, files, result));
    if (files.depth.empty()) return absl::OkStatus();
  }
  switch (result.kind) {
    case InputKind::kRgbd:
    case InputKind::k2dPlusZ:
      VIEWLOOM_RETURN_IF_ERROR(readHalves(settings, result));
      break;
    case InputKind::kTmiv:
      return readTmiv(settings, files, result);
    default:
      if (isExr(files.color)) VIEWLOOM_RETURN_IF_ERROR(interpretExr(settings, files, result));
      break;
  }
  return readDepthMeaning(settings, result);
}

}  // namespace

std::string nameOf(InputKind kind) {
  for (const auto& [its_kind, name] : kNames) {
    if (its_kind == kind) return name;
  }
  return "plain";
}

absl::StatusOr<Interpretation> interpret(const InputSettings& settings, const InputFiles& files) {
  Interpretation result;
  result.kind = settings.kind;
  if (settings.kind == InputKind::kAuto) {
    result.kind = settings.camera_file.empty() ? InputKind::kPlain : InputKind::kTmiv;
  }
  result.source.set_connection_tolerance(settings.connection_tolerance);
  v1::LayerFiles& layer = *result.source.add_layers();
  layer.mutable_color()->set_file(files.color);
  layer.mutable_depth()->set_file(files.depth.empty() ? files.color : files.depth);
  layer.mutable_depth()->mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  layer.mutable_color()->set_transfer(settings.transfer);
  layer.mutable_color()->set_primaries(settings.primaries);
  layer.mutable_color()->set_alpha(settings.alpha);
  if (settings.pixel_aspect) result.pixel_aspect = *settings.pixel_aspect;
  VIEWLOOM_RETURN_IF_ERROR(readByKind(settings, files, result));
  v1::DepthFormat& format = *layer.mutable_depth()->mutable_depth();
  if (result.range == DepthRange::kStated) format = withSettings(format, settings);
  VIEWLOOM_RETURN_IF_ERROR(refuseUnusedOptions(settings, files, result));
  return result;
}

}  // namespace viewloom::inputs
