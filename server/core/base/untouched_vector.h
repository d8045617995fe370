// SPDX-License-Identifier: Apache-2.0
// Vectors that take memory without touching it. A system hands out each page of a large piece of
// memory when it is first touched, and clears it, at some GB/s: a vector that clears its elements
// makes whoever resizes it pay for all of them at once, and then they are written once more.
#pragma once

#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace viewloom {

// Thread-safety: as std::allocator.
template <typename T>
struct UntouchedAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = UntouchedAllocator<U>;
  };

  UntouchedAllocator() = default;
  template <typename U>
  explicit(false) UntouchedAllocator(const UntouchedAllocator<U>&) {}

  // An element that is not given a value has any.
  template <typename U>
  void construct(U* at) {
    static_assert(std::is_trivially_default_constructible_v<U>);
    ::new (static_cast<void*>(at)) U;
  }
  template <typename U, typename... Values>
  void construct(U* at, Values&&... values) {
    ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
  }
};

// Elements that resize() adds have any value until they are written.
template <typename T>
using UntouchedVector = std::vector<T, UntouchedAllocator<T>>;

}  // namespace viewloom
