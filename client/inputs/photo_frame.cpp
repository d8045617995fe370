// SPDX-License-Identifier: Apache-2.0
#include "inputs/photo_frame.h"

#include <utility>

#include "files/plane_file.h"
#include "photos/photo.h"

namespace viewloom::inputs {
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
