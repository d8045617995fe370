// SPDX-License-Identifier: Apache-2.0
// Video whose quality adapts, in atlases without a picture, and readers of known speed.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include "unit/publish/watcher.h"

namespace viewloom::test {

inline constexpr EncodingSpec kAdapting = {
    .color = BandEncoding::kH264, .video_qp = 24, .video_qp_max = 40};
// A display takes 1 MB/s at its finest.
inline constexpr int64_t kAtlasesApart_ns = 100'000'000;
inline uint64_t adaptedBytes(uint32_t qp) {
  return uint64_t(100'000 * std::pow(0.68, (double(qp) - 24) / 4));
}

// Takes the next atlas once its socket has the last one.
struct PacedReader {
  SubscriptionPtr place;
  double bytes_per_ms = 0;  // 0 = as fast as they come
  int64_t free_ns = 0;

  void offer(uint64_t atlas_bytes, int64_t now_ns) {
    if (free_ns > now_ns) return;
    const double busy_ms = bytes_per_ms == 0 ? 0 : double(atlas_bytes) / bytes_per_ms;
    free_ns = now_ns + int64_t(busy_ms * 1e6);
    place->beginWrite(atlas_bytes, now_ns);
    place->endAtlas(free_ns);
  }
};

// An atlas of every display of the stream, as the pipeline codes them: its bytes, by display.
inline std::map<uint64_t, uint64_t> codeAtlases(const Broadcaster& broadcaster,
                                                const std::string& stream, int64_t now_ns,
                                                int64_t coding_ns) {
  std::map<uint64_t, uint64_t> bytes;
  for (const ActiveDisplayPtr& display : broadcaster.displays(stream)) {
    const uint32_t qp = display->coding->beginAtlas(now_ns);
    bytes[display->id] = adaptedBytes(qp);
    display->coding->noteCoded(qp, adaptedBytes(qp));
    display->coding->noteCodingTime(coding_ns);
  }
  return bytes;
}

}  // namespace viewloom::test
