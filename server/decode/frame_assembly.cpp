// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_assembly.h"

#include <cstring>
#include <utility>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {

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
    : format_(std::move(format)), pool_(pool), memory_(std::move(memory)) {
  for (const PlaneFormat* plane : wirePlanes(format_)) plane_bytes_.push_back(plane->wire_bytes);
  planes_.reserve(plane_bytes_.size());
}

absl::StatusOr<std::span<uint8_t>> FrameAssembly::beginChunk(uint32_t plane_index,
                                                             uint64_t offset_bytes,
                                                             uint64_t size_bytes) {
  if (complete()) {
    return invalidField("chunk.plane_index", strCat("a chunk of plane ", plane_index,
                                                    " came after the last byte of frame ",
                                                    format_.number, "; accepted next is a header"));
  }
  if (plane_index != current_plane_) {
    return invalidField("chunk.plane_index",
                        strCat("a chunk of plane ", plane_index, " came; accepted next is plane ",
                               current_plane_, " (planes are 0..", plane_bytes_.size() - 1, ")"));
  }
  const uint64_t declared_bytes = plane_bytes_[current_plane_];
  if (offset_bytes != collected_bytes_) {
    return invalidField("chunk.offset_bytes",
                        strCat("a chunk begins at byte ", offset_bytes,
                               " of its plane; accepted next is byte ", collected_bytes_));
  }
  if (size_bytes == 0 || size_bytes > kChunkBytesMax) {
    return invalidField("chunk.data", strCat("a chunk has ", size_bytes, " bytes; accepted is 1..",
                                             kChunkBytesMax));
  }
  if (size_bytes > declared_bytes - collected_bytes_) {
    return invalidField(
        "chunk.data",
        strCat("a chunk has ", size_bytes, " bytes; accepted is up to ",
               declared_bytes - collected_bytes_, ", the rest of the plane of ", declared_bytes));
  }
  if (!filling_) filling_ = pool_.takeUncleared(declared_bytes);
  begun_bytes_ = size_bytes;
  if (const uint64_t end = collected_bytes_ + size_bytes; filling_->size() < end) {
    filling_->resize(end);
  }
  return std::span<uint8_t>(*filling_).subspan(collected_bytes_, size_bytes);
}

void FrameAssembly::endChunk() {
  VIEWLOOM_CHECK(begun_bytes_ > 0);
  collected_bytes_ += std::exchange(begun_bytes_, 0);
  if (collected_bytes_ < plane_bytes_[current_plane_]) return;
  filling_->resize(std::exchange(collected_bytes_, 0));
  planes_.push_back(std::exchange(filling_, nullptr));
  ++current_plane_;
}

absl::Status FrameAssembly::addChunk(uint32_t plane_index, uint64_t offset_bytes,
                                     std::string_view data) {
  const auto place = beginChunk(plane_index, offset_bytes, data.size());
  if (!place.ok()) return place.status();
  std::memcpy(place->data(), data.data(), data.size());
  endChunk();
  return absl::OkStatus();
}

absl::Status FrameAssembly::requireComplete() const {
  if (complete()) return absl::OkStatus();
  return invalidField("header",
                      strCat("a header came before the end of frame ", format_.number, ": plane ",
                             current_plane_, " has ", collected_bytes_, " of ",
                             plane_bytes_[current_plane_], " bytes; send the rest first"));
}

CollectedFrame FrameAssembly::take() {
  VIEWLOOM_CHECK(complete());
  return {.format = std::move(format_), .planes = std::move(planes_), .memory = std::move(memory_)};
}

}  // namespace viewloom
