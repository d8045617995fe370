// SPDX-License-Identifier: Apache-2.0
#include "files/frame_manifest.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/json_message.h"
#include "files/plane_file.h"
#include "files/surface_file.h"

namespace viewloom::files {
namespace {

constexpr uint64_t kManifestBytesMax = uint64_t{1} << 20;
constexpr int kLayersMax = 4;
constexpr int kSourcesMax = 8;

template <typename Message>
absl::StatusOr<Message> readJson(const std::filesystem::path& path, const std::string& what) {
  Message message;
  VIEWLOOM_RETURN_IF_ERROR(readJsonMessage(path, kManifestBytesMax, what, message));
  return message;
}

absl::Status checkCount(const std::string& field, int count, int max) {
  if (count >= 1 && count <= max) return absl::OkStatus();
  return invalidField(field, strCat("has ", count, "; accepted is 1..", max));
}

void addPlane(LoadedPlane loaded, v1::Layer& layer, WireFrame& frame) {
  *layer.add_planes() = std::move(loaded.plane);
  frame.planes.push_back(std::move(loaded.bytes));
}

// How the layer mirrors and moves, where there are files that say so.
absl::Status loadSurface(const v1::LayerFiles& files, const std::filesystem::path& folder,
                         v1::Layer& layer, LoadedFrame& frame) {
  struct SurfaceFile {
    const char* field;
    const v1::PlaneFile* file;
    v1::PlaneKind kind;
  };
  const SurfaceFile surface[] = {
      {"normal", files.has_normal() ? &files.normal() : nullptr, v1::PLANE_KIND_NORMAL},
      {"roughness", files.has_roughness() ? &files.roughness() : nullptr, v1::PLANE_KIND_ROUGHNESS},
      {"specular", files.has_specular() ? &files.specular() : nullptr, v1::PLANE_KIND_SPECULAR},
      {"motion", files.has_motion() ? &files.motion() : nullptr, v1::PLANE_KIND_MOTION}};
  for (const auto& [field, file, kind] : surface) {
    if (file == nullptr) continue;
    absl::StatusOr<LoadedPlane> plane = loadSurfacePlane(*file, folder, kind);
    if (!plane.ok()) return withFieldPrefix(plane.status(), field);
    if (kind == v1::PLANE_KIND_NORMAL) plane->plane.set_normal_space(files.normal_space());
    addPlane(*std::move(plane), layer, frame.wire);
  }
  if (!files.has_normal() && files.normal_space() != v1::NORMAL_SPACE_UNSPECIFIED) {
    return invalidField("normal_space", "is given without normal");
  }
  layer.set_color_has_reflections(files.color_has_reflections());
  return absl::OkStatus();
}

absl::Status loadLayer(const v1::LayerFiles& files, const std::filesystem::path& folder,
                       v1::Layer& layer, LoadedFrame& frame) {
  absl::StatusOr<LoadedPlane> color = loadColorPlane(files.color(), folder);
  if (!color.ok()) return withFieldPrefix(color.status(), "color");
  absl::StatusOr<LoadedPlane> depth = loadDepthPlane(files.depth(), folder);
  if (!depth.ok()) return withFieldPrefix(depth.status(), "depth");
  if (files.depth().depth().meaning() == v1::DEPTH_MEANING_UNSPECIFIED) {
    return invalidField("depth.depth.meaning",
                        "is missing; accepted are DEPTH_MEANING_PLANAR, _RAY_DISTANCE, _WINDOW, "
                        "_DISPARITY");
  }
  frame.code_max.push_back(depth->code_max);
  addPlane(*std::move(color), layer, frame.wire);
  addPlane(*std::move(depth), layer, frame.wire);
  return loadSurface(files, folder, layer, frame);
}

absl::Status checkDepthSizes(const v1::Source& source) {
  const v1::SizePx& first = source.layers(0).planes(1).size();
  for (int i = 1; i < source.layers_size(); ++i) {
    const v1::SizePx& size = source.layers(i).planes(1).size();
    if (size.width() == first.width() && size.height() == first.height()) continue;
    return invalidField(
        strCat("layers[", i, "].depth"),
        strCat("is ", size.width(), "x", size.height(), " px; accepted is the size of layer 0, ",
               first.width(), "x", first.height()));
  }
  return absl::OkStatus();
}

absl::Status loadDeepSource(const v1::SourceFiles& files, const std::filesystem::path& folder,
                            v1::Source& source, LoadedFrame& frame) {
  if (files.layers_size() > 0) {
    return invalidField("layers", "are given beside deep, which supplies all layers");
  }
  absl::StatusOr<DeepLayers> deep = loadDeepLayers(files.deep(), folder);
  if (!deep.ok()) return withFieldPrefix(deep.status(), "deep");
  for (size_t i = 0; i < deep->planes.size(); ++i) {
    v1::Layer& layer =
        i % 2 == 0 ? *source.add_layers() : *source.mutable_layers(source.layers_size() - 1);
    addPlane(std::move(deep->planes[i]), layer, frame.wire);
  }
  frame.deep.push_back(std::move(deep->report));
  return absl::OkStatus();
}

absl::Status loadSource(const v1::SourceFiles& files, const std::filesystem::path& folder,
                        v1::Source& source, LoadedFrame& frame) {
  if (files.has_camera()) *source.mutable_camera() = files.camera();
  source.set_connection_tolerance(files.connection_tolerance());
  source.set_cube_map(files.cube_map());
  if (files.has_deep()) return loadDeepSource(files, folder, source, frame);
  VIEWLOOM_RETURN_IF_ERROR(checkCount("layers", files.layers_size(), kLayersMax));
  for (int i = 0; i < files.layers_size(); ++i) {
    const absl::Status status = loadLayer(files.layers(i), folder, *source.add_layers(), frame);
    if (!status.ok()) return withFieldPrefix(status, strCat("layers[", i, "]"));
  }
  return checkDepthSizes(source);
}

}  // namespace

absl::StatusOr<v1::FrameManifest> readFrameManifest(const std::filesystem::path& path) {
  return readJson<v1::FrameManifest>(path, "a frame");
}

absl::StatusOr<v1::TruthManifest> readTruthManifest(const std::filesystem::path& path) {
  return readJson<v1::TruthManifest>(path, "true views");
}

absl::StatusOr<LoadedFrame> loadFrame(const v1::FrameManifest& manifest,
                                      const std::filesystem::path& folder) {
  VIEWLOOM_RETURN_IF_ERROR(checkCount("sources", manifest.sources_size(), kSourcesMax));
  LoadedFrame frame;
  v1::FrameHeader& header = frame.wire.header;
  header.set_number(std::max<uint64_t>(manifest.number(), 1));
  header.set_capture_time_ns(manifest.capture_time_ns());
  header.set_exposure_ev(manifest.exposure_ev());
  header.set_tone_map(manifest.tone_map());
  for (int i = 0; i < manifest.sources_size(); ++i) {
    const absl::Status status =
        loadSource(manifest.sources(i), folder, *header.add_sources(), frame);
    if (!status.ok()) return withFieldPrefix(status, strCat("sources[", i, "]"));
  }
  return frame;
}

}  // namespace viewloom::files
