// SPDX-License-Identifier: Apache-2.0
// A picture on the graphics card, top row first.
#pragma once

#include <cstdint>
#include <span>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom::show {

// Thread-safety: main thread, with the context that it was made in.
class GlTexture {
 public:
  GlTexture();
  ~GlTexture();
  GlTexture(const GlTexture&) = delete;
  GlTexture& operator=(const GlTexture&) = delete;

  // samples: uint8_t[height_px][width_px][channels], packed; channels: 3 RGB, 4 RGBA. Codes stay as
  // they are. RESOURCE_EXHAUSTED when the card takes no picture of this size.
  absl::Status upload(SizePx size_px, uint32_t channels, std::span<const uint8_t> samples);
  void bind() const;
  SizePx sizePx() const { return size_px_; }

 private:
  uint32_t texture_ = 0;
  SizePx size_px_;
  uint32_t channels_ = 0;
};

}  // namespace viewloom::show
