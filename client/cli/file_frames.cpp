// SPDX-License-Identifier: Apache-2.0
#include "cli/file_frames.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/str_cat.h"
#include "files/exr_image.h"
#include "files/frame_manifest.h"

namespace viewloom::cli {
namespace {

bool isExr(const std::string& file) {
  return std::filesystem::path(file).extension() == ".exr";
}

absl::Status setChannels(const std::string& view, v1::PlaneFile& color, v1::PlaneFile& depth) {
  if (view.empty()) return absl::OkStatus();
  for (v1::PlaneFile* plane : {&color, &depth}) {
    if (!isExr(plane->file())) continue;
    const absl::StatusOr<files::ExrViewChannels> channels =
        files::exrChannelsOfView(plane->file(), view);
    if (!channels.ok()) return channels.status();
    const std::vector<std::string>& names = plane == &color ? channels->color : channels->depth;
    plane->mutable_channels()->Assign(names.begin(), names.end());
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status FileFrames::validate(const FileFeedOptions& options) {
  if (!options.depths.empty() && options.depths.size() != options.colors.size()) {
    return absl::InvalidArgumentError(strCat("--depth has ", options.depths.size(), " files for ",
                                             options.colors.size(),
                                             " of colour; accepted is one each"));
  }
  for (const std::string& file : options.colors) {
    if (options.depths.empty() && !isExr(file)) {
      return absl::InvalidArgumentError(strCat(
          file, ": holds no depth; accepted is an EXR file with Z, or --depth FILE beside it"));
    }
  }
  return absl::OkStatus();
}

FileFrames::FileFrames(FileFeedOptions options) : options_(std::move(options)) {}

size_t FileFrames::frameCount() const {
  return std::max(options_.manifests.size(), options_.colors.size());
}

absl::StatusOr<std::optional<WireFrame>> FileFrames::next(double /*elapsed_s*/) {
  if (next_index_ == frameCount()) {
    if (!options_.is_looping) return std::optional<WireFrame>();
    next_index_ = 0;
  }
  const size_t index = next_index_++;
  if (only_frame_) {
    only_frame_->header.set_capture_time_ns(captureTimeNs());
    return only_frame_;
  }
  absl::StatusOr<WireFrame> frame = load(index);
  if (!frame.ok()) return frame.status();
  frame->header.set_capture_time_ns(captureTimeNs());
  if (frameCount() == 1) only_frame_ = *frame;
  return std::optional<WireFrame>(*std::move(frame));
}

absl::StatusOr<v1::FrameManifest> FileFrames::manifestOf(size_t index) const {
  v1::FrameManifest manifest;
  v1::SourceFiles& source = *manifest.add_sources();
  source.set_connection_tolerance(options_.planes.connection_tolerance);
  v1::LayerFiles& layer = *source.add_layers();
  layer.mutable_color()->set_file(options_.colors[index]);
  layer.mutable_depth()->set_file(options_.depths.empty() ? options_.colors[index]
                                                          : options_.depths[index]);
  setColorMeaning(options_.planes, *layer.mutable_color());
  *layer.mutable_depth()->mutable_depth() = depthFormat(options_.planes);
  VIEWLOOM_RETURN_IF_ERROR(
      setChannels(options_.view, *layer.mutable_color(), *layer.mutable_depth()));
  return manifest;
}

absl::StatusOr<WireFrame> FileFrames::load(size_t index) const {
  if (!options_.manifests.empty()) {
    const std::filesystem::path path = options_.manifests[index];
    const absl::StatusOr<v1::FrameManifest> manifest = files::readFrameManifest(path);
    if (!manifest.ok()) return manifest.status();
    return files::loadFrame(*manifest, path.parent_path());
  }
  const absl::StatusOr<v1::FrameManifest> manifest = manifestOf(index);
  if (!manifest.ok()) return manifest.status();
  absl::StatusOr<WireFrame> frame = files::loadFrame(*manifest, "");
  if (!frame.ok()) return frame;
  v1::Source& source = *frame->header.mutable_sources(0);
  *source.mutable_camera() = camera(options_.planes, source.layers(0).planes(1).size());
  return frame;
}

std::string FileFrames::description() const {
  const std::string& first =
      options_.manifests.empty() ? options_.colors.front() : options_.manifests.front();
  const std::string name = std::filesystem::path(first).filename().string();
  return frameCount() == 1 ? name : strCat(frameCount(), " frames from ", name);
}

}  // namespace viewloom::cli
