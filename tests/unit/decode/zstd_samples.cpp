// SPDX-License-Identifier: Apache-2.0
#include "unit/decode/zstd_samples.h"

#include <zstd.h>

#include <gtest/gtest.h>

namespace viewloom {

std::vector<uint8_t> zstdFrame(const std::vector<uint8_t>& content, ZstdSize size) {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, size == ZstdSize::kStated);
  std::vector<uint8_t> frame(ZSTD_compressBound(content.size()));
  const size_t count =
      ZSTD_compress2(context, frame.data(), frame.size(), content.data(), content.size());
  EXPECT_FALSE(ZSTD_isError(count));
  ZSTD_freeCCtx(context);
  frame.resize(count);
  return frame;
}

}  // namespace viewloom
