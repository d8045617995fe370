// SPDX-License-Identifier: Apache-2.0
#include "jpeg/jpeg_memory.h"

#include <algorithm>
#include <bit>
#include <new>

#include <jerror.h>

namespace viewloom {
namespace {

// libjpeg-turbo's SIMD code reads and writes whole 32-byte vectors.
constexpr size_t kAlignment_bytes = 32;
// The commonest band, 3360 px wide in 4:2:0, needs about 220 KiB.
constexpr size_t kBlock_bytes = size_t{256} * 1024;

size_t roundedUp(size_t size_bytes) {
  return (size_bytes + kAlignment_bytes - 1) / kAlignment_bytes * kAlignment_bytes;
}

}  // namespace

JpegMemory::JpegMemory(j_common_ptr object) : original_(*object->mem) {
  object->client_data = this;
  object->mem->alloc_small = allocate;
  object->mem->alloc_large = allocate;
  object->mem->alloc_sarray = allocateRows;
  object->mem->free_pool = freePool;
}

JpegMemory& JpegMemory::of(j_common_ptr object) {
  return *static_cast<JpegMemory*>(object->client_data);
}

void* JpegMemory::allocate(j_common_ptr object, int pool, size_t size_bytes) {
  JpegMemory& memory = of(object);
  if (pool == JPOOL_IMAGE) return memory.takeOrFail(object, size_bytes);
  return memory.original_.alloc_small(object, pool, size_bytes);
}

JSAMPARRAY JpegMemory::allocateRows(j_common_ptr object, int pool, JDIMENSION samples_per_row,
                                    JDIMENSION row_count) {
  JpegMemory& memory = of(object);
  if (pool != JPOOL_IMAGE) {
    return memory.original_.alloc_sarray(object, pool, samples_per_row, row_count);
  }
  auto* rows = static_cast<JSAMPARRAY>(memory.takeOrFail(object, row_count * sizeof(JSAMPROW)));
  // A pair of vectors may start in the last sample of a row.
  const size_t stride_bytes = roundedUp(samples_per_row) + 2 * kAlignment_bytes;
  auto* samples = static_cast<JSAMPROW>(memory.takeOrFail(object, row_count * stride_bytes));
  for (JDIMENSION i = 0; i < row_count; ++i) rows[i] = samples + i * stride_bytes;
  return rows;
}

void JpegMemory::freePool(j_common_ptr object, int pool) {
  JpegMemory& memory = of(object);
  memory.original_.free_pool(object, pool);
  if (pool != JPOOL_IMAGE) return;
  memory.block_index_ = 0;
  memory.used_bytes_ = 0;
}

// libjpeg is C: it is left by its own error exit, and never by an exception.
void* JpegMemory::takeOrFail(j_common_ptr object, size_t size_bytes) {
  void* const taken = take(size_bytes);
  if (taken == nullptr) ERREXIT1(object, JERR_OUT_OF_MEMORY, 0);
  return taken;
}

void* JpegMemory::take(size_t size_bytes) {
  const size_t wanted_bytes = roundedUp(size_bytes);
  while (block_index_ < blocks_.size() &&
         blocks_[block_index_].size_bytes - used_bytes_ < wanted_bytes) {
    ++block_index_;
    used_bytes_ = 0;
  }
  if (block_index_ == blocks_.size()) {
    // A power of two, so that images of slightly different widths share their blocks.
    const size_t block_bytes = std::max(kBlock_bytes, std::bit_ceil(wanted_bytes));
    if (!addBlock(block_bytes)) return nullptr;
  }
  uint8_t* start = blocks_[block_index_].bytes.get();
  start += roundedUp(reinterpret_cast<uintptr_t>(start)) - reinterpret_cast<uintptr_t>(start);
  uint8_t* taken = start + used_bytes_;
  used_bytes_ += wanted_bytes;
  return taken;
}

bool JpegMemory::addBlock(size_t block_bytes) {
  try {
    blocks_.push_back({std::make_unique<uint8_t[]>(block_bytes + kAlignment_bytes), block_bytes});
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

}  // namespace viewloom
