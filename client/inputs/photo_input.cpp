// SPDX-License-Identifier: Apache-2.0
#include "inputs/photo_input.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/plane_file.h"
#include "inputs/depth_format.h"
#include "photos/photo.h"

namespace viewloom::inputs {
namespace {

using photos::CodeQuantity;
using photos::PhotoDepth;
using photos::PhotoDescription;

// Exif's film is 36 mm wide where the picture is.
constexpr double kFilmWidth_mm = 36;

void readProfile(const PhotoDescription& photo, Interpretation& result) {
  v1::PlaneFile& color = *result.source.mutable_layers(0)->mutable_color();
  if (photo.profile.is_hdr) {
    result.notes.push_back(
        "photo: its colour is HDR (PQ or HLG), which is read as if it were sRGB");
  }
  if (color.primaries() != v1::COLOR_PRIMARIES_UNSPECIFIED) return;
  if (photo.profile.primaries) color.set_primaries(*photo.profile.primaries);
  if (!photo.profile.is_stated || photo.profile.primaries) return;
  result.notes.push_back(
      "photo: the primaries of its colour profile are none of BT.709, Display P3 and BT.2020; read "
      "as BT.709 (--primaries)");
}

void readFocalLength(const PhotoDescription& photo, Interpretation& result) {
  if (!photo.focal_35mm) return;
  const double focal_px =
      *photo.focal_35mm / kFilmWidth_mm * std::max(photo.width_px, photo.height_px);
  v1::Intrinsics& intrinsics = *result.source.mutable_camera()->mutable_intrinsics();
  intrinsics.set_focal_x_px(focal_px);
  intrinsics.set_focal_y_px(focal_px);
  intrinsics.set_principal_x_px(0.5 * photo.width_px);
  intrinsics.set_principal_y_px(0.5 * photo.height_px);
  v1::SizePx& size = result.camera_size.emplace();
  size.set_width(photo.width_px);
  size.set_height(photo.height_px);
  result.notes.push_back(strCat("photo: focal length ", *photo.focal_35mm,
                                " mm of Exif, for a film 36 mm wide (--fov)"));
}

absl::StatusOr<v1::DepthFormat> formatBetween(InputSettings settings, const PhotoDepth& depth) {
  if (settings.depth_scale) {
    return absl::InvalidArgumentError(
        "--depth-scale cannot be combined with --depth-near and --depth-far; accepted is either");
  }
  // Codes of distances grow away from the camera.
  if (depth.quantity == CodeQuantity::kDistance &&
      settings.depth_meaning == v1::DEPTH_MEANING_UNSPECIFIED) {
    settings.depth_meaning = v1::DEPTH_MEANING_PLANAR;
    settings.is_black_near = !settings.is_black_near;
  }
  return normalisedFormat(settings, {.black = 0, .white = static_cast<double>(depth.code_max)});
}

absl::StatusOr<v1::DepthFormat> statedFormat(const std::string& file, const InputSettings& settings,
                                             const PhotoDepth& depth) {
  v1::DepthFormat format;
  format.set_meaning(depth.quantity == CodeQuantity::kDistance ? v1::DEPTH_MEANING_PLANAR
                                                               : v1::DEPTH_MEANING_DISPARITY);
  if (settings.depth_scale) return format;
  if (!depth.ends) {
    return files::refuseFile(
        file,
        strCat(
            "has ", depth.type,
            " without the distances of its codes; give --depth-near and --depth-far, the metres of "
            "the nearest and the farthest code"));
  }
  photos::CodeEnds ends = *depth.ends;
  if (settings.is_black_near) std::swap(ends.at_zero, ends.at_most);
  format.set_scale((ends.at_most - ends.at_zero) / depth.code_max);
  format.set_offset(ends.at_zero);
  return format;
}

void noteDepth(const PhotoDepth& depth, Interpretation& result) {
  const bool is_distance = depth.quantity == CodeQuantity::kDistance;
  std::string note = strCat("photo: ", is_distance ? "distances" : "disparity", " in ", depth.type);
  if (result.range == DepthRange::kStated && depth.ends) {
    note += strCat(", ", depth.ends->at_zero, " .. ", depth.ends->at_most,
                   is_distance ? " m" : " 1/m", " by its ", depth.origin);
    if (depth.is_relative) note += strCat(", which calls itself relative");
  }
  result.notes.push_back(std::move(note));
}

absl::Status readDepth(const InputSettings& settings, const std::string& file,
                       const PhotoDepth& depth, Interpretation& result) {
  const bool is_between = settings.near_m || settings.far_m;
  result.kind = InputKind::kIphone;
  result.range = is_between ? DepthRange::kBetween : DepthRange::kStated;
  absl::StatusOr<v1::DepthFormat> format =
      is_between ? formatBetween(settings, depth) : statedFormat(file, settings, depth);
  if (!format.ok()) return format.status();
  *result.source.mutable_layers(0)->mutable_depth()->mutable_depth() = *std::move(format);
  noteDepth(depth, result);
  return absl::OkStatus();
}

}  // namespace

absl::Status interpretPhoto(const InputSettings& settings, const InputFiles& files,
                            Interpretation& result) {
  const absl::StatusOr<photos::Photo> photo = photos::Photo::open(files.color);
  if (!photo.ok()) return photo.status();
  const PhotoDescription& description = photo->description();
  readProfile(description, result);
  // For a plain file, the user's words hold, whatever it has.
  if (settings.kind != InputKind::kPlain) readFocalLength(description, result);
  if (!files.depth.empty()) return absl::OkStatus();
  if (settings.kind != InputKind::kAuto && settings.kind != InputKind::kIphone) {
    return files::refuseFile(files.color,
                             strCat("is a photo, which --input ", nameOf(settings.kind),
                                    " cannot read alone. Leave out --input, or add --depth FILE"));
  }
  VIEWLOOM_RETURN_IF_ERROR(photo->requireDepth());
  return readDepth(settings, files.color, *description.depth, result);
}

namespace {

absl::StatusOr<files::LoadedPlane> loadDepth(const v1::LayerFiles& layer,
                                             const photos::Photo& photo) {
  if (layer.depth().file() != layer.color().file()) return files::loadDepthPlane(layer.depth(), "");
  absl::StatusOr<files::PlaneImage> image = photo.readDepth();
  if (!image.ok()) return image.status();
  return files::makeDepthPlane(layer.depth(), *std::move(image));
}

}  // namespace

absl::StatusOr<files::LoadedFrame> loadPhotoFrame(const v1::SourceFiles& source) {
  const v1::LayerFiles& layer = source.layers(0);
  const absl::StatusOr<photos::Photo> photo = photos::Photo::open(layer.color().file());
  if (!photo.ok()) return photo.status();
  absl::StatusOr<files::PlaneImage> image = photo->readColor();
  if (!image.ok()) return image.status();
  absl::StatusOr<files::LoadedPlane> color =
      files::makeColorPlane(layer.color(), *std::move(image));
  if (!color.ok()) return color.status();
  absl::StatusOr<files::LoadedPlane> depth = loadDepth(layer, *photo);
  if (!depth.ok()) return depth.status();
  files::LoadedFrame frame;
  v1::Source& loaded = *frame.wire.header.add_sources();
  loaded.set_connection_tolerance(source.connection_tolerance());
  frame.code_max.push_back(depth->code_max);
  v1::Layer& planes = *loaded.add_layers();
  for (files::LoadedPlane* plane : {&*color, &*depth}) {
    *planes.add_planes() = std::move(plane->plane);
    frame.wire.planes.push_back(std::move(plane->bytes));
  }
  return frame;
}

}  // namespace viewloom::inputs
