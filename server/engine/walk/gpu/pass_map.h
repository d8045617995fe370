// SPDX-License-Identifier: Apache-2.0
// Compiled kernels by what they are specialised to.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "gpu/compute_pass.h"

namespace viewloom {

// Kernels that somebody needs and nobody has compiled yet, each once, by its place in a PassMap.
// Each call compiles one, on any thread.
using MissingKernels = std::map<const void*, std::function<void()>>;

// Passes of one kernel, by variant. Each is compiled once, by the first thread that asks for it;
// only threads that need the same variant wait for that. The device must outlive it.
// Thread-safety: all methods may be called from any thread.
template <typename Variant, typename Pass = ComputePass>
class PassMap {
 public:
  using Make = Pass (*)(const Device& device, const Variant& variant);

  PassMap(const Device& device, Make make) : device_(device), make_(make) {}

  const Pass& get(const Variant& variant) {
    Entry& entry = find(variant);
    std::call_once(entry.once, [&] {
      entry.pass.emplace(make_(device_, variant));
      entry.is_made = true;
    });
    return *entry.pass;
  }

  // Adds the variant's pass, unless it is compiled.
  void addMissing(const Variant& variant, MissingKernels& missing) {
    const Entry& entry = find(variant);
    if (!entry.is_made) missing.try_emplace(&entry, [this, variant] { get(variant); });
  }

 private:
  struct Entry {
    std::once_flag once;
    std::atomic<bool> is_made = false;
    std::optional<Pass> pass;
  };

  Entry& find(const Variant& variant) {
    std::lock_guard lock(mutex_);
    return entries_[variant];  // entries of a map stay where they are
  }

  const Device& device_;
  const Make make_;
  std::mutex mutex_;  // guards the map, not its entries
  std::map<Variant, Entry> entries_;
};

// Pass of a kernel that has no variants.
using SinglePass = PassMap<std::monostate>;

}  // namespace viewloom
