// SPDX-License-Identifier: Apache-2.0
#include "files/exr_image.h"

#include <Imath/half.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "absl/strings/str_cat.h"
#include "files/exr_channels.h"
#include "files/exr_open.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

// Rows read at once where a file has to be cropped: bounds the memory beside the plane itself.
constexpr int kRowsAtOnce = 64;

struct PixelBox {
  int begin_x, begin_y, end_x, end_y;  // end exclusive
};

// Reads one part into a plane of interleaved samples; every channel has the same sample type.
class PlaneReader {
 public:
  PlaneReader(Imf::MultiPartInputFile& file, int part, Imf::PixelType type, size_t plane_channels)
      : part_(file, part),
        type_(type),
        sample_bytes_(type == Imf::HALF ? 2 : 4),
        pixel_bytes_(sample_bytes_ * plane_channels) {
    const auto& display = part_.header().displayWindow();
    const auto& data = part_.header().dataWindow();
    origin_x_ = display.min.x;
    origin_y_ = display.min.y;
    width_px_ = int64_t{display.max.x} - display.min.x + 1;
    height_px_ = int64_t{display.max.y} - display.min.y + 1;
    data_begin_x_ = data.min.x;
    data_width_px_ = data.max.x - data.min.x + 1;
    visible_ = {std::max(data.min.x, display.min.x), std::max(data.min.y, display.min.y),
                std::min(data.max.x, display.max.x) + 1, std::min(data.max.y, display.max.y) + 1};
  }

  int64_t width() const { return width_px_; }
  int64_t height() const { return height_px_; }

  // names[i] goes to the i-th sample of each pixel. The plane has zeros wherever the file has
  // nothing.
  void readInto(std::vector<uint8_t>& plane, std::span<const std::string> names) {
    if (visible_.begin_x >= visible_.end_x) return;
    const size_t row_bytes = pixel_bytes_ * static_cast<size_t>(data_width_px_);
    std::vector<uint8_t> rows(row_bytes * kRowsAtOnce);
    for (int y = visible_.begin_y; y < visible_.end_y; y += kRowsAtOnce) {
      const int end_y = std::min(y + kRowsAtOnce, visible_.end_y);
      readRows(y, end_y, rows, names);
      for (int row = y; row < end_y; ++row) {
        copyRow(row, &rows[row_bytes * static_cast<size_t>(row - y)], plane);
      }
    }
  }

 private:
  void readRows(int begin_y, int end_y, std::vector<uint8_t>& rows,
                std::span<const std::string> names) {
    Imf::FrameBuffer frame_buffer;
    for (size_t i = 0; i < names.size(); ++i) {
      frame_buffer.insert(
          names[i],
          Imf::Slice::Make(type_, &rows[i * sample_bytes_], Imath::V2i(data_begin_x_, begin_y),
                           data_width_px_, end_y - begin_y, pixel_bytes_,
                           pixel_bytes_ * static_cast<size_t>(data_width_px_)));
    }
    part_.setFrameBuffer(frame_buffer);
    part_.readPixels(begin_y, end_y - 1);
  }

  void copyRow(int y, const uint8_t* row, std::vector<uint8_t>& plane) const {
    const auto skipped = static_cast<size_t>(visible_.begin_x - data_begin_x_);
    const auto x = static_cast<size_t>(visible_.begin_x - origin_x_);
    const auto plane_row = static_cast<size_t>(y - origin_y_) * static_cast<size_t>(width_px_);
    std::memcpy(&plane[(plane_row + x) * pixel_bytes_], row + skipped * pixel_bytes_,
                static_cast<size_t>(visible_.end_x - visible_.begin_x) * pixel_bytes_);
  }

  Imf::InputPart part_;
  Imf::PixelType type_;
  size_t sample_bytes_;
  size_t pixel_bytes_;
  int origin_x_ = 0, origin_y_ = 0;  // of the display window
  int64_t width_px_ = 0, height_px_ = 0;
  int data_begin_x_ = 0, data_width_px_ = 0;
  PixelBox visible_{};
};

// The channels behind the names: all there, all of one part, none subsampled.
absl::StatusOr<std::vector<ExrChannel>> findAll(const std::string& path,
                                                const Imf::MultiPartInputFile& file,
                                                std::span<const std::string> names) {
  std::vector<ExrChannel> channels;
  for (const std::string& name : names) {
    std::optional<ExrChannel> channel = findExrChannel(file, name);
    if (!channel) {
      return refuseFile(path,
                        absl::StrCat("has no channel ", name, "; it has ", listExrChannels(file)));
    }
    if (channel->subsampled) {
      return refuseFile(
          path, absl::StrCat("channel ", name, " is subsampled; accepted is full resolution"));
    }
    if (!channels.empty() && channel->part != channels.front().part) {
      return refuseFile(path, absl::StrCat("channels ", names.front(), " and ", name,
                                           " are of different parts; accepted is one part"));
    }
    channels.push_back(*std::move(channel));
  }
  return channels;
}

absl::StatusOr<PlaneImage> readPlane(const std::string& path, Imf::MultiPartInputFile& file,
                                     std::span<const ExrChannel> channels, Imf::PixelType type,
                                     size_t plane_channels) {
  try {
    PlaneReader reader(file, channels.front().part, type, plane_channels);
    VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(path, reader.width(), reader.height()));
    PlaneImage image;
    image.width_px = static_cast<uint32_t>(reader.width());
    image.height_px = static_cast<uint32_t>(reader.height());
    const size_t sample_bytes = type == Imf::HALF ? 2 : 4;
    image.bytes.resize(sample_bytes * plane_channels * image.width_px * image.height_px);
    std::vector<std::string> names;
    for (const ExrChannel& channel : channels) names.push_back(channel.name);
    reader.readInto(image.bytes, names);
    return image;
  } catch (const std::exception& error) {
    return absl::DataLossError(absl::StrCat(path, ": ", error.what()));
  }
}

uint16_t finiteHalf(uint16_t bits) {
  const auto magnitude = static_cast<uint16_t>(bits & 0x7FFF);
  if (magnitude < 0x7C00) return bits;
  if (magnitude > 0x7C00) return 0;
  return static_cast<uint16_t>((bits & 0x8000) | 0x7BFF);
}

// Spreads grey, fills in alpha where the file has none, makes all samples finite.
void completeRgba(std::vector<uint8_t>& bytes, size_t channel_count) {
  for (size_t at = 0; at < bytes.size(); at += 8) {
    uint16_t rgba[4];
    std::memcpy(rgba, &bytes[at], 8);
    if (channel_count == 1) rgba[1] = rgba[2] = rgba[0];
    if (channel_count < 4) rgba[3] = Imath::half(1.0F).bits();
    for (uint16_t& sample : rgba) sample = finiteHalf(sample);
    std::memcpy(&bytes[at], rgba, 8);
  }
}

}  // namespace

absl::StatusOr<PlaneImage> readExrColor(const std::filesystem::path& path,
                                        std::span<const std::string> channels) {
  auto file = openExr(path);
  if (!file.ok()) return file.status();
  const std::vector<std::string> usual = usualExrChannels(**file, "").color;
  const std::span<const std::string> names = channels.empty() ? usual : channels;
  if (names.size() != 1 && names.size() != 3 && names.size() != 4) {
    return refuseFile(path.string(),
                      absl::StrCat("no colour in ", names.size(),
                                   " channels; accepted are 1, 3 or 4, by default R, G, B, A or "
                                   "Y; it has ",
                                   listExrChannels(**file)));
  }
  const auto found = findAll(path.string(), **file, names);
  if (!found.ok()) return found.status();
  absl::StatusOr<PlaneImage> image = readPlane(path.string(), **file, *found, Imf::HALF, 4);
  if (!image.ok()) return image;
  image->encoding = v1::PLANE_ENCODING_RGBA16F;
  image->has_alpha = names.size() == 4;
  image->is_premultiplied = image->has_alpha;
  completeRgba(image->bytes, names.size());
  const Imf::Header& header = (*file)->header(found->front().part);
  if (Imf::hasChromaticities(header)) image->chromaticities = Imf::chromaticities(header);
  return image;
}

absl::StatusOr<PlaneImage> readExrDepth(const std::filesystem::path& path,
                                        std::span<const std::string> channels) {
  auto file = openExr(path);
  if (!file.ok()) return file.status();
  const std::vector<std::string> usual = usualExrChannels(**file, "").depth;
  const std::span<const std::string> names = channels.empty() ? usual : channels;
  if (names.size() != 1) {
    return refuseFile(path.string(), absl::StrCat("no depth in ", names.size(),
                                                  " channels; accepted is one, by default Z; it "
                                                  "has ",
                                                  listExrChannels(**file)));
  }
  const auto found = findAll(path.string(), **file, names);
  if (!found.ok()) return found.status();
  const Imf::PixelType type = found->front().type;
  if (type == Imf::UINT) {
    return refuseFile(path.string(), absl::StrCat("channel ", names.front(),
                                                  " holds integers; accepted is half or float"));
  }
  absl::StatusOr<PlaneImage> image = readPlane(path.string(), **file, *found, type, 1);
  if (!image.ok()) return image;
  image->encoding = type == Imf::HALF ? v1::PLANE_ENCODING_DEPTH_F16 : v1::PLANE_ENCODING_DEPTH_F32;
  return image;
}

absl::StatusOr<ExrViewChannels> exrChannelsOfView(const std::filesystem::path& path,
                                                  const std::string& view) {
  auto file = openExr(path);
  if (!file.ok()) return file.status();
  ExrViewChannels channels = usualExrChannels(**file, view);
  if (!view.empty() && channels.color.empty() && channels.depth.empty()) {
    return refuseFile(path.string(), absl::StrCat("has no view ", view, "; its channels are ",
                                                  listExrChannels(**file)));
  }
  return channels;
}

}  // namespace viewloom::files
