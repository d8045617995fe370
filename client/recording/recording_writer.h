// SPDX-License-Identifier: Apache-2.0
// Writes a recording beside its place, and puts it there when it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>

#include <google/protobuf/message_lite.h>

#include "base/status.h"
#include "recording/recording_format.h"

namespace viewloom {

// Without complete(), nothing is left behind, and an older file stays. Thread-safety: none.
class RecordingWriter {
 public:
  // FAILED_PRECONDITION when the place cannot be written to.
  static absl::StatusOr<std::unique_ptr<RecordingWriter>> create(std::filesystem::path path,
                                                                 RecordingKind kind);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // Expects a message that is not empty, and times that do not go back. FAILED_PRECONDITION when
  // the disk takes no more.
  absl::Status add(int64_t time_ns, const google::protobuf::MessageLite& message);
  // What was added so far stays whatever comes.
  void markWhole();
  // Drops what is not whole, ends the file and renames it. FAILED_PRECONDITION when nothing is
  // whole, or as add(). Call once.
  absl::Status complete();

 private:
  explicit RecordingWriter(std::filesystem::path path);
  absl::Status failed() const;
  void writeNumber(uint64_t number, size_t byte_count);

  const std::filesystem::path path_;
  const std::filesystem::path partial_path_;
  std::ofstream out_;
  uint64_t bytes_ = 0;
  uint64_t whole_bytes_ = 0;  // 0 = nothing
  int64_t last_time_ns_ = 0;
};

}  // namespace viewloom
