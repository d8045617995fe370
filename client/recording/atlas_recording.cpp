// SPDX-License-Identifier: Apache-2.0
#include "recording/atlas_recording.h"

#include <string>
#include <utility>

#include "base/str_cat.h"
#include "lib/file_name_part.h"

namespace viewloom {

AtlasRecorder::AtlasRecorder(std::filesystem::path path, std::unique_ptr<RecordingWriter> writer,
                             const Clock& clock)
    : path_(std::move(path)), writer_(std::move(writer)), clock_(clock) {}

absl::StatusOr<std::unique_ptr<AtlasRecorder>> AtlasRecorder::create(
    const std::filesystem::path& path, const Clock& clock) {
  auto writer = RecordingWriter::create(path, RecordingKind::kAtlases);
  if (!writer.ok()) return writer.status();
  return std::unique_ptr<AtlasRecorder>(new AtlasRecorder(path, *std::move(writer), clock));
}

absl::Status AtlasRecorder::add(const v1::StreamAtlasesResponse& message) {
  if (message.message_case() == v1::StreamAtlasesResponse::MESSAGE_NOT_SET) {
    return absl::OkStatus();  // what a later server may say
  }
  const int64_t now_ns = clock_.nowNs();
  if (!start_ns_) start_ns_ = now_ns;
  VIEWLOOM_RETURN_IF_ERROR(writer_->add(now_ns - *start_ns_, message));
  if (message.has_header()) is_within_atlas_ = true;
  if (message.has_layout() || message.has_abandoned()) is_within_atlas_ = false;
  if (!message.has_end()) return absl::OkStatus();
  is_within_atlas_ = false;
  ++atlas_count_;
  writer_->markWhole();
  return absl::OkStatus();
}

std::string AtlasRecorder::summary() const {
  return strCat(path_.string(), ": ", atlas_count_, atlas_count_ == 1 ? " atlas" : " atlases",
                " recorded");
}

AtlasRecordingReader::AtlasRecordingReader(std::unique_ptr<RecordingReader> reader)
    : reader_(std::move(reader)) {}

absl::StatusOr<std::unique_ptr<AtlasRecordingReader>> AtlasRecordingReader::open(
    const std::filesystem::path& path) {
  auto reader = RecordingReader::open(path, RecordingKind::kAtlases);
  if (!reader.ok()) return reader.status();
  return std::unique_ptr<AtlasRecordingReader>(new AtlasRecordingReader(*std::move(reader)));
}

absl::StatusOr<std::optional<RecordedAtlas>> AtlasRecordingReader::next() {
  for (;;) {
    absl::StatusOr<std::optional<RecordedMessage>> message = reader_->next();
    if (!message.ok()) return message.status();
    if (!message->has_value()) return std::optional<RecordedAtlas>();
    v1::StreamAtlasesResponse response;
    if (!response.ParseFromString((*message)->bytes)) {
      return reader_->refuse("has a message that does not parse");
    }
    if (response.has_layout() && !isFileNamePart(response.layout().suffix())) {
      return reader_->refuse("has a suffix that is no part of a file name");
    }
    absl::StatusOr<std::optional<Atlas>> atlas = assembler_.add(std::move(response));
    if (!atlas.ok()) return reader_->refuse(std::string(atlas.status().message()));
    if (!atlas->has_value()) continue;
    return RecordedAtlas{.time_ns = (*message)->time_ns, .atlas = **std::move(atlas)};
  }
}

}  // namespace viewloom
