// SPDX-License-Identifier: Apache-2.0
#include "recording/atlas_recording.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/str_cat.h"
#include "lib/file_name_part.h"

namespace viewloom {
namespace {

constexpr uint32_t kSideMax_px = 16384;  // as display.proto

// The sentence that is wrong with it, or nothing. Sizes in 64 bits: the products of foreign ones
// fit.
std::string problemOf(const v1::AtlasLayout& layout) {
  const uint64_t width = layout.size().width();
  const uint64_t height = layout.size().height();
  if (std::min(width, height) == 0 || std::max(width, height) > kSideMax_px) {
    return strCat("has an atlas of ", width, "x", height, " px, accepted are 1..", kSideMax_px,
                  " a side,");
  }
  const bool has_room =
      uint64_t{layout.columns()} * layout.tile_size().width() <= width &&
      uint64_t{layout.rows()} * layout.tile_size().height() + layout.padding_top_px() <= height &&
      layout.view_count() <= uint64_t{layout.columns()} * layout.rows();
  if (!has_room) return "has an atlas without room for its views";
  if (layout.image_count() > height) return "has an atlas of more images than it has rows";
  if (!isFileNamePart(layout.suffix())) return "has a suffix that is no part of a file name";
  return "";
}

}  // namespace

AtlasRecorder::AtlasRecorder(std::unique_ptr<RecordingWriter> writer, const Clock& clock)
    : writer_(std::move(writer)), clock_(clock) {}

absl::StatusOr<std::unique_ptr<AtlasRecorder>> AtlasRecorder::create(
    const std::filesystem::path& path, const Clock& clock) {
  auto writer = RecordingWriter::create(path, RecordingKind::kAtlases);
  if (!writer.ok()) return writer.status();
  return std::unique_ptr<AtlasRecorder>(new AtlasRecorder(*std::move(writer), clock));
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
    if (response.has_layout()) {
      if (std::string problem = problemOf(response.layout()); !problem.empty()) {
        return reader_->refuse(problem);
      }
    }
    absl::StatusOr<std::optional<Atlas>> atlas = assembler_.add(std::move(response));
    if (!atlas.ok()) return reader_->refuse(std::string(atlas.status().message()));
    if (!atlas->has_value()) continue;
    return RecordedAtlas{.time_ns = (*message)->time_ns, .atlas = **std::move(atlas)};
  }
}

}  // namespace viewloom
