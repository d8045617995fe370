// SPDX-License-Identifier: Apache-2.0
#include "inputs/input_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "inputs/cut_depth.h"
#include "inputs/depth_conventions.h"
#include "inputs/missing_channels.h"
#include "inputs/panorama.h"
#include "inputs/photo_input.h"
#include "inspect/stored_numbers.h"
#include "photos/photo.h"

namespace viewloom::inputs {
namespace {

constexpr double kDefaultFov_deg = 40;

// Least and largest finite sample of a depth plane of floats.
SampleRange rangeOfFloats(const v1::Plane& plane, const std::vector<uint8_t>& bytes) {
  SampleRange range{.black = std::numeric_limits<double>::infinity(),
                    .white = -std::numeric_limits<double>::infinity()};
  for (const float sample : inspect::storedNumbers(plane, bytes)) {
    if (!std::isfinite(sample)) continue;
    range.black = std::min(range.black, double{sample});
    range.white = std::max(range.white, double{sample});
  }
  return range;
}

std::string distancesNote(const InputSettings& settings) {
  const NearAndFar distances = nearAndFar(settings);
  return strCat("depth of unknown scale is placed between ", distances.near_m, " and ",
                distances.far_m, " m, which suits displays (--depth-near, --depth-far)");
}

v1::Plane& depthOf(files::LoadedFrame& frame) {
  return *frame.wire.header.mutable_sources(0)->mutable_layers(0)->mutable_planes(1);
}

}  // namespace

absl::Status InputReader::settleFormat(Interpretation& how, files::LoadedFrame& frame) {
  if (how.range == DepthRange::kStated || how.range == DepthRange::kBetween) {
    return absl::OkStatus();
  }
  v1::Plane& plane = depthOf(frame);
  const uint32_t code_max = frame.code_max.front();
  SampleRange range{.black = 0, .white = double(code_max)};
  if (code_max == 0) {
    if (how.kind == InputKind::kIphone) {  // floats are in 1/m as they are
      *plane.mutable_depth() = withSettings(plane.depth(), settings_);
      return absl::OkStatus();
    }
    if (!float_range_) float_range_ = rangeOfFloats(plane, *frame.wire.planes[1]);
    range = *float_range_;
    if (!(range.white > range.black)) {
      return files::refuseFile(how.source.layers(0).depth().file(),
                               "has the same value everywhere; accepted is depth with at least "
                               "two different values");
    }
  }
  const bool is_2d_plus_z = how.range == DepthRange::k2dPlusZ;
  absl::StatusOr<v1::DepthFormat> format =
      is_2d_plus_z ? twoDPlusZFormat(settings_, range) : normalisedFormat(settings_, range);
  if (!format.ok()) {
    return absl::InvalidArgumentError(
        strCat("--input ", nameOf(how.kind), ": ", std::string(format.status().message())));
  }
  if (!is_2d_plus_z && choosesDistances(settings_)) how.notes.push_back(distancesNote(settings_));
  *plane.mutable_depth() = *std::move(format);
  return absl::OkStatus();
}

// Units that only the samples, or the camera, tell.
absl::Status InputReader::settlePixels(const Interpretation& how, files::LoadedFrame& frame) const {
  v1::Source& source = *frame.wire.header.mutable_sources(0);
  v1::Plane& plane = *source.mutable_layers(0)->mutable_planes(1);
  if (how.kind == InputKind::kRecord3d) {
    settleRecord3d(settings_, frame.code_max.front() == 0, *plane.mutable_depth());
  }
  if (!settings_.baseline_m) return absl::OkStatus();
  const bool has_camera =
      how.source.camera().has_intrinsics() || settings_.focal_px || settings_.fov_y_deg;
  if (!has_camera || plane.depth().meaning() != v1::DEPTH_MEANING_DISPARITY ||
      how.range != DepthRange::kStated) {
    return absl::InvalidArgumentError(strCat(
        "--baseline ", *settings_.baseline_m,
        has_camera ? " needs disparity in pixels: give --input kitti or --depth-meaning disparity, "
                     "or leave it out"
                   : " needs the focal length of the cameras: give --focal-px, in pixels of the "
                     "depth picture"));
  }
  settleBaseline(source.camera().intrinsics().focal_x_px(), *settings_.baseline_m,
                 *plane.mutable_depth());
  return absl::OkStatus();
}

// Inverse depth has its sky at 0. Measurements that failed are 0, too, but lie elsewhere. Where an
// offset is added, 0 is as good a sample as any.
void InputReader::settleZeros(Interpretation& how, files::LoadedFrame& frame) {
  v1::Plane& plane = depthOf(frame);
  if (plane.depth().meaning() != v1::DEPTH_MEANING_DISPARITY) return;
  if (plane.depth().has_invalid_value() || plane.depth().offset() != 0) return;
  if (!has_scattered_zeros_) {
    const std::vector<float> stored = inspect::storedNumbers(plane, *frame.wire.planes[1]);
    const inspect::ZeroPattern pattern =
        inspect::zeroPattern(stored, plane.size().width(), plane.size().height());
    has_scattered_zeros_ = pattern.isScattered();
    if (*has_scattered_zeros_) {
      const double share = double(pattern.zero_count) / double(stored.size());
      how.notes.push_back(strCat(
          std::round(1000 * share) / 10,
          " % of the depth is 0, scattered over the picture: 0 is read as no surface, not as "
          "infinitely far (--depth-far-zero makes it sky, --depth-invalid 0 always no surface)"));
    }
  }
  if (*has_scattered_zeros_) plane.mutable_depth()->set_invalid_value(0);
}

absl::StatusOr<files::LoadedFrame> InputReader::load(const InputFiles& files,
                                                     const Interpretation& how) const {
  if (photos::isPhoto(files.color)) return loadPhotoFrame(how.source);
  v1::FrameManifest manifest;
  *manifest.add_sources() = how.source;
  return files::loadFrame(manifest, "");
}

// The samples of the first frame tell what all frames mean; it is read again if that is 1/Z.
absl::StatusOr<files::LoadedFrame> InputReader::loadOfNuke(const InputFiles& files,
                                                           Interpretation& how) {
  v1::PlaneFile& file = *how.source.mutable_layers(0)->mutable_depth();
  const bool was_inverse = nuke_.known() == NukeDepth::kInverse;
  if (was_inverse) file.mutable_depth()->set_meaning(v1::DEPTH_MEANING_DISPARITY);
  absl::StatusOr<files::LoadedFrame> frame = load(files, how);
  if (!frame.ok()) return frame;
  const NukeVerdict verdict =
      judgeNukeDepth(inspect::storedNumbers(depthOf(*frame), *frame->wire.planes[1]));
  const absl::StatusOr<NukeDepth> depth = nuke_.settle(verdict, file.file(), how.nuke_channel);
  if (!depth.ok()) return depth.status();
  how.notes.push_back(noteOf(*depth, verdict, how.nuke_channel));
  if (*depth == NukeDepth::kDistance) return frame;
  how.kind = InputKind::kNuke;
  if (was_inverse) return frame;
  file.mutable_depth()->set_meaning(v1::DEPTH_MEANING_DISPARITY);
  return load(files, how);
}

absl::StatusOr<ReadInput> InputReader::read(const InputFiles& files) {
  absl::StatusOr<Interpretation> how = interpret(settings_, files);
  if (!how.ok()) return how.status();
  VIEWLOOM_RETURN_IF_ERROR(requireExrChannels(files, *how));
  absl::StatusOr<files::LoadedFrame> frame =
      how->nuke_channel.empty() ? load(files, *how) : loadOfNuke(files, *how);
  if (!frame.ok()) return frame.status();
  VIEWLOOM_RETURN_IF_ERROR(settleFormat(*how, *frame));
  v1::Source& source = *frame->wire.header.mutable_sources(0);
  const bool is_passed_on = how->kind == InputKind::kPlain && !how->nuke_channel.empty();
  if (isRenderer(how->kind) || is_passed_on) {
    settleRendererDepth(settings_, *source.mutable_layers(0)->mutable_planes(1),
                        frame->wire.planes[1], how->notes);
  }
  if (how->projection != Projection::kFlat) {
    how->notes.push_back(
        strCat("panorama of all directions", settings_.projection ? "" : " by the header's envmap",
               ": sent as a cube map, to which --fov and --focal-px do not apply"));
    VIEWLOOM_RETURN_IF_ERROR(makeCubeMap(files.color, how->projection, *frame));
  }
  *source.mutable_camera() = settleCamera(settings_, *how, source.layers(0).planes(1).size());
  VIEWLOOM_RETURN_IF_ERROR(settlePixels(*how, *frame));
  settleZeros(*how, *frame);
  if (settings_.no_surface_beyond_m) {
    VIEWLOOM_RETURN_IF_ERROR(cutDepth(*settings_.no_surface_beyond_m, source, frame->wire));
  }
  return ReadInput{*std::move(how), *std::move(frame)};
}

v1::Camera settleCamera(const InputSettings& settings, const Interpretation& how,
                        const v1::SizePx& depth_size) {
  v1::Camera camera = how.source.camera();
  if (how.projection != Projection::kFlat) {
    camera.clear_intrinsics();
    return camera;
  }
  const double width = how.display ? how.display->width_px : depth_size.width();
  const double height = how.display ? how.display->height_px : depth_size.height();
  v1::Intrinsics& intrinsics = *camera.mutable_intrinsics();
  const bool is_stated = how.source.camera().has_intrinsics();
  if (is_stated && how.camera_size) {
    const double across = width / how.camera_size->width();
    const double down = height / how.camera_size->height();
    intrinsics.set_focal_x_px(intrinsics.focal_x_px() * across);
    intrinsics.set_focal_y_px(intrinsics.focal_y_px() * down);
    intrinsics.set_principal_x_px(intrinsics.principal_x_px() * across);
    intrinsics.set_principal_y_px(intrinsics.principal_y_px() * down);
  }
  if (!is_stated || settings.fov_y_deg || settings.focal_px) {
    const double half_rad =
        0.5 * settings.fov_y_deg.value_or(kDefaultFov_deg) * std::numbers::pi / 180;
    const double focal_y_px = settings.focal_px
                                  ? *settings.focal_px * std::min(1.0, how.pixel_aspect)
                                  : 0.5 * height / std::tan(half_rad);
    intrinsics.set_focal_x_px(focal_y_px / how.pixel_aspect);
    intrinsics.set_focal_y_px(focal_y_px);
  }
  if (!is_stated) {
    intrinsics.set_principal_x_px(0.5 * width);
    intrinsics.set_principal_y_px(0.5 * height);
  }
  if (settings.principal_px.size() == 2) {
    intrinsics.set_principal_x_px(settings.principal_px[0]);
    intrinsics.set_principal_y_px(settings.principal_px[1]);
  }
  if (how.display) {
    intrinsics.set_principal_x_px(intrinsics.principal_x_px() + how.display->left_px);
    intrinsics.set_principal_y_px(intrinsics.principal_y_px() + how.display->top_px);
  }
  return camera;
}

}  // namespace viewloom::inputs
