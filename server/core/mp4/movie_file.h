// SPDX-License-Identifier: Apache-2.0
// Writes an MP4 file of H.264 whose index stands before its pictures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/output_file.h"
#include "base/status.h"
#include "mp4/movie_head.h"

namespace viewloom {

// Without complete(), nothing is left behind, and an older file stays. Thread-safety: none.
class MovieFile {
 public:
  // Errors as OutputFile::create.
  static absl::StatusOr<std::unique_ptr<MovieFile>> create(const std::filesystem::path& path,
                                                           MovieTags tags);

  // A picture as an access unit in Annex B format. The first one needs its parameter sets. Times
  // are ns since the first picture, and grow. INVALID_ARGUMENT for bytes that do not belong to the
  // track, FAILED_PRECONDITION if the disk takes no more. A picture that fails is left out.
  absl::Status add(std::span<const uint8_t> access_unit, int64_t time_ns);
  // Ends the last picture at `end_ns`, writes the index, and moves the file to its place. A disk
  // without room for the index costs the last pictures. FAILED_PRECONDITION if there is no picture,
  // or the file cannot be written. Call once.
  absl::Status complete(int64_t end_ns);

  size_t pictureCount() const { return samples_.size(); }

 private:
  MovieFile(std::unique_ptr<OutputFile> out, MovieTags tags);
  // Adds the time until `time_ns` to the last sample.
  void endSample(int64_t time_ns);
  absl::Status dropLastChunk();

  const std::unique_ptr<OutputFile> out_;
  const MovieTags tags_;
  std::optional<AvcTrack> track_;  // from the first picture on
  std::vector<MovieSample> samples_;
  int64_t sample_begin_ns_ = 0;  // of the last one
};

}  // namespace viewloom
