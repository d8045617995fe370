// SPDX-License-Identifier: Apache-2.0
// Pictures for tests of video: textures that move, and flat patches.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "video/video_picture.h"

namespace viewloom::test {

// A picture with samples of its own.
class SamplePicture {
 public:
  // Black. `size_px`: even.
  explicit SamplePicture(SizePx size_px)
      : size_px_(size_px),
        luma_(size_px.area(), 0),
        cb_(size_px.area() / 4, 128),
        cr_(size_px.area() / 4, 128) {}

  static SamplePicture flat(SizePx size_px, uint8_t y, uint8_t cb, uint8_t cr) {
    SamplePicture picture(size_px);
    picture.luma_.assign(picture.luma_.size(), y);
    picture.cb_.assign(picture.cb_.size(), cb);
    picture.cr_.assign(picture.cr_.size(), cr);
    return picture;
  }
  // A texture, moved to the right by so many px.
  static SamplePicture texture(SizePx size_px, double moved_px) {
    SamplePicture picture(size_px);
    const auto wave = [](double x, double y) {
      return uint8_t(std::lround(128 + 60 * std::sin(x / 7) + 50 * std::cos(y / 11 + x / 23)));
    };
    for (uint32_t y = 0; y < size_px.height; ++y) {
      for (uint32_t x = 0; x < size_px.width; ++x) picture.luma(x, y) = wave(x - moved_px, y);
    }
    for (uint32_t y = 0; y < size_px.height; y += 2) {
      for (uint32_t x = 0; x < size_px.width; x += 2) {
        picture.cb(x, y) = wave(x - moved_px, 1.5 * y);
        picture.cr(x, y) = wave(y, x - moved_px);
      }
    }
    return picture;
  }
  // Samples of 0 and 255 alone: nothing predicts them.
  static SamplePicture noise(SizePx size_px) {
    SamplePicture picture(size_px);
    std::mt19937 random(1);
    for (std::vector<uint8_t>* const plane : {&picture.luma_, &picture.cb_, &picture.cr_}) {
      for (uint8_t& code : *plane) code = random() % 2 == 0 ? 0 : 255;
    }
    return picture;
  }

  // Codes of a pixel. 2x2 pixels share those of chroma.
  uint8_t& luma(uint32_t x, uint32_t y) { return luma_[size_t{y} * size_px_.width + x]; }
  uint8_t& cb(uint32_t x, uint32_t y) { return cb_[chromaIndex(x, y)]; }
  uint8_t& cr(uint32_t x, uint32_t y) { return cr_[chromaIndex(x, y)]; }

  // Valid as long as this picture.
  VideoPicture video() const {
    return {.size_px = size_px_,
            .y = luma_.data(),
            .cb = cb_.data(),
            .cr = cr_.data(),
            .y_stride_bytes = size_px_.width,
            .chroma_stride_bytes = size_px_.width / 2};
  }

 private:
  size_t chromaIndex(uint32_t x, uint32_t y) const {
    return size_t{y / 2} * (size_px_.width / 2) + x / 2;
  }

  SizePx size_px_;
  std::vector<uint8_t> luma_;
  std::vector<uint8_t> cb_;
  std::vector<uint8_t> cr_;
};

// Mean squared error of luma, as PSNR in dB.
inline double psnrOfLuma(const VideoPicture& a, const VideoPicture& b) {
  double sum = 0;
  for (uint32_t y = 0; y < a.size_px.height; ++y) {
    for (uint32_t x = 0; x < a.size_px.width; ++x) {
      const double error =
          double{1} * a.y[y * a.y_stride_bytes + x] - b.y[y * b.y_stride_bytes + x];
      sum += error * error;
    }
  }
  return 10 * std::log10(255.0 * 255.0 * double(a.size_px.area()) / sum);
}

}  // namespace viewloom::test
