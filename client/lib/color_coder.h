// SPDX-License-Identifier: Apache-2.0
// Codes the colour of frames as H.264, for slow links.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "frame/size.h"
#include "lib/color_video.h"
#include "lib/wire_frame.h"
#include "video/video_encoder.h"

namespace viewloom {

// Keeps encoders from frame to frame. Thread-safety: none; one thread at a time.
class ColorCoder {
 public:
  explicit ColorCoder(const ColorVideo& options);
  ~ColorCoder();
  ColorCoder(const ColorCoder&) = delete;
  ColorCoder& operator=(const ColorCoder&) = delete;

  // Replaces colour planes by H.264 that decodes alone (proto PLANE_ENCODING_H264). Colour of
  // pixels without surface is not kept. Some planes stay as they are: linear colour, colour with an
  // alpha that counts, JPEG, compressed planes, sides of less than 16 px, small planes, planes that
  // would grow, and planes for which memory is missing.
  void code(WireFrame& frame);

 private:
  struct Converter;

  void codeLayer(const v1::Source& source, v1::Layer& layer, std::span<SharedBytes> planes);
  std::vector<uint8_t> coded(const v1::Plane& plane, const uint8_t* pixels, size_t stride_bytes);
  VideoEncoder* encoderOf(SizePx size_px);

  const ColorVideo options_;
  const uint32_t thread_count_;
  const std::unique_ptr<Converter> converter_;
  std::vector<std::unique_ptr<VideoEncoder>> encoders_;  // newest last
  std::vector<uint8_t> filled_;                          // scratch: colours of a plane
};

}  // namespace viewloom
