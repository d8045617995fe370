// SPDX-License-Identifier: Apache-2.0
#include "cli/file_frames.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/str_cat.h"
#include "cli/status_line.h"
#include "files/exr_image.h"

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

std::string noteOf(const files::DeepReport& deep) {
  std::string note =
      strCat(deep.file, ": up to ", deep.samples_per_px_max, " samples a px, split into ",
             deep.layer_count, deep.layer_count == 1 ? " layer" : " layers", "; ",
             formatNumber(100 * deep.mergedShare(), 2), " % of px merged, occlusion error mean ",
             deep.error_mean_per_m, ", max ", deep.error_max_per_m, " (1/m)");
  if (deep.dropped_sample_count == 0) return note;
  return strCat(note, "; ", deep.dropped_sample_count,
                " samples without a place in front of the camera dropped");
}

absl::Status validateDeep(const FileFeedOptions& options) {
  if (options.deeps.empty()) {
    if (!options.has_black_sky) return absl::OkStatus();
    return absl::InvalidArgumentError("--black-sky is for files given with --deep");
  }
  if (!options.depths.empty() || !options.view.empty()) {
    return absl::InvalidArgumentError(
        "--depth and --view are given with --deep; a deep file has all there is to its frame");
  }
  if (!options.planes.transfer.empty() || !options.planes.alpha.empty()) {
    return absl::InvalidArgumentError(
        "--transfer and --alpha are given with --deep; deep files are linear and premultiplied");
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status FileFrames::validate(const FileFeedOptions& options) {
  VIEWLOOM_RETURN_IF_ERROR(validateDeep(options));
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

// Those that are one a frame.
const std::vector<std::string>& FileFrames::firstFiles() const {
  if (!options_.manifests.empty()) return options_.manifests;
  return options_.deeps.empty() ? options_.colors : options_.deeps;
}

size_t FileFrames::frameCount() const {
  return firstFiles().size();
}

std::vector<std::string> FileFrames::takeNotes() {
  return std::exchange(notes_, {});
}

absl::StatusOr<std::optional<WireFrame>> FileFrames::next(double /*elapsed_s*/) {
  if (next_index_ == frameCount()) {
    if (!options_.is_looping) return std::optional<WireFrame>();
    next_index_ = 0;
    is_repeating_ = true;
  }
  const size_t index = next_index_++;
  if (only_frame_) {
    only_frame_->header.set_capture_time_ns(captureTimeNs());
    return only_frame_;
  }
  absl::StatusOr<files::LoadedFrame> frame = load(index);
  if (!frame.ok()) return frame.status();
  frame->wire.header.set_capture_time_ns(captureTimeNs());
  if (frameCount() == 1) only_frame_ = frame->wire;
  for (const files::DeepReport& deep : frame->deep) {
    if (!is_repeating_) notes_.push_back(noteOf(deep));
  }
  return std::optional<WireFrame>(std::move(frame->wire));
}

absl::StatusOr<v1::FrameManifest> FileFrames::manifestOf(size_t index) const {
  v1::FrameManifest manifest;
  v1::SourceFiles& source = *manifest.add_sources();
  source.set_connection_tolerance(options_.planes.connection_tolerance);
  if (!options_.deeps.empty()) {
    v1::DeepFile& deep = *source.mutable_deep();
    deep.set_file(options_.deeps[index]);
    deep.set_layers(options_.deep_layer_count_max);
    deep.set_black_sky(options_.has_black_sky);
    *deep.mutable_depth() = depthFormat(options_.planes);
    return manifest;
  }
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

absl::StatusOr<files::LoadedFrame> FileFrames::load(size_t index) const {
  if (!options_.manifests.empty()) {
    const std::filesystem::path path = options_.manifests[index];
    const absl::StatusOr<v1::FrameManifest> manifest = files::readFrameManifest(path);
    if (!manifest.ok()) return manifest.status();
    return files::loadFrame(*manifest, path.parent_path());
  }
  const absl::StatusOr<v1::FrameManifest> manifest = manifestOf(index);
  if (!manifest.ok()) return manifest.status();
  absl::StatusOr<files::LoadedFrame> frame = files::loadFrame(*manifest, "");
  if (!frame.ok()) return frame;
  v1::Source& source = *frame->wire.header.mutable_sources(0);
  *source.mutable_camera() = camera(options_.planes, source.layers(0).planes(1).size());
  return frame;
}

std::string FileFrames::description() const {
  const std::string name = std::filesystem::path(firstFiles().front()).filename().string();
  return frameCount() == 1 ? name : strCat(frameCount(), " frames from ", name);
}

}  // namespace viewloom::cli
