// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sliced_bands.h"

#include <bit>
#include <utility>

namespace viewloom {
namespace {

SharedBytes joined(const std::vector<SharedBytes>& slices, BytePool& pool) {
  size_t size_bytes = 0;
  for (const SharedBytes& slice : slices) size_bytes += slice->size();
  // Sizes vary from frame to frame; powers of two let the pool's buffers settle after a few.
  BytePool::Buffer band = pool.take(std::bit_ceil(size_bytes));
  for (const SharedBytes& slice : slices) band->insert(band->end(), slice->begin(), slice->end());
  return band;
}

}  // namespace

SharedBytes SlicedBands::add(const Band& band, const Slice& slice, SharedBytes bytes,
                             BytePool& pool) {
  if (slice.count == 1) return bytes;
  std::vector<SharedBytes> slices;
  {
    std::lock_guard lock(mutex_);
    Slices& known = bands_[band];
    known.bytes.resize(slice.count);
    known.bytes[slice.index] = std::move(bytes);
    if (++known.packed_count < slice.count) return nullptr;
    slices = std::move(known.bytes);
    bands_.erase(band);
  }
  return joined(slices, pool);
}

}  // namespace viewloom
