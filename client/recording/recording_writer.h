// SPDX-License-Identifier: Apache-2.0
// Writes a recording beside its place, and puts it there when it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include <google/protobuf/message_lite.h>

#include "base/output_file.h"
#include "base/status.h"
#include "recording/recording_format.h"

namespace viewloom {

// Without complete(), nothing is left behind, and an older file stays. Thread-safety: none.
class RecordingWriter {
 public:
  // INVALID_ARGUMENT when the place cannot be written to.
  static absl::StatusOr<std::unique_ptr<RecordingWriter>> create(std::filesystem::path path,
                                                                 RecordingKind kind);
  // Expects a message that is not empty, and times that do not go back. FAILED_PRECONDITION when
  // the disk takes no more. INVALID_ARGUMENT for more than kRecordBytesMax: foreign numbers may
  // take more bytes here than on the wire.
  absl::Status add(int64_t time_ns, const google::protobuf::MessageLite& message);
  // The same of a serialised message: its beginning, and the bytes that follow.
  absl::Status add(int64_t time_ns, std::string_view head, std::span<const uint8_t> data);
  // Records added so far stay, whatever comes.
  void markWhole();
  // Drops what is not whole, ends the file and renames it, also after add() failed: what was whole
  // before is kept. FAILED_PRECONDITION when nothing is whole or the file cannot be renamed. Call
  // once.
  absl::Status complete();

 private:
  RecordingWriter(std::filesystem::path path, std::unique_ptr<OutputFile> out);

  const std::filesystem::path path_;
  const std::unique_ptr<OutputFile> out_;
  uint64_t whole_bytes_ = 0;  // 0 = nothing
  int64_t last_time_ns_ = 0;
};

}  // namespace viewloom
