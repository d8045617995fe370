// SPDX-License-Identifier: Apache-2.0
#include "recording/recording_writer.h"

#include <utility>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

void appendNumber(std::string& bytes, uint64_t number, size_t byte_count) {
  for (size_t i = 0; i < byte_count; ++i) bytes += static_cast<char>(number >> (8 * i));
}

std::string recordHead(int64_t time_ns, size_t message_bytes) {
  std::string head;
  appendNumber(head, static_cast<uint64_t>(time_ns), sizeof(time_ns));
  appendNumber(head, message_bytes, sizeof(uint32_t));
  return head;
}

}  // namespace

RecordingWriter::RecordingWriter(std::filesystem::path path, std::unique_ptr<OutputFile> out)
    : path_(std::move(path)), out_(std::move(out)) {}

absl::StatusOr<std::unique_ptr<RecordingWriter>> RecordingWriter::create(std::filesystem::path path,
                                                                         RecordingKind kind) {
  auto out = OutputFile::create(path);
  if (!out.ok()) return out.status();
  std::string head(kRecordingMagic.data(), kRecordingMagic.size());
  appendNumber(head, kRecordingVersion, sizeof(uint32_t));
  appendNumber(head, static_cast<uint32_t>(kind), sizeof(uint32_t));
  VIEWLOOM_RETURN_IF_ERROR((*out)->write(head));
  return std::unique_ptr<RecordingWriter>(new RecordingWriter(std::move(path), *std::move(out)));
}

absl::Status RecordingWriter::add(int64_t time_ns, const google::protobuf::MessageLite& message) {
  return add(time_ns, message.SerializeAsString(), {});
}

absl::Status RecordingWriter::add(int64_t time_ns, std::string_view head,
                                  std::span<const uint8_t> data) {
  const size_t byte_count = head.size() + data.size();
  VIEWLOOM_CHECK(byte_count > 0);
  if (byte_count > kRecordBytesMax) {
    return absl::InvalidArgumentError(strCat("a message of ", byte_count,
                                             " bytes cannot be recorded; accepted are up to ",
                                             kRecordBytesMax));
  }
  VIEWLOOM_CHECK(time_ns >= last_time_ns_);
  absl::Status written = out_->write(recordHead(time_ns, byte_count));
  if (written.ok()) written = out_->write(head);
  if (written.ok()) {
    written = out_->write({reinterpret_cast<const char*>(data.data()), data.size()});
  }
  if (written.ok()) last_time_ns_ = time_ns;
  if (written.ok() || whole_bytes_ == 0) return written;
  return absl::FailedPreconditionError(
      strCat(written.message(), "; the recording ends here and keeps what came before"));
}

void RecordingWriter::markWhole() {
  whole_bytes_ = out_->size();
}

absl::Status RecordingWriter::complete() {
  if (whole_bytes_ == 0) {
    return absl::FailedPreconditionError(
        strCat(path_.string(), ": is not written, as nothing whole came to be recorded"));
  }
  VIEWLOOM_RETURN_IF_ERROR(out_->cutTo(whole_bytes_));
  const absl::Status ended = out_->write(recordHead(last_time_ns_, 0));
  // A disk without room for the end has room for the rest: readers say that it is cut short.
  if (!ended.ok()) VIEWLOOM_RETURN_IF_ERROR(out_->cutTo(whole_bytes_));
  return out_->replace();
}

}  // namespace viewloom
