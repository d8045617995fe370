// SPDX-License-Identifier: Apache-2.0
#include "files/exr_image.h"

#include <Imath/half.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfRgbaYca.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "base/str_cat.h"
#include "files/exr_description.h"
#include "files/exr_open.h"
#include "files/exr_plane_reader.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

constexpr size_t kPixelBytes = 8;  // of RGBA16F

// The channels behind the names: all there and all of one part.
absl::StatusOr<std::vector<ExrChannel>> findAll(const std::string& path,
                                                const Imf::MultiPartInputFile& file,
                                                std::span<const std::string> names) {
  std::vector<ExrChannel> channels;
  for (const std::string& name : names) {
    std::optional<ExrChannel> channel = findExrChannel(file, name);
    if (!channel) {
      return refuseFile(
          path, strCat("has no channel ", name, "; it has ", listExrChannels(describeExr(file))));
    }
    if (!channels.empty() && channel->part != channels.front().part) {
      return refuseFile(path, strCat("channels ", names.front(), " and ", name,
                                     " are of different parts; accepted is one part"));
    }
    channels.push_back(*std::move(channel));
  }
  return channels;
}

absl::Status refuseSubsampled(const std::string& path, std::span<const ExrChannel> channels) {
  for (const ExrChannel& channel : channels) {
    if (!channel.isSubsampled()) continue;
    return refuseFile(
        path, strCat("channel ", channel.name, " is subsampled; accepted is full resolution"));
  }
  return absl::OkStatus();
}

ExrWindow displayWindow(const Imf::Header& header) {
  const auto& box = header.displayWindow();
  return {box.min.x, box.min.y, box.max.x, box.max.y};
}

// A plane of the window's size that is filled with the sample.
absl::StatusOr<PlaneImage> emptyPlane(const std::string& path, const ExrWindow& window,
                                      std::span<const uint8_t> pixel) {
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(path, window.width(), window.height()));
  PlaneImage image;
  image.width_px = static_cast<uint32_t>(window.width());
  image.height_px = static_cast<uint32_t>(window.height());
  image.bytes.resize(pixel.size() * image.width_px * image.height_px);
  const bool is_zero = std::all_of(pixel.begin(), pixel.end(), [](uint8_t b) { return b == 0; });
  for (size_t at = 0; !is_zero && at < image.bytes.size(); at += pixel.size()) {
    std::copy(pixel.begin(), pixel.end(), &image.bytes[at]);
  }
  return image;
}

std::vector<std::string> namesOf(std::span<const ExrChannel> channels) {
  std::vector<std::string> names;
  for (const ExrChannel& channel : channels) names.push_back(channel.name);
  return names;
}

uint16_t finiteHalf(uint16_t bits) {
  const auto magnitude = static_cast<uint16_t>(bits & 0x7FFF);
  if (magnitude < 0x7C00) return bits;
  if (magnitude > 0x7C00) return 0;
  return static_cast<uint16_t>((bits & 0x8000) | 0x7BFF);
}

// Calls take(rgba, x, y) with the four halves of every px that lies in the data window.
template <typename Take>
void forEachPixel(const ExrWindow& window, const Imath::Box2i& data, std::vector<uint8_t>& bytes,
                  const Take& take) {
  size_t at = 0;
  for (int y = window.min_y; y <= window.max_y; ++y) {
    for (int x = window.min_x; x <= window.max_x; ++x, at += kPixelBytes) {
      if (!data.intersects(Imath::V2i(x, y))) continue;
      uint16_t rgba[4];
      std::memcpy(rgba, &bytes[at], kPixelBytes);
      take(rgba, x, y);
      for (uint16_t& sample : rgba) sample = finiteHalf(sample);
      std::memcpy(&bytes[at], rgba, kPixelBytes);
    }
  }
}

bool isLumaChroma(std::span<const ExrChannel> channels) {
  return channels.size() >= 3 && channels[1].name.ends_with("RY") &&
         channels[2].name.ends_with("BY");
}

// Y, RY and BY of every px become R, G and B.
class ChromaReader {
 public:
  ChromaReader(Imf::MultiPartInputFile& file, std::span<const ExrChannel> channels)
      : y_(file, channels[0]), ry_(file, channels[1]), by_(file, channels[2]) {
    const Imf::Header& header = file.header(channels[0].part);
    weights_ = Imf::RgbaYca::computeYw(Imf::hasChromaticities(header) ? Imf::chromaticities(header)
                                                                      : Imf::Chromaticities());
  }

  void put(uint16_t* rgba, int x, int y) const {
    const float luminance = y_.at(x, y);
    const float red = (ry_.at(x, y) + 1) * luminance;
    const float blue = (by_.at(x, y) + 1) * luminance;
    const float green = (luminance - red * weights_.x - blue * weights_.z) / weights_.y;
    rgba[0] = Imath::half(red).bits();
    rgba[1] = Imath::half(green).bits();
    rgba[2] = Imath::half(blue).bits();
  }

 private:
  ExrSubsampledChannel y_, ry_, by_;
  Imath::V3f weights_;
};

absl::StatusOr<PlaneImage> readColorPlane(const std::string& path, Imf::MultiPartInputFile& file,
                                          std::span<const ExrChannel> channels,
                                          const ExrWindow& window) {
  const uint8_t nothing[kPixelBytes] = {};
  absl::StatusOr<PlaneImage> image = emptyPlane(path, window, nothing);
  if (!image.ok()) return image;
  const bool has_chroma = isLumaChroma(channels);
  const std::span<const ExrChannel> alpha = channels.size() == 4 ? channels.subspan(3) : channels;
  VIEWLOOM_RETURN_IF_ERROR(refuseSubsampled(path, has_chroma ? alpha.subspan(0, 1) : channels));
  const int part = channels.front().part;
  std::vector<std::string> names = namesOf(channels);
  if (has_chroma) names[0] = names[1] = names[2] = "";
  ExrPlaneReader(file, part, window, Imf::HALF, 4).readInto(image->bytes, names);
  const Imath::Box2i data = file.header(part).dataWindow();
  std::optional<ChromaReader> chroma;
  if (has_chroma) chroma.emplace(file, channels);
  forEachPixel(window, data, image->bytes, [&](uint16_t* rgba, int x, int y) {
    if (channels.size() == 1) rgba[1] = rgba[2] = rgba[0];
    if (channels.size() < 4) rgba[3] = Imath::half(1.0F).bits();
    if (chroma) chroma->put(rgba, x, y);
  });
  return image;
}

// The first of the samples of every px, all of which have to agree.
absl::StatusOr<PlaneImage> readAgreeing(const std::string& path, Imf::MultiPartInputFile& file,
                                        std::span<const ExrChannel> channels,
                                        const ExrWindow& window, Imf::PixelType type, float fill) {
  const size_t sample_bytes = type == Imf::HALF ? 2 : 4;
  std::vector<uint8_t> pixel;
  for (size_t i = 0; i < channels.size(); ++i) {
    const uint16_t half = Imath::half(fill).bits();
    const auto* from = type == Imf::HALF ? reinterpret_cast<const uint8_t*>(&half)
                                         : reinterpret_cast<const uint8_t*>(&fill);
    pixel.insert(pixel.end(), from, from + sample_bytes);
  }
  absl::StatusOr<PlaneImage> image = emptyPlane(path, window, pixel);
  if (!image.ok()) return image;
  ExrPlaneReader(file, channels.front().part, window, type, channels.size())
      .readInto(image->bytes, namesOf(channels));
  if (channels.size() == 1) return image;
  std::vector<uint8_t> bytes(image->bytes.size() / channels.size());
  for (size_t at = 0; at < bytes.size(); at += sample_bytes) {
    const uint8_t* const samples = &image->bytes[at * channels.size()];
    for (size_t i = 1; i < channels.size(); ++i) {
      if (std::memcmp(samples, samples + i * sample_bytes, sample_bytes) == 0) continue;
      return refuseFile(
          path, strCat("holds no depth for sure: ", channels[0].name, " and ", channels[i].name,
                       " differ; name its channel with --depth-channel"));
    }
    std::memcpy(&bytes[at], samples, sample_bytes);
  }
  image->bytes = std::move(bytes);
  return image;
}

std::string guarded(const std::exception& error, const std::string& path) {
  return strCat(path, ": ", error.what());
}

}  // namespace

absl::StatusOr<PlaneImage> readExrColor(const std::filesystem::path& path,
                                        std::span<const std::string> channels,
                                        const std::optional<ExrWindow>& window) {
  auto file = openExr(path);
  if (!file.ok()) return file.status();
  try {
    const ExrDescription description = describeExr(**file);
    const std::vector<std::string> usual = usualExrChannels(description, "").color;
    const std::span<const std::string> names = channels.empty() ? usual : channels;
    if (names.size() != 1 && names.size() != 3 && names.size() != 4) {
      return refuseFile(path.string(),
                        strCat("no colour in ", names.size(),
                               " channels; accepted are 1, 3 or 4, by default R, G, B, A or "
                               "Y; name others with --color-channels; it has ",
                               listExrChannels(description)));
    }
    const auto found = findAll(path.string(), **file, names);
    if (!found.ok()) return found.status();
    const Imf::Header& header = (*file)->header(found->front().part);
    absl::StatusOr<PlaneImage> image =
        readColorPlane(path.string(), **file, *found, window.value_or(displayWindow(header)));
    if (!image.ok()) return image;
    image->encoding = v1::PLANE_ENCODING_RGBA16F;
    image->has_alpha = names.size() == 4;
    image->is_premultiplied = image->has_alpha;
    if (Imf::hasChromaticities(header)) image->chromaticities = Imf::chromaticities(header);
    return image;
  } catch (const std::exception& error) {
    return absl::DataLossError(guarded(error, path.string()));
  }
}

absl::StatusOr<PlaneImage> readExrDepth(const std::filesystem::path& path,
                                        std::span<const std::string> channels,
                                        const std::optional<ExrWindow>& window, float fill) {
  auto file = openExr(path);
  if (!file.ok()) return file.status();
  try {
    const ExrDescription description = describeExr(**file);
    const std::vector<std::string> usual = usualExrChannels(description, "").depth;
    const std::span<const std::string> names = channels.empty() ? usual : channels;
    if (names.empty()) {
      return refuseFile(path.string(), strCat("no depth in 0 channels; accepted is one, by "
                                              "default Z; name another with "
                                              "--depth-channel; it has ",
                                              listExrChannels(description)));
    }
    const auto found = findAll(path.string(), **file, names);
    if (!found.ok()) return found.status();
    VIEWLOOM_RETURN_IF_ERROR(refuseSubsampled(path.string(), *found));
    const Imf::Header& header = (*file)->header(found->front().part);
    const Imf::PixelType type = found->front().type == Imf::HALF ? Imf::HALF : Imf::FLOAT;
    absl::StatusOr<PlaneImage> image = readAgreeing(
        path.string(), **file, *found, window.value_or(displayWindow(header)), type, fill);
    if (!image.ok()) return image;
    image->encoding =
        type == Imf::HALF ? v1::PLANE_ENCODING_DEPTH_F16 : v1::PLANE_ENCODING_DEPTH_F32;
    return image;
  } catch (const std::exception& error) {
    return absl::DataLossError(guarded(error, path.string()));
  }
}

absl::StatusOr<ExrViewChannels> exrChannelsOfView(const std::filesystem::path& path,
                                                  const std::string& view) {
  const absl::StatusOr<ExrDescription> description = describeExr(path);
  if (!description.ok()) return description.status();
  const absl::StatusOr<std::string> found = exrView(*description, view);
  if (!found.ok()) return refuseFile(path.string(), std::string(found.status().message()));
  return usualExrChannels(*description, *found);
}

}  // namespace viewloom::files
