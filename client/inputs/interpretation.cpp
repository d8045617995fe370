// SPDX-License-Identifier: Apache-2.0
#include "inputs/interpretation.h"

#include <cmath>
#include <utility>

#include "absl/strings/match.h"
#include "base/str_cat.h"
#include "files/container.h"
#include "files/file_bytes.h"
#include "files/yuv_image.h"
#include "inputs/depth_conventions.h"
#include "inputs/depth_format.h"
#include "inputs/interpret_exr.h"
#include "inputs/photo_input.h"
#include "inputs/tmiv_camera.h"
#include "inputs/used_options.h"
#include "photos/photo.h"

namespace viewloom::inputs {
namespace {

constexpr std::pair<InputKind, const char*> kNames[] = {
    {InputKind::kAuto, "auto"},        {InputKind::kPlain, "plain"},
    {InputKind::kBlender, "blender"},  {InputKind::kUnreal, "unreal"},
    {InputKind::kNuke, "nuke"},        {InputKind::kArnold, "arnold"},
    {InputKind::kVray, "vray"},        {InputKind::kRedshift, "redshift"},
    {InputKind::kHoudini, "houdini"},  {InputKind::kRgbd, "rgbd"},
    {InputKind::k2dPlusZ, "2d+z"},     {InputKind::kSensor, "sensor"},
    {InputKind::kOpenXr, "openxr"},    {InputKind::kTmiv, "tmiv"},
    {InputKind::kIphone, "iphone"},    {InputKind::kRelative, "relative"},
    {InputKind::kKitti, "kitti"},      {InputKind::kTum, "tum"},
    {InputKind::kL515, "l515"},        {InputKind::kD405, "d405"},
    {InputKind::kRecord3d, "record3d"}};

// CARLA's cameras see as far; white of their packed depth.
constexpr double kCarlaFar_m = 1000;

absl::Status refuseInput(InputKind kind, const std::string& problem) {
  return absl::InvalidArgumentError(strCat("--input ", nameOf(kind), " ", problem));
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
    return refuseInput(result.kind, "reads colour and depth from one file. Leave out --depth");
  }
  layer.mutable_depth()->set_part(settings.depth_side);
  layer.mutable_color()->set_part(oppositeOf(settings.depth_side));
  return absl::OkStatus();
}

absl::Status requireDepthFile(InputKind kind, const Interpretation& result) {
  const v1::LayerFiles& layer = result.source.layers(0);
  if (layer.color().file() != layer.depth().file()) return absl::OkStatus();
  return refuseInput(kind, "needs depth files. Give one with --depth for each colour file");
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
          plane->file(), strCat("has ", *count, " frames, the colour ", result.video_frame_count,
                                "; accepted is the same number"));
    }
    result.video_frame_count = *count;
  }
  result.notes.push_back(strCat("camera ", camera->name, " of ", settings.camera_file));
  return absl::OkStatus();
}

// Settles the meaning of packed samples of 0..1, if no kind of input defines it.
absl::Status readPacking(const InputSettings& settings, Interpretation& result) {
  v1::DepthFormat& format = *result.source.mutable_layers(0)->mutable_depth()->mutable_depth();
  const v1::DepthPacking packing = settings.depth_packing;
  const bool is_window = settings.depth_meaning == v1::DEPTH_MEANING_WINDOW;
  if (packing == v1::DEPTH_PACKING_HUE && !is_window && !settings.depth_scale) {
    if (settings.near_m && settings.far_m) {
      // librealsense's hues grow with the distance, or, coded as disparity, with nearness.
      InputSettings hues = settings;
      if (hues.depth_meaning == v1::DEPTH_MEANING_UNSPECIFIED) {
        hues.depth_meaning = v1::DEPTH_MEANING_PLANAR;
      }
      hues.is_black_near = hues.depth_meaning == v1::DEPTH_MEANING_PLANAR;
      absl::StatusOr<v1::DepthFormat> between = normalisedFormat(hues, {});
      if (!between.ok()) return between.status();
      format = *std::move(between);
      result.range = DepthRange::kBetween;
      return absl::OkStatus();
    }
    return absl::InvalidArgumentError(
        "--depth-packing hue needs --depth-near and --depth-far, the metres at the ends of the "
        "colours. Add --depth-meaning disparity if disparity was coloured");
  }
  const bool has_far = packing == v1::DEPTH_PACKING_RGB24 || packing == v1::DEPTH_PACKING_BGR24;
  if (!has_far || is_window || settings.depth_scale ||
      settings.depth_meaning == v1::DEPTH_MEANING_DISPARITY) {
    return absl::OkStatus();
  }
  format.set_scale(kCarlaFar_m);
  result.notes.push_back(
      strCat("depth: packed, white is ", kCarlaFar_m, " m, as in CARLA (--depth-scale)"));
  return absl::OkStatus();
}

// Depth that a renderer wrote as 0..1 between two distances.
absl::Status readBetween(const InputSettings& settings, v1::DepthFormat& format,
                         Interpretation& result) {
  if (!settings.near_m && !settings.far_m) return absl::OkStatus();
  const double near_m = settings.near_m.value_or(0), far_m = settings.far_m.value_or(0);
  if (settings.depth_scale || !std::isfinite(far_m) || near_m == far_m) {
    return refuseInput(
        result.kind,
        "needs two different finite numbers of metres as --depth-near and --depth-far, for "
        "depth 0 and 1, without --depth-scale");
  }
  format.set_scale(far_m - near_m);
  format.set_offset(near_m);
  result.range = DepthRange::kBetween;
  return absl::OkStatus();
}

// Kinds that say what depth samples mean; where the files lie is settled.
absl::Status readDepthMeaning(const InputSettings& settings, Interpretation& result) {
  v1::DepthFormat& format = *result.source.mutable_layers(0)->mutable_depth()->mutable_depth();
  switch (result.kind) {
    case InputKind::kSensor:
    case InputKind::kKitti:
    case InputKind::kTum:
    case InputKind::kL515:
    case InputKind::kD405:
    case InputKind::kRecord3d:
      VIEWLOOM_RETURN_IF_ERROR(requireDepthFile(result.kind, result));
      format = sensorFormat(settings, result.kind);
      return absl::OkStatus();
    case InputKind::kNuke:
      format.set_meaning(v1::DEPTH_MEANING_DISPARITY);
      return absl::OkStatus();
    case InputKind::kVray:
    case InputKind::kRedshift:
      return readBetween(settings, format, result);
    case InputKind::kOpenXr:
      format.set_meaning(v1::DEPTH_MEANING_WINDOW);
      if (settings.near_m && settings.far_m) return absl::OkStatus();
      return refuseInput(
          result.kind,
          "needs --depth-near and --depth-far, nearZ and farZ in metres. Far may be inf, and near "
          "is larger than far if depth is reversed");
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
      return readPacking(settings, result);
  }
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
      if (files::isExr(files.color) || files::isExr(files.depth)) {
        VIEWLOOM_RETURN_IF_ERROR(interpretExr(settings, files, result));
      }
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
  if (!files::isExr(files.color) && !files::isExr(files.depth) &&
      !(settings.color_channels.empty() && settings.depth_channel.empty())) {
    return absl::InvalidArgumentError(
        "--color-channels and --depth-channel choose channels of EXR files, but no EXR file is "
        "given. "
        "Leave them out");
  }
  result.projection = settings.projection.value_or(Projection::kFlat);
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
  layer.mutable_color()->set_flip(settings.flips_color);
  layer.mutable_depth()->set_flip(settings.flips_depth);
  layer.mutable_depth()->set_packing(settings.depth_packing);
  layer.mutable_depth()->set_code_max(settings.white_code.value_or(0));
  VIEWLOOM_RETURN_IF_ERROR(files::checkPictureFile(files.color));
  if (!files.depth.empty()) VIEWLOOM_RETURN_IF_ERROR(files::checkPictureFile(files.depth));
  if (settings.pixel_aspect) result.pixel_aspect = *settings.pixel_aspect;
  VIEWLOOM_RETURN_IF_ERROR(readByKind(settings, files, result));
  v1::DepthFormat& format = *layer.mutable_depth()->mutable_depth();
  if (result.range == DepthRange::kStated) format = withSettings(format, settings);
  VIEWLOOM_RETURN_IF_ERROR(refuseUnusedOptions(settings, files, result));
  return result;
}

}  // namespace viewloom::inputs
