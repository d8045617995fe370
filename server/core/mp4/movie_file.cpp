// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_file.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "mp4/movie_clock.h"

namespace viewloom {
namespace {

std::string_view textOf(const std::vector<uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

absl::StatusOr<std::unique_ptr<MovieFile>> MovieFile::create(const std::filesystem::path& path,
                                                             MovieTags tags) {
  auto out = OutputFile::create(path);
  VIEWLOOM_RETURN_IF_ERROR(out.status());
  return std::unique_ptr<MovieFile>(new MovieFile(*std::move(out), std::move(tags)));
}

MovieFile::MovieFile(std::unique_ptr<OutputFile> out, MovieTags tags)
    : out_(std::move(out)), tags_(std::move(tags)) {}

absl::Status MovieFile::add(std::span<const uint8_t> access_unit, int64_t time_ns) {
  if (!track_) {
    absl::StatusOr<AvcTrack> track = readAvcTrack(access_unit);
    VIEWLOOM_RETURN_IF_ERROR(track.status());
    track_ = *std::move(track);
  }
  const absl::StatusOr<AvcSample> sample = makeAvcSample(access_unit, track_->sets);
  VIEWLOOM_RETURN_IF_ERROR(sample.status());
  const uint64_t whole_bytes = out_->size();
  if (absl::Status written = out_->write(textOf(sample->bytes)); !written.ok()) {
    VIEWLOOM_RETURN_IF_ERROR(out_->cutTo(whole_bytes));
    return written;
  }
  endSample(time_ns);
  samples_.push_back({.size_bytes = uint32_t(sample->bytes.size()), .is_sync = sample->is_sync});
  sample_begin_ns_ = time_ns;
  return absl::OkStatus();
}

void MovieFile::endSample(int64_t time_ns) {
  if (samples_.empty()) return;
  const uint64_t ticks =
      movieTicks(std::max(time_ns, sample_begin_ns_)) - movieTicks(sample_begin_ns_);
  constexpr uint64_t kTicksMax = std::numeric_limits<uint32_t>::max();
  samples_.back().duration_ticks = uint32_t(std::clamp<uint64_t>(ticks, 1, kTicksMax));
}

// From its last sync sample on.
absl::Status MovieFile::dropLastChunk() {
  uint64_t dropped_bytes = 0;
  for (bool is_sync = false; !is_sync && !samples_.empty();) {
    is_sync = samples_.back().is_sync;
    dropped_bytes += samples_.back().size_bytes;
    samples_.pop_back();
  }
  return out_->cutTo(out_->size() - dropped_bytes);
}

absl::Status MovieFile::complete(int64_t end_ns) {
  endSample(end_ns);
  absl::Status written = absl::FailedPreconditionError("no picture came, so no video is written");
  while (!written.ok() && !samples_.empty()) {
    written = out_->insertFront(textOf(makeMovieHead(*track_, tags_, samples_)));
    if (!written.ok()) VIEWLOOM_RETURN_IF_ERROR(dropLastChunk());
  }
  VIEWLOOM_RETURN_IF_ERROR(written);
  return out_->replace();
}

}  // namespace viewloom
