// SPDX-License-Identifier: Apache-2.0
// The frames of a publisher, as they went over the wire, in a file and out of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "base/status.h"
#include "lib/wire_frame.h"
#include "recording/recording_reader.h"
#include "recording/recording_writer.h"

namespace viewloom {

// Thread-safety: none; one owner at a time.
class FrameRecorder {
 public:
  // The clock must outlive the recorder. Errors as RecordingWriter.
  static absl::StatusOr<std::unique_ptr<FrameRecorder>> create(const std::filesystem::path& path,
                                                               const Clock& clock);

  // A frame that goes now. One that goes a second time, under its number, is not kept again.
  absl::Status add(const WireFrame& frame);
  // The same as RecordingWriter::complete.
  absl::Status complete() { return writer_->complete(); }
  uint64_t frameCount() const { return frame_count_; }

 private:
  FrameRecorder(std::unique_ptr<RecordingWriter> writer, const Clock& clock);

  const std::unique_ptr<RecordingWriter> writer_;
  const Clock& clock_;
  std::optional<int64_t> start_ns_;  // when the first frame went
  uint64_t last_number_ = 0;
  uint64_t frame_count_ = 0;
};

struct RecordedFrame {
  int64_t time_ns = 0;  // when it went, since the first
  WireFrame frame;
};

// Thread-safety: none.
class FrameRecordingReader {
 public:
  // The same as RecordingReader::open.
  static absl::StatusOr<std::unique_ptr<FrameRecordingReader>> open(
      const std::filesystem::path& path);

  // Nothing after the last whole frame. INVALID_ARGUMENT for messages that make no frame.
  absl::StatusOr<std::optional<RecordedFrame>> next();
  // The same as in RecordingReader; a frame whose rest is missing is not given.
  bool isCutShort() const { return is_cut_short_ || reader_->isCutShort(); }
  void rewind();
  const std::filesystem::path& path() const { return reader_->path(); }

 private:
  explicit FrameRecordingReader(std::unique_ptr<RecordingReader> reader);
  absl::Status takeHeader(const RecordedMessage& message, RecordedFrame& frame);
  absl::Status takeChunk(const RecordedMessage& message, uint32_t plane, uint64_t plane_bytes,
                         std::vector<uint8_t>& bytes);

  const std::unique_ptr<RecordingReader> reader_;
  bool is_cut_short_ = false;  // within a frame
};

}  // namespace viewloom
