// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_assembly.h"

#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "base/thread_time.h"
#include "frame/limits.h"
#include "frame/plane_encoding.h"

namespace viewloom {
namespace {

void describeAsKept(PlaneFormat& plane) {
  if (!widensOnArrival(plane)) return;
  plane.encoding = PlaneEncoding::kRgba8;
  plane.stride_bytes = 0;
  plane.wire_bytes = decodedBytes(plane);
}

}  // namespace

std::vector<const PlaneFormat*> wirePlanes(const FrameFormat& format) {
  std::vector<const PlaneFormat*> planes;
  for (const SourceFormat& source : format.sources) {
    for (const LayerFormat& layer : source.layers) {
      planes.push_back(layer.depth_first ? &layer.depth : &layer.color);
      planes.push_back(layer.depth_first ? &layer.color : &layer.depth);
      for (const PlaneFormat& other : layer.others) planes.push_back(&other);
    }
  }
  return planes;
}

FrameAssembly::FrameAssembly(FrameFormat format, BytePool& pool, Reservation memory)
    : format_(std::move(format)),
      pool_(pool),
      memory_(std::move(memory)),
      declared_(wirePlanes(format_)) {
  planes_.reserve(declared_.size());
}

uint64_t FrameAssembly::collectedBytes() const {
  return arriving_ ? arriving_->collectedBytes() : 0;
}

absl::Status FrameAssembly::beginChunk(uint32_t plane_index, uint64_t offset_bytes,
                                       uint64_t size_bytes) {
  if (complete()) {
    return invalidField("chunk.plane_index", strCat("a chunk of plane ", plane_index,
                                                    " came after the last byte of frame ",
                                                    format_.number, "; accepted next is a header"));
  }
  if (plane_index != due_plane_) {
    return invalidField("chunk.plane_index",
                        strCat("a chunk of plane ", plane_index, " came; accepted next is plane ",
                               due_plane_, " (planes are 0..", declared_.size() - 1, ")"));
  }
  const PlaneFormat& plane = *declared_[due_plane_];
  if (offset_bytes != collectedBytes()) {
    return invalidField("chunk.offset_bytes",
                        strCat("a chunk begins at byte ", offset_bytes,
                               " of its plane; accepted next is byte ", collectedBytes()));
  }
  if (size_bytes == 0 || size_bytes > kChunkBytesMax) {
    return invalidField("chunk.data", strCat("a chunk has ", size_bytes, " bytes; accepted is 1..",
                                             kChunkBytesMax));
  }
  const uint64_t left_bytes = plane.wire_bytes - collectedBytes();
  if (size_bytes > left_bytes) {
    return invalidField("chunk.data",
                        strCat("a chunk has ", size_bytes, " bytes; accepted is up to ", left_bytes,
                               ", the rest of the plane of ", plane.wire_bytes));
  }
  if (!arriving_) arriving_.emplace(plane, pool_);
  awaited_bytes_ = size_bytes;
  chunk_begun_ns_ = threadTimeNs();
  return absl::OkStatus();
}

void FrameAssembly::append(std::span<const uint8_t> bytes) {
  VIEWLOOM_CHECK(bytes.size() <= awaited_bytes_);
  arriving_->append(bytes);
  awaited_bytes_ -= bytes.size();
  if (awaited_bytes_ == 0) arrival_ns_ += threadTimeNs() - chunk_begun_ns_;
  if (collectedBytes() < declared_[due_plane_]->wire_bytes) return;
  planes_.push_back(arriving_->take());
  arriving_.reset();
  ++due_plane_;
}

absl::Status FrameAssembly::addChunk(uint32_t plane_index, uint64_t offset_bytes,
                                     std::string_view data) {
  VIEWLOOM_RETURN_IF_ERROR(beginChunk(plane_index, offset_bytes, data.size()));
  append({reinterpret_cast<const uint8_t*>(data.data()), data.size()});
  return absl::OkStatus();
}

absl::Status FrameAssembly::requireComplete() const {
  if (complete()) return absl::OkStatus();
  return invalidField("header",
                      strCat("a header came before the end of frame ", format_.number, ": plane ",
                             due_plane_, " has ", collectedBytes(), " of ",
                             declared_[due_plane_]->wire_bytes, " bytes; send the rest first"));
}

CollectedFrame FrameAssembly::take() {
  VIEWLOOM_CHECK(complete());
  for (SourceFormat& source : format_.sources) {
    for (LayerFormat& layer : source.layers) {
      describeAsKept(layer.color);
      for (PlaneFormat& other : layer.others) describeAsKept(other);
    }
  }
  return {.format = std::move(format_),
          .planes = std::move(planes_),
          .memory = std::move(memory_),
          .arrival_ns = arrival_ns_};
}

}  // namespace viewloom
