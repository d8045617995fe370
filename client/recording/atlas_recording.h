// SPDX-License-Identifier: Apache-2.0
// The atlases of a subscriber, written to a file and read back.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "base/status.h"
#include "lib/atlas_assembler.h"
#include "recording/atlas_target.h"
#include "recording/recording_reader.h"
#include "recording/recording_writer.h"

namespace viewloom {

// Thread-safety: none; one owner at a time.
class AtlasRecorder final : public AtlasTarget {
 public:
  // The clock must outlive the recorder. Errors as RecordingWriter.
  static absl::StatusOr<std::unique_ptr<AtlasRecorder>> create(const std::filesystem::path& path,
                                                               const Clock& clock);

  // A message that comes now. What begins and does not end is in the file only when something whole
  // follows it; readers discard it as displays do.
  absl::Status add(const v1::StreamAtlasesResponse& message) override;
  bool isWithinAtlas() const override { return is_within_atlas_; }
  // The same as RecordingWriter::complete.
  absl::Status complete() override { return writer_->complete(); }
  std::string summary() const override;
  uint64_t atlasCount() const { return atlas_count_; }

 private:
  AtlasRecorder(std::filesystem::path path, std::unique_ptr<RecordingWriter> writer,
                const Clock& clock);

  const std::filesystem::path path_;
  const std::unique_ptr<RecordingWriter> writer_;
  const Clock& clock_;
  std::optional<int64_t> start_ns_;  // when the first message came
  bool is_within_atlas_ = false;
  uint64_t atlas_count_ = 0;
};

struct RecordedAtlas {
  int64_t time_ns = 0;  // when its end came, since the recording began
  Atlas atlas;
};

// Thread-safety: none.
class AtlasRecordingReader {
 public:
  // The same as RecordingReader::open.
  static absl::StatusOr<std::unique_ptr<AtlasRecordingReader>> open(
      const std::filesystem::path& path);

  // Nothing after the last whole atlas. INVALID_ARGUMENT for messages that make no atlas, and for
  // layouts that do not add up: those given can be cut into views and named after their suffix.
  absl::StatusOr<std::optional<RecordedAtlas>> next();
  // The same as in RecordingReader.
  bool isCutShort() const { return reader_->isCutShort(); }
  const std::filesystem::path& path() const { return reader_->path(); }

 private:
  explicit AtlasRecordingReader(std::unique_ptr<RecordingReader> reader);

  const std::unique_ptr<RecordingReader> reader_;
  AtlasAssembler assembler_;
};

}  // namespace viewloom
