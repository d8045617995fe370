// SPDX-License-Identifier: Apache-2.0
// Planes packed with zstd: one frame that inflates to what was declared, never to more.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/status.h"

struct ZSTD_DCtx_s;

namespace viewloom {

// Keeps its working memory from plane to plane. Thread-safety: none; one per thread.
class ZstdInflater {
 public:
  ZstdInflater();

  // Bytes the zstd frame holds, by its header, before anything is allocated for them. `expected` is
  // what the plane needs; a header that leaves its size open is taken to mean that.
  static absl::StatusOr<uint64_t> contentBytes(std::span<const uint8_t> wire, uint64_t expected);
  // The same for content without a fixed size (JPEG): it must be in the header and <= bytes_max.
  static absl::StatusOr<uint64_t> contentBytesUpTo(std::span<const uint8_t> wire,
                                                   uint64_t bytes_max);

  // `out` becomes the content, exactly content_bytes long.
  absl::Status inflate(std::span<const uint8_t> wire, uint64_t content_bytes,
                       std::vector<uint8_t>& out);

 private:
  struct FreeContext {
    void operator()(ZSTD_DCtx_s* context) const;
  };
  std::unique_ptr<ZSTD_DCtx_s, FreeContext> context_;
};

}  // namespace viewloom
