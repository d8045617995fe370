// SPDX-License-Identifier: Apache-2.0
#include "structure/cut_recording.h"

#include <algorithm>

namespace viewloom {
namespace {

// Calls record(offset, size_bytes) for one piece of the bytes after the other.
template <typename Record>
void inPieces(CutRecording& recording, uint64_t size_bytes, const Record& record) {
  for (uint64_t done = 0; done < size_bytes;) {
    const uint64_t left = size_bytes - done;
    const uint64_t units = (left + BuiltPx::kCopiedBytes - 1) / BuiltPx::kCopiedBytes;
    const uint64_t taken = recording.takeRows(BuildPass::kCopy, 1, units);
    const uint64_t piece_bytes = std::min(taken * BuiltPx::kCopiedBytes, left);
    record(done, piece_bytes);
    done += piece_bytes;
  }
}

}  // namespace

uint64_t CutRecording::takeRows(BuildPass pass, uint64_t row_px_count, uint64_t row_count) {
  if (!go_on_) return row_count;
  double row_ns = costs_->nsPerPx(pass) * double(row_px_count);
  double left_ns = double(piece_ns_ - costs_->predictNs(recorded_));
  if (row_ns > left_ns && !recorded_.isEmpty()) {
    cut();
    row_ns = costs_->nsPerPx(pass) * double(row_px_count);  // as it is known by now
    left_ns = double(piece_ns_);
  }
  const double fitting = std::clamp(left_ns / row_ns, 1.0, double(row_count));
  const auto rows = uint64_t(fitting);
  recorded_.add(pass, rows * row_px_count);
  return rows;
}

bool CutRecording::isLong(BuildPass pass, uint64_t px_count) const {
  return go_on_ && costs_->nsPerPx(pass) * double(px_count) > double(piece_ns_);
}

void CutRecording::cut() {
  if (!go_on_) return;
  commands_ = go_on_(recorded_);
  recorded_ = {};
}

void recordCopy(CutRecording& recording, const Buffer& from, const Buffer& to,
                const CopiedBytes& bytes) {
  inPieces(recording, bytes.size_bytes, [&](uint64_t done, uint64_t piece_bytes) {
    recording.commands().copy(from, to,
                              {.from_offset = bytes.from_offset + done,
                               .to_offset = bytes.to_offset + done,
                               .size_bytes = piece_bytes});
  });
}

void recordFill(CutRecording& recording, const Buffer& target, uint64_t offset, uint64_t size_bytes,
                uint32_t word) {
  inPieces(recording, size_bytes, [&](uint64_t done, uint64_t piece_bytes) {
    recording.commands().fill(target, offset + done, piece_bytes, word);
  });
}

}  // namespace viewloom
