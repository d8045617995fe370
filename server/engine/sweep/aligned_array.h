// SPDX-License-Identifier: Apache-2.0
// Memory that vectors load whole: aligned, and never cleared or copied when it grows.
#pragma once

#include <hwy/aligned_allocator.h>
#include <cstddef>
#include <new>

namespace viewloom {

// Thread-safety: none.
template <typename T>
class AlignedArray {
 public:
  // Forgets what it held, unless it is large enough already.
  void reserve(size_t count) {
    if (count <= count_) return;
    values_ = hwy::AllocateAligned<T>(count);
    if (!values_) throw std::bad_alloc();
    count_ = count;
  }

  T* data() { return values_.get(); }
  const T* data() const { return values_.get(); }
  T& operator[](size_t index) { return values_[index]; }
  const T& operator[](size_t index) const { return values_[index]; }
  size_t sizeBytes() const { return count_ * sizeof(T); }

 private:
  hwy::AlignedFreeUniquePtr<T[]> values_;
  size_t count_ = 0;
};

}  // namespace viewloom
