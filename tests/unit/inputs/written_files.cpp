// SPDX-License-Identifier: Apache-2.0
#include "unit/inputs/written_files.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "inspect/depth_samples.h"

namespace viewloom::test {

void writeExr(const std::filesystem::path& path, int width_px, int height_px,
              const std::vector<WrittenChannel>& channels,
              const std::function<void(Imf::Header&)>& edit) {
  Imf::Header header(width_px, height_px);
  Imf::FrameBuffer buffer;
  std::vector<std::vector<uint8_t>> planes;
  for (const WrittenChannel& channel : channels) {
    header.channels().insert(channel.name, Imf::Channel(channel.type));
    const size_t bytes = channel.type == Imf::HALF ? 2 : 4;
    std::vector<uint8_t>& plane = planes.emplace_back();
    for (int y = 0; y < height_px; ++y) {
      for (int x = 0; x < width_px; ++x) {
        const float value = channel.value(x, y);
        const uint16_t half = Imath::half(value).bits();
        const void* from = channel.type == Imf::HALF ? static_cast<const void*>(&half) : &value;
        plane.resize(plane.size() + bytes);
        std::memcpy(&plane[plane.size() - bytes], from, bytes);
      }
    }
    buffer.insert(channel.name, Imf::Slice::Make(channel.type, plane.data(), Imath::V2i(0, 0),
                                                 width_px, height_px));
  }
  edit(header);
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(height_px);
}

void writePng(const std::filesystem::path& path, uint32_t width_px, uint32_t height_px,
              uint32_t channels, uint32_t bits, const std::vector<uint16_t>& samples) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) throw std::runtime_error("no file");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, width_px, height_px, static_cast<int>(bits),
               channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (uint32_t y = 0; y < height_px; ++y) {
    std::vector<uint8_t> row;
    for (uint32_t i = 0; i < width_px * channels; ++i) {
      const uint16_t sample = samples[size_t{y} * width_px * channels + i];
      if (bits == 16) row.push_back(static_cast<uint8_t>(sample >> 8));
      row.push_back(static_cast<uint8_t>(sample));
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

void writeJpeg(const std::filesystem::path& path, int width_px, int height_px,
               const std::vector<uint8_t>& rgb) {
  tjhandle handle = tjInitCompress();
  unsigned char* out = nullptr;
  unsigned long size = 0;
  ASSERT_EQ(tjCompress2(handle, rgb.data(), width_px, 0, height_px, TJPF_RGB, &out, &size,
                        TJSAMP_444, 98, 0),
            0);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<char*>(out), static_cast<std::streamsize>(size));
  tjFree(out);
  tjDestroy(handle);
}

inputs::ReadInput readInput(const inputs::InputSettings& settings,
                            const inputs::InputFiles& files) {
  auto read = inputs::InputReader(settings).read(files);
  EXPECT_TRUE(read.ok()) << read.status();
  if (!read.ok()) throw std::runtime_error("cannot be read");
  return *std::move(read);
}

double depthAt(const inputs::ReadInput& read, uint32_t x, uint32_t y) {
  const WireFrame& frame = read.frame.wire;
  const v1::Source& source = frame.header.sources(0);
  const auto samples =
      inspect::readDepthSamples(source.layers(0).planes(1), *frame.planes[1], source.camera());
  EXPECT_TRUE(samples.ok()) << samples.status();
  if (!samples.ok()) return std::numeric_limits<double>::quiet_NaN();
  const float inv_z = samples->inv_z[size_t{y} * samples->width_px + x];
  return inv_z < 0 ? std::numeric_limits<double>::quiet_NaN() : 1 / double{inv_z};
}

std::string refusalOf(const inputs::InputSettings& settings, const inputs::InputFiles& files) {
  const auto read = inputs::InputReader(settings).read(files);
  return read.ok() ? "OK" : std::string(read.status().message());
}

}  // namespace viewloom::test
