// SPDX-License-Identifier: Apache-2.0
#include "cli/file_frames.h"

#include <array>
#include <filesystem>
#include <set>
#include <utility>

#include "base/str_cat.h"
#include "cli/status_line.h"
#include "files/container.h"
#include "photos/photo.h"

namespace viewloom::cli {
namespace {

using inputs::InputKind;

absl::Status validateColors(const FileFeedOptions& options) {
  for (const std::string& file : options.depths) {
    VIEWLOOM_RETURN_IF_ERROR(files::checkPictureFile(file));
  }
  if (!options.depths.empty() && options.depths.size() != options.colors.size()) {
    return absl::InvalidArgumentError(strCat("--depth has ", options.depths.size(), " files for ",
                                             options.colors.size(),
                                             " colour files. Give one depth file for each"));
  }
  const InputKind kind = options.loader.input.kind;
  if (kind == InputKind::kRgbd || kind == InputKind::k2dPlusZ) return absl::OkStatus();
  for (const std::string& file : options.colors) {
    VIEWLOOM_RETURN_IF_ERROR(files::checkPictureFile(file));
    if (options.depths.empty() && !files::isExr(file) && !photos::isPhoto(file)) {
      return absl::InvalidArgumentError(strCat(
          file,
          ": contains no depth. Accepted are an EXR file with Z, a portrait photo (.heic), a depth "
          "file with --depth FILE, or a picture half colour, half depth with --input rgbd or "
          "2d+z"));
    }
  }
  return absl::OkStatus();
}

absl::Status addInputs(const FileFeedOptions& options, std::vector<FrameFiles>& frames) {
  VIEWLOOM_RETURN_IF_ERROR(validateColors(options));
  for (size_t i = 0; i < options.colors.size(); ++i) {
    inputs::InputFiles input{.color = options.colors[i],
                             .depth = options.depths.empty() ? "" : options.depths[i],
                             .view = options.view};
    uint32_t count = 1;
    if (files::hasExtension(input.depth, ".yuv")) {
      const auto how = inputs::interpret(options.loader.input, input);
      if (!how.ok()) return how.status();
      count = how->video_frame_count;
    }
    for (input.video_frame = 0; input.video_frame < count; ++input.video_frame) {
      frames.push_back({.manifest = {}, .deep = {}, .input = input});
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::string noteOf(const files::DeepReport& deep) {
  std::string note = strCat(
      deep.file, ": up to ", deep.samples_per_px_max, " samples per pixel, split into ",
      deep.layer_count, deep.layer_count == 1 ? " layer" : " layers", "; ",
      formatNumber(100 * deep.mergedShare(), 2), " % of pixels merged, occlusion error mean ",
      deep.error_mean_per_m, ", max ", deep.error_max_per_m, " (1/m)");
  if (deep.dropped_sample_count == 0) return note;
  return strCat(note, "; ", deep.dropped_sample_count,
                " samples dropped, because they are not in front of the camera");
}

absl::Status refuseFileOptions(const FileFeedOptions& options, const std::string& what) {
  const std::set<std::string>& given = options.loader.input.given;
  std::string first = given.empty() ? "" : *given.begin();
  if (!options.view.empty()) first = "--view";
  if (!options.depths.empty()) first = "--depth";
  if (options.loader.has_black_sky) first = "--black-sky";
  if (first.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      strCat(first, " describes files of colour and depth, and cannot be combined with ", what,
             ". Leave out ", first));
}

namespace {

// A manifest says what its files are.
absl::Status validateManifests(const FileFeedOptions& options) {
  // Beside other files the options are for those.
  if (options.manifests.empty() || !options.colors.empty() || !options.deeps.empty()) {
    return absl::OkStatus();
  }
  FileFeedOptions unused = options;
  unused.loader.input.given.erase("--tone-map");
  VIEWLOOM_RETURN_IF_ERROR(refuseFileOptions(unused, "a manifest"));
  return absl::OkStatus();
}

// A deep file holds premultiplied linear colour and planar depth in its own channels.
constexpr std::array kNotOfDeep{
    "--input",      "--depth-side",  "--black-near", "--depth-white", "--screen",
    "--factor",     "--screen-code", "--camera",     "--camera-name", "--camera-forward",
    "--depth-near", "--depth-far",   "--depth-min",  "--depth-max",   "--no-surface-beyond"};

absl::Status validateView(const FileFeedOptions& options) {
  if (options.view.empty()) return absl::OkStatus();
  for (const auto* const files : {&options.colors, &options.depths}) {
    for (const std::string& file : *files) {
      if (files::isExr(file)) return absl::OkStatus();
    }
  }
  return absl::InvalidArgumentError(
      "--view chooses a view of an EXR file, but no EXR file is given. Leave out --view");
}

}  // namespace

absl::Status validateDeep(const FileFeedOptions& options) {
  if (options.deeps.empty()) {
    if (!options.loader.has_black_sky) return absl::OkStatus();
    return absl::InvalidArgumentError(
        "--black-sky needs deep files. Give them with --deep, or leave out --black-sky");
  }
  if (!options.depths.empty() || !options.view.empty()) {
    return absl::InvalidArgumentError(
        "--depth and --view cannot be combined with --deep, because a deep file contains the whole "
        "frame. Leave them out");
  }
  const inputs::InputSettings& input = options.loader.input;
  if (input.transfer != v1::COLOR_TRANSFER_UNSPECIFIED ||
      input.alpha != v1::ALPHA_MODE_UNSPECIFIED) {
    return absl::InvalidArgumentError(
        "--transfer and --alpha cannot be combined with --deep, because deep files are linear and "
        "premultiplied. Leave them out");
  }
  // Beside other files the options are for those.
  for (const char* option : kNotOfDeep) {
    if (!options.colors.empty() || !input.given.contains(option)) continue;
    return absl::InvalidArgumentError(strCat(
        option,
        " cannot be combined with --deep, because a deep file has its own channels of colour "
        "and planar depth. Leave it out"));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<FrameFiles>> framesOf(const FileFeedOptions& options) {
  VIEWLOOM_RETURN_IF_ERROR(validateDeep(options));
  VIEWLOOM_RETURN_IF_ERROR(validateManifests(options));
  if (!options.colors.empty()) VIEWLOOM_RETURN_IF_ERROR(validateView(options));
  std::vector<FrameFiles> frames;
  for (const std::string& file : options.manifests) {
    frames.push_back({.manifest = file, .deep = {}, .input = {}});
  }
  for (const std::string& file : options.deeps) {
    frames.push_back({.manifest = {}, .deep = file, .input = {}});
  }
  VIEWLOOM_RETURN_IF_ERROR(addInputs(options, frames));
  return frames;
}

FileFrames::FileFrames(const FileFeedOptions& options, std::vector<FrameFiles> frames)
    : frames_(std::move(frames)),
      is_looping_(options.is_looping),
      loader_(options.loader),
      look_(options.loader) {}

std::vector<std::string> FileFrames::takeNotes() {
  look_.takeWarnings(notes_);
  return std::exchange(notes_, {});
}

std::vector<std::string> FileFrames::takeLastNotes() {
  look_.finish(notes_);
  return std::exchange(notes_, {});
}

void FileFrames::note(const FrameFiles& files, const LoadedFiles& loaded) {
  if (!is_repeating_) look_.offer(files, loaded.frame);
  for (const files::DeepReport& deep : loaded.frame.deep) {
    if (!is_repeating_) notes_.push_back(noteOf(deep));
  }
  if (loaded.how && !std::exchange(has_told_how_, true)) {
    notes_.insert(notes_.end(), loaded.how->notes.begin(), loaded.how->notes.end());
  }
}

absl::StatusOr<std::optional<WireFrame>> FileFrames::next(double /*elapsed_s*/) {
  if (next_index_ == frames_.size()) {
    if (!is_looping_) return std::optional<WireFrame>();
    next_index_ = 0;
    is_repeating_ = true;
  }
  const size_t index = next_index_++;
  if (only_frame_) {
    only_frame_->header.set_capture_time_ns(captureTimeNs());
    return only_frame_;
  }
  absl::StatusOr<LoadedFiles> loaded = loader_.load(frames_[index]);
  if (!loaded.ok()) return loaded.status();
  WireFrame& frame = loaded->frame.wire;
  frame.header.set_capture_time_ns(captureTimeNs());
  if (frames_.size() == 1) only_frame_ = frame;
  note(frames_[index], *loaded);
  return std::optional<WireFrame>(std::move(frame));
}

std::string FileFrames::description() const {
  const std::string name = std::filesystem::path(frames_.front().name()).filename().string();
  return frames_.size() == 1 ? name : strCat(frames_.size(), " frames from ", name);
}

void addFileOptions(const usage::Command& app, FileFeedOptions& options) {
  const char* const group = "Content";
  app.add("colour", options.colors,
          "Colour files, one per frame: EXR (with depth as Z), HEIC (portrait photos), PNG, JPEG, "
          "TIFF, WebP, PFM, PGM, PPM, BMP, NPY or .yuv")
      .group(group);
  app.add("--depth", options.depths, "Depth files, one per frame, in the formats of colour or DPT")
      .valueName("FILE")
      .group(group);
  app.add("--deep", options.deeps,
          "Deep EXR files, one per frame, with R, G, B, A, Z and optionally ZBack; each is split "
          "into layers")
      .valueName("FILE")
      .group(group);
  app.addFlag("--black-sky", options.loader.has_black_sky,
              "Put a black sky behind transparent pixels of deep files, instead of the surfaces "
              "beside them")
      .group(group);
  app.add("--view", options.view, "View of multi-view EXR files, such as left or right")
      .valueName("NAME")
      .defaultText("the file's default")
      .group(group);
  app.add("--manifest", options.manifests,
          "Manifests in JSON, one per frame, which describe layers and cameras")
      .valueName("FILE")
      .group(group);
}

}  // namespace viewloom::cli
