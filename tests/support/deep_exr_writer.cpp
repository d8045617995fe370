// SPDX-License-Identifier: Apache-2.0
#include "support/deep_exr_writer.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfDeepTiledOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTileDescription.h>

#include <cstdint>
#include <cstring>

namespace viewloom::test {
namespace {

float valueOf(const deep::DeepSample& sample, const std::string& channel) {
  if (channel == "R") return sample.color.r;
  if (channel == "G") return sample.color.g;
  if (channel == "B") return sample.color.b;
  if (channel == "A") return sample.alpha;
  if (channel == "Z") return sample.z_m;
  return channel == "ZBack" ? sample.z_back_m : 0;
}

// Samples of one channel as OpenEXR wants them: a pointer a pixel.
struct ChannelSamples {
  std::vector<std::vector<uint32_t>> values;  // as bits, with room for any type
  std::vector<char*> pointers;
};

ChannelSamples samplesOf(const DeepPicture& picture, const std::string& name, Imf::PixelType type) {
  ChannelSamples samples;
  for (const DeepPixel& pixel : picture.pixels) {
    std::vector<uint32_t>& values = samples.values.emplace_back();
    for (const deep::DeepSample& sample : pixel) {
      const float value = valueOf(sample, name);
      const uint16_t half_bits = Imath::half(value).bits();
      uint32_t& bits = values.emplace_back(0);
      if (type == Imf::UINT) bits = static_cast<uint32_t>(value);
      if (type == Imf::HALF) std::memcpy(&bits, &half_bits, 2);
      if (type == Imf::FLOAT) std::memcpy(&bits, &value, 4);
    }
  }
  for (auto& values : samples.values) {
    samples.pointers.push_back(reinterpret_cast<char*>(values.data()));
  }
  return samples;
}

Imf::Header headerOf(const DeepPicture& picture, const DeepFileOptions& options) {
  Imf::Header header(picture.display, picture.data);
  header.compression() = options.compression;
  header.setType(options.tile_side_px > 0 ? Imf::DEEPTILE : Imf::DEEPSCANLINE);
  header.setName("deep");
  if (options.chromaticities) Imf::addChromaticities(header, *options.chromaticities);
  if (options.tile_side_px > 0) {
    const auto side = static_cast<unsigned>(options.tile_side_px);
    header.setTileDescription(Imf::TileDescription(
        side, side, options.has_mip_levels ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL));
  }
  std::map<std::string, Imf::PixelType> types = options.types;
  for (const char* name : {"R", "G", "B", "A", "Z"}) types.try_emplace(name, Imf::FLOAT);
  if (options.has_back) types.try_emplace("ZBack", Imf::FLOAT);
  for (const auto& [name, type] : types) header.channels().insert(name, Imf::Channel(type));
  return header;
}

void writeFlatPart(Imf::MultiPartOutputFile& file, const Imath::Box2i& data) {
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  const std::vector<float> zeros(static_cast<size_t>(width) * static_cast<size_t>(height));
  Imf::FrameBuffer buffer;
  buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, zeros.data(), data.min, width, height));
  Imf::OutputPart part(file, 0);
  part.setFrameBuffer(buffer);
  part.writePixels(height);
}

}  // namespace

void writeDeepExr(const std::filesystem::path& path, const DeepPicture& picture,
                  const DeepFileOptions& options) {
  std::vector<Imf::Header> headers;
  if (options.is_second_part) {
    Imf::Header& flat = headers.emplace_back(picture.display, picture.data);
    flat.channels().insert("R", Imf::Channel(Imf::FLOAT));
    flat.setType(Imf::SCANLINEIMAGE);
    flat.setName("flat");
  }
  headers.push_back(headerOf(picture, options));
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  if (options.is_second_part) writeFlatPart(file, picture.data);

  const int width = picture.data.max.x - picture.data.min.x + 1;
  const int height = picture.data.max.y - picture.data.min.y + 1;
  // OpenEXR adds x * stride + y * stride of the file's coordinates.
  const std::ptrdiff_t origin = picture.data.min.x + std::ptrdiff_t{picture.data.min.y} * width;
  const auto stride = static_cast<size_t>(width);
  Imf::DeepFrameBuffer buffer;
  std::vector<uint32_t> counts;
  for (const DeepPixel& pixel : picture.pixels) {
    counts.push_back(static_cast<uint32_t>(pixel.size()));
  }
  buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT,
                                           reinterpret_cast<char*>(counts.data() - origin),
                                           sizeof(uint32_t), sizeof(uint32_t) * stride));
  std::map<std::string, ChannelSamples> samples;
  const Imf::ChannelList& channels = headers.back().channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    ChannelSamples& of = samples[it.name()] = samplesOf(picture, it.name(), it.channel().type);
    buffer.insert(
        it.name(),
        Imf::DeepSlice(it.channel().type, reinterpret_cast<char*>(of.pointers.data() - origin),
                       sizeof(char*), sizeof(char*) * stride, sizeof(uint32_t)));
  }
  const int part_index = options.is_second_part ? 1 : 0;
  if (options.tile_side_px == 0) {
    Imf::DeepScanLineOutputPart part(file, part_index);
    part.setFrameBuffer(buffer);
    part.writePixels(height);
    return;
  }
  Imf::DeepTiledOutputPart part(file, part_index);
  part.setFrameBuffer(buffer);
  // Smaller levels get the same samples; nobody reads them.
  for (int level = 0; level < part.numLevels(); ++level) {
    part.writeTiles(0, part.numXTiles(level) - 1, 0, part.numYTiles(level) - 1, level);
  }
}

}  // namespace viewloom::test
