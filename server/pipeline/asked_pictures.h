// SPDX-License-Identifier: Apache-2.0
// Pictures whose turn it is, and which wait for the newest frame of their stream to be built.
#pragma once

#include <algorithm>
#include <map>
#include <mutex>
#include <string>

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class AskedPictures {
 public:
  using Keys = std::multimap<std::string, std::string>;  // by stream

  void add(const std::string& stream, const std::string& picture_key) {
    std::lock_guard lock(mutex_);
    keys_.emplace(stream, picture_key);
  }

  void remove(const std::string& stream, const std::string& picture_key) {
    std::lock_guard lock(mutex_);
    const auto [begin, end] = keys_.equal_range(stream);
    const auto found = std::find_if(
        begin, end, [&](const auto& picture) { return picture.second == picture_key; });
    if (found != end) keys_.erase(found);
  }

  // Stream and key of each picture of the stream; they wait no longer. Takes no memory: there may
  // be none, and they would wait for ever.
  Keys takeAll(const std::string& stream) {
    Keys taken;
    std::lock_guard lock(mutex_);
    for (auto picture = keys_.find(stream); picture != keys_.end(); picture = keys_.find(stream)) {
      taken.insert(keys_.extract(picture));
    }
    return taken;
  }

 private:
  std::mutex mutex_;
  Keys keys_;
};

}  // namespace viewloom
