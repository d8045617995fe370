// SPDX-License-Identifier: Apache-2.0
#include "cli/folder_frames.h"

#include <chrono>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::cli {
namespace {

// Frames that wait to be read: names alone, yet not without end.
constexpr size_t kReadyMax = 65536;

}  // namespace

absl::StatusOr<std::unique_ptr<FolderFrames>> FolderFrames::open(
    const std::filesystem::path& folder, const LoaderOptions& options, const std::string& view) {
  auto watch = FolderWatch::open(folder);
  if (!watch.ok()) return watch.status();
  return std::unique_ptr<FolderFrames>(new FolderFrames(
      folder.string(), *std::move(watch), FilePairs(folder, options.input, view), options));
}

FolderFrames::FolderFrames(std::string name, std::unique_ptr<FolderWatch> watch, FilePairs pairs,
                           const LoaderOptions& options)
    : name_(std::move(name)),
      watch_(std::move(watch)),
      pairs_(std::move(pairs)),
      loader_(options),
      look_(options) {}

void FolderFrames::skip(const std::string& file, const std::string& reason) {
  ++skipped_count_;
  // Messages of files begin with their name.
  notes_.push_back(strCat("skipped: ", reason.starts_with(file) ? "" : file + ": ", reason));
}

absl::Status FolderFrames::lookForFiles() {
  const absl::StatusOr<std::vector<std::string>> names = watch_->takeCompleted();
  if (!names.ok()) return names.status();
  for (const std::string& name : *names) {
    absl::StatusOr<std::optional<FrameFiles>> files = pairs_.add(name);
    if (!files.ok()) {
      skip(name_ + "/" + name, std::string(files.status().message()));
    } else if (*files && ready_.size() == kReadyMax) {
      skip((*files)->name(), strCat("already ", kReadyMax, " frames are waiting"));
    } else if (*files) {
      ready_.push_back(**std::move(files));
    }
  }
  for (const std::string& name : pairs_.takeGivenUp()) {
    skip(name_ + "/" + name,
         "the other file of the pair did not come. Name pairs like x.png and x_depth.png");
  }
  for (const std::string& note : pairs_.takeNotes(std::chrono::steady_clock::now())) {
    notes_.push_back(strCat(name_, "/", note));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::optional<WireFrame>> FolderFrames::next(double /*elapsed_s*/) {
  VIEWLOOM_RETURN_IF_ERROR(lookForFiles());
  while (!ready_.empty()) {
    const FrameFiles files = std::move(ready_.front());
    ready_.pop_front();
    absl::StatusOr<LoadedFiles> loaded = loader_.load(files);
    if (!loaded.ok()) {
      skip(files.name(), std::string(loaded.status().message()));
      continue;
    }
    if (loaded->how && !std::exchange(has_told_how_, true)) {
      notes_.insert(notes_.end(), loaded->how->notes.begin(), loaded->how->notes.end());
    }
    look_.offer(files, loaded->frame);
    ++published_count_;
    loaded->frame.wire.header.set_capture_time_ns(captureTimeNs());
    return std::optional<WireFrame>(std::move(loaded->frame.wire));
  }
  return std::optional<WireFrame>();
}

std::string FolderFrames::description() const {
  return strCat("folder ", name_, ", ", published_count_, " read",
                skipped_count_ == 0 ? "" : strCat(", ", skipped_count_, " skipped"));
}

std::vector<std::string> FolderFrames::takeNotes() {
  look_.takeWarnings(notes_);
  return std::exchange(notes_, {});
}

std::vector<std::string> FolderFrames::takeLastNotes() {
  look_.finish(notes_);
  return std::exchange(notes_, {});
}

}  // namespace viewloom::cli
