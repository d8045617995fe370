// SPDX-License-Identifier: Apache-2.0
#include "recording/recording_reader.h"

#include <system_error>
#include <utility>

#include "base/str_cat.h"

namespace viewloom {

RecordingReader::RecordingReader(std::filesystem::path path, uint64_t size_bytes)
    : path_(std::move(path)), size_bytes_(size_bytes), in_(path_, std::ios::binary) {}

absl::StatusOr<std::unique_ptr<RecordingReader>> RecordingReader::open(
    const std::filesystem::path& path, RecordingKind kind) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return absl::NotFoundError(strCat(path.string(), ": no such file"));
  }
  const uint64_t size_bytes = std::filesystem::file_size(path, error);
  if (error) return absl::NotFoundError(strCat(path.string(), ": ", error.message()));
  std::unique_ptr<RecordingReader> reader(new RecordingReader(path, size_bytes));
  VIEWLOOM_RETURN_IF_ERROR(reader->readHead(kind));
  return reader;
}

absl::Status RecordingReader::readHead(RecordingKind kind) {
  std::array<char, kRecordingMagic.size()> magic{};
  in_.read(magic.data(), magic.size());
  const uint64_t version = readNumber(sizeof(uint32_t));
  const uint64_t found = readNumber(sizeof(uint32_t));
  if (!in_ || magic != kRecordingMagic) {
    return absl::InvalidArgumentError(
        strCat(path_.string(),
               ": is no recording; accepted is what `viewloom record` or `viewloom publish "
               "--record` wrote"));
  }
  if (version != kRecordingVersion) {
    return absl::InvalidArgumentError(strCat(path_.string(), ": is a recording of version ",
                                             version, "; accepted is ", kRecordingVersion));
  }
  position_ = kRecordingHeadBytes;
  if (found == static_cast<uint32_t>(kind)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      strCat(path_.string(), ": is a recording of ",
             kind == RecordingKind::kFrames
                 ? "atlases; `viewloom watch --from` takes it, accepted are frames"
                 : "frames; `viewloom publish --replay` takes it, accepted are "
                   "atlases"));
}

uint64_t RecordingReader::readNumber(size_t byte_count) {
  uint64_t number = 0;
  for (size_t i = 0; i < byte_count; ++i) {
    number |= uint64_t{static_cast<uint8_t>(in_.get())} << (8 * i);
  }
  return number;
}

absl::Status RecordingReader::cannotRead() const {
  return absl::DataLossError(strCat(path_.string(), ": cannot be read"));
}

absl::Status RecordingReader::refuse(const std::string& problem) const {
  return absl::InvalidArgumentError(
      strCat(path_.string(), ": ", problem, " at byte ", record_position_));
}

absl::StatusOr<std::optional<RecordedMessage>> RecordingReader::next() {
  if (is_complete_ || is_cut_short_) return std::optional<RecordedMessage>();
  record_position_ = position_;
  is_cut_short_ = restBytes() < kRecordHeadBytes;
  if (is_cut_short_) return std::optional<RecordedMessage>();
  RecordedMessage message;
  message.time_ns = static_cast<int64_t>(readNumber(sizeof(message.time_ns)));
  const uint64_t length = readNumber(sizeof(uint32_t));
  if (!in_) return cannotRead();
  position_ += kRecordHeadBytes;
  if (message.time_ns < last_time_ns_) {
    return refuse(strCat("has the time ", message.time_ns, " ns after ", last_time_ns_));
  }
  last_time_ns_ = message.time_ns;
  if (length > kRecordBytesMax) {
    return refuse(
        strCat("has a message of ", length, " bytes, accepted are up to ", kRecordBytesMax, ","));
  }
  if (length == 0) {
    if (restBytes() > 0) return refuse(strCat("has ", restBytes(), " bytes after its end"));
    is_complete_ = true;
    return std::optional<RecordedMessage>();
  }
  is_cut_short_ = restBytes() < length;
  if (is_cut_short_) return std::optional<RecordedMessage>();
  message.bytes.resize(length);
  in_.read(message.bytes.data(), static_cast<std::streamsize>(length));
  if (!in_) return cannotRead();
  position_ += length;
  return std::optional<RecordedMessage>(std::move(message));
}

void RecordingReader::rewind() {
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(kRecordingHeadBytes));
  position_ = kRecordingHeadBytes;
  last_time_ns_ = 0;
  is_cut_short_ = false;
  is_complete_ = false;
}

}  // namespace viewloom
