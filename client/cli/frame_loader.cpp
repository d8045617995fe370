// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_loader.h"

#include <utility>

#include "files/container.h"
#include "inputs/depth_format.h"
#include "inputs/exr_header_facts.h"

namespace viewloom::cli {
namespace {

bool hasLinearColor(const v1::FrameHeader& header) {
  for (const v1::Source& source : header.sources()) {
    for (const v1::Layer& layer : source.layers()) {
      for (const v1::Plane& plane : layer.planes()) {
        if (plane.transfer() == v1::COLOR_TRANSFER_LINEAR) return true;
      }
    }
  }
  return false;
}

}  // namespace

const std::string& FrameFiles::name() const {
  if (!manifest.empty()) return manifest;
  return deep.empty() ? input.color : deep;
}

absl::StatusOr<LoadedFiles> FrameLoader::loadDeep(const std::string& file) const {
  v1::FrameManifest manifest;
  v1::SourceFiles& source = *manifest.add_sources();
  source.set_connection_tolerance(options_.input.connection_tolerance);
  v1::DeepFile& deep = *source.mutable_deep();
  deep.set_file(file);
  deep.set_layers(options_.deep_layer_count_max);
  deep.set_black_sky(options_.has_black_sky);
  deep.set_primaries(options_.input.primaries);
  v1::DepthFormat planar;
  planar.set_meaning(v1::DEPTH_MEANING_PLANAR);
  *deep.mutable_depth() = inputs::withSettings(planar, options_.input);
  absl::StatusOr<inputs::Interpretation> how = inputs::interpretDeep(options_.input, deep);
  if (!how.ok()) return how.status();
  absl::StatusOr<files::LoadedFrame> frame = files::loadFrame(manifest, "");
  if (!frame.ok()) return frame.status();
  v1::Source& loaded = *frame->wire.header.mutable_sources(0);
  *loaded.mutable_camera() =
      inputs::settleCamera(options_.input, *how, loaded.layers(0).planes(1).size());
  return LoadedFiles{.frame = *std::move(frame), .how = *std::move(how)};
}

absl::StatusOr<LoadedFiles> FrameLoader::load(const FrameFiles& files) {
  absl::StatusOr<LoadedFiles> loaded = loadAny(files);
  if (!loaded.ok() || options_.input.tone_map == v1::TONE_MAP_UNSPECIFIED) return loaded;
  v1::FrameHeader& header = loaded->frame.wire.header;
  if (!hasLinearColor(header)) {
    return absl::InvalidArgumentError(
        files.name() +
        ": --tone-map needs linear colour, and this colour is sRGB. "
        "Leave it out, or give --transfer linear if the file is linear");
  }
  header.set_tone_map(options_.input.tone_map);
  return loaded;
}

absl::StatusOr<LoadedFiles> FrameLoader::loadAny(const FrameFiles& files) {
  if (!files.manifest.empty()) {
    const std::filesystem::path path = files.manifest;
    const absl::StatusOr<v1::FrameManifest> manifest = files::readFrameManifest(path);
    if (!manifest.ok()) return manifest.status();
    absl::StatusOr<files::LoadedFrame> frame = files::loadFrame(*manifest, path.parent_path());
    if (!frame.ok()) return frame.status();
    return LoadedFiles{.frame = *std::move(frame), .how = {}};
  }
  if (!files.deep.empty()) return loadDeep(files.deep);
  absl::StatusOr<inputs::ReadInput> read = reader_.read(files.input);
  if (!read.ok()) return read.status();
  return LoadedFiles{.frame = std::move(read->frame), .how = std::move(read->how)};
}

}  // namespace viewloom::cli
