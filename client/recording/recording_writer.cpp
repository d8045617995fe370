// SPDX-License-Identifier: Apache-2.0
#include "recording/recording_writer.h"

#include <string>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "base/check.h"

namespace viewloom {

RecordingWriter::RecordingWriter(std::filesystem::path path)
    : path_(std::move(path)),
      partial_path_(path_.string() + ".part"),
      out_(partial_path_, std::ios::binary | std::ios::trunc) {}

RecordingWriter::~RecordingWriter() {
  if (!out_.is_open()) return;
  out_.close();
  std::error_code ignored;
  std::filesystem::remove(partial_path_, ignored);
}

absl::StatusOr<std::unique_ptr<RecordingWriter>> RecordingWriter::create(std::filesystem::path path,
                                                                         RecordingKind kind) {
  std::unique_ptr<RecordingWriter> writer(new RecordingWriter(std::move(path)));
  writer->out_.write(kRecordingMagic.data(), kRecordingMagic.size());
  writer->writeNumber(kRecordingVersion, sizeof(uint32_t));
  writer->writeNumber(static_cast<uint32_t>(kind), sizeof(uint32_t));
  writer->bytes_ = kRecordingHeadBytes;
  if (!writer->out_.flush()) return writer->failed();
  return writer;
}

absl::Status RecordingWriter::failed() const {
  return absl::FailedPreconditionError(absl::StrCat(
      partial_path_.string(), ": cannot be written; its folder must exist and have room"));
}

void RecordingWriter::writeNumber(uint64_t number, size_t byte_count) {
  for (size_t i = 0; i < byte_count; ++i) out_.put(static_cast<char>(number >> (8 * i)));
}

absl::Status RecordingWriter::add(int64_t time_ns, const google::protobuf::MessageLite& message) {
  const std::string bytes = message.SerializeAsString();
  VIEWLOOM_CHECK(!bytes.empty() && bytes.size() <= kRecordBytesMax);
  VIEWLOOM_CHECK(time_ns >= last_time_ns_);
  last_time_ns_ = time_ns;
  writeNumber(static_cast<uint64_t>(time_ns), sizeof(time_ns));
  writeNumber(bytes.size(), sizeof(uint32_t));
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out_) return failed();
  bytes_ += kRecordHeadBytes + bytes.size();
  return absl::OkStatus();
}

void RecordingWriter::markWhole() {
  whole_bytes_ = bytes_;
}

absl::Status RecordingWriter::complete() {
  if (whole_bytes_ == 0) {
    return absl::FailedPreconditionError(
        absl::StrCat(path_.string(), ": is not written, as nothing whole came to be recorded"));
  }
  out_.seekp(static_cast<std::streamoff>(whole_bytes_));
  writeNumber(static_cast<uint64_t>(last_time_ns_), sizeof(last_time_ns_));
  writeNumber(0, sizeof(uint32_t));
  if (!out_.flush()) return failed();
  std::error_code error;
  std::filesystem::resize_file(partial_path_, whole_bytes_ + kRecordHeadBytes, error);
  if (!error) std::filesystem::rename(partial_path_, path_, error);
  if (error)
    return absl::FailedPreconditionError(absl::StrCat(path_.string(), ": ", error.message()));
  out_.close();
  return absl::OkStatus();
}

}  // namespace viewloom
