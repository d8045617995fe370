// SPDX-License-Identifier: Apache-2.0
// Samples that tell their channel and place, to write into EXR files.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPixelType.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace viewloom::files {

// Sample of a channel at a pixel of the display: tells channel and place apart.
inline float sampleAt(size_t channel, int x, int y) {
  return static_cast<float>(channel * 100) + static_cast<float>(x) + 0.125F * static_cast<float>(y);
}

struct Channels {
  std::vector<std::string> names;
  Imf::PixelType type = Imf::HALF;
};

// The samples of one part over its data window.
class PartSamples {
 public:
  PartSamples(const Imath::Box2i& data, Channels channels)
      : data_(data), channels_(std::move(channels)) {
    const size_t count = static_cast<size_t>(width()) * static_cast<size_t>(height());
    for (size_t channel = 0; channel < channels_.names.size(); ++channel) {
      std::vector<uint8_t>& bytes = bytes_.emplace_back(count * sampleBytes());
      for (int y = data.min.y; y <= data.max.y; ++y) {
        for (int x = data.min.x; x <= data.max.x; ++x) put(bytes, x, y, sampleAt(channel, x, y));
      }
    }
  }

  int width() const { return data_.max.x - data_.min.x + 1; }
  int height() const { return data_.max.y - data_.min.y + 1; }

  Imf::FrameBuffer frameBuffer() const {
    Imf::FrameBuffer buffer;
    for (size_t i = 0; i < channels_.names.size(); ++i) {
      buffer.insert(channels_.names[i], Imf::Slice::Make(channels_.type, bytes_[i].data(),
                                                         data_.min, width(), height()));
    }
    return buffer;
  }

  Imf::Header header(const Imath::Box2i& display) const {
    Imf::Header header(display, data_);
    for (const std::string& name : channels_.names) {
      header.channels().insert(name, Imf::Channel(channels_.type));
    }
    return header;
  }

 private:
  size_t sampleBytes() const { return channels_.type == Imf::HALF ? 2 : 4; }
  void put(std::vector<uint8_t>& bytes, int x, int y, float value) const {
    const auto index = static_cast<size_t>((y - data_.min.y) * width() + x - data_.min.x);
    const uint16_t half_bits = Imath::half(value).bits();
    const void* from = channels_.type == Imf::HALF ? static_cast<const void*>(&half_bits) : &value;
    std::memcpy(&bytes[index * sampleBytes()], from, sampleBytes());
  }

  Imath::Box2i data_;
  Channels channels_;
  std::vector<std::vector<uint8_t>> bytes_;
};

}  // namespace viewloom::files
