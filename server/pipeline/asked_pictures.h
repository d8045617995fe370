// SPDX-License-Identifier: Apache-2.0
// Pictures whose turn it is, and which wait for the newest frame of their stream to be built.
#pragma once

#include <algorithm>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class AskedPictures {
 public:
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

  // Keys of all pictures of the stream; they wait no longer.
  std::vector<std::string> takeAll(const std::string& stream) {
    std::vector<std::string> keys;
    std::lock_guard lock(mutex_);
    const auto [begin, end] = keys_.equal_range(stream);
    for (auto picture = begin; picture != end; ++picture) keys.push_back(picture->second);
    keys_.erase(begin, end);
    return keys;
  }

 private:
  std::mutex mutex_;
  std::multimap<std::string, std::string> keys_;  // by stream
};

}  // namespace viewloom
