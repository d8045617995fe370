// SPDX-License-Identifier: Apache-2.0
// Reads the records of a recording, complete or cut short.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "base/status.h"
#include "recording/recording_format.h"

namespace viewloom {

struct RecordedMessage {
  int64_t time_ns = 0;  // since the recording began; never less than that before
  std::string bytes;    // a message, serialised
};

// Foreign bytes: lengths are checked against their limit and the file before memory is taken.
// Thread-safety: none.
class RecordingReader {
 public:
  // NOT_FOUND, or INVALID_ARGUMENT when the file is none, or a recording of something else.
  static absl::StatusOr<std::unique_ptr<RecordingReader>> open(const std::filesystem::path& path,
                                                               RecordingKind kind);

  // Nothing at the end. INVALID_ARGUMENT with the place in the file for what no writer writes.
  absl::StatusOr<std::optional<RecordedMessage>> next();
  // Whether the end that next() came to is not that of a completed recording.
  bool isCutShort() const { return is_cut_short_; }
  // Bytes of the file behind what was read.
  uint64_t restBytes() const { return size_bytes_ - position_; }
  void rewind();

  // INVALID_ARGUMENT: "<file>: <problem> at byte <n>", of the message read last.
  absl::Status refuse(const std::string& problem) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  RecordingReader(std::filesystem::path path, uint64_t size_bytes);
  absl::Status readHead(RecordingKind kind);
  uint64_t readNumber(size_t byte_count);
  absl::Status cannotRead() const;

  const std::filesystem::path path_;
  const uint64_t size_bytes_;
  std::ifstream in_;
  uint64_t position_ = 0;
  uint64_t record_position_ = 0;
  int64_t last_time_ns_ = 0;
  bool is_cut_short_ = false;
  bool is_complete_ = false;
};

}  // namespace viewloom
