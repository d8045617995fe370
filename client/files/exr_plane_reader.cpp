// SPDX-License-Identifier: Apache-2.0
#include "files/exr_plane_reader.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cstring>

namespace viewloom::files {
namespace {

bool isFlat(const Imf::Header& header) {
  return !header.hasType() || !Imf::isDeepData(header.type());
}

std::optional<ExrChannel> channelOfPart(const Imf::MultiPartInputFile& file, int part,
                                        const std::string& name) {
  const Imf::Header& header = file.header(part);
  if (!isFlat(header)) return std::nullopt;
  const Imf::Channel* channel = header.channels().findChannel(name);
  if (channel == nullptr) return std::nullopt;
  return ExrChannel{.part = part,
                    .name = name,
                    .type = channel->type,
                    .x_sampling = channel->xSampling,
                    .y_sampling = channel->ySampling};
}

// Whether the channels without a prefix of this part belong to what is called `prefix`.
bool partIsCalled(const Imf::Header& header, const std::string& prefix) {
  if (header.hasName() && header.name() == prefix) return true;
  if (header.hasView() && header.view() == prefix) return true;
  if (!Imf::hasMultiView(header)) return false;
  const Imf::StringVector& views = Imf::multiView(header);
  return !views.empty() && views.front() == prefix;
}

}  // namespace

std::optional<ExrChannel> findExrChannel(const Imf::MultiPartInputFile& file,
                                         const std::string& name) {
  for (int part = 0; part < file.parts(); ++part) {
    if (auto channel = channelOfPart(file, part, name)) return channel;
  }
  for (size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', dot + 1)) {
    for (int part = 0; part < file.parts(); ++part) {
      if (!partIsCalled(file.header(part), name.substr(0, dot))) continue;
      if (auto channel = channelOfPart(file, part, name.substr(dot + 1))) return channel;
    }
  }
  return std::nullopt;
}

namespace {

// Rows read at once where a file has to be cropped: bounds the memory beside the plane itself.
constexpr int kRowsAtOnce = 64;

int floorDivided(int value, int by) {
  return value / by - (value % by < 0 ? 1 : 0);
}

}  // namespace

ExrPlaneReader::ExrPlaneReader(Imf::MultiPartInputFile& file, int part, const ExrWindow& window,
                               Imf::PixelType type, size_t plane_channels)
    : part_(file, part),
      type_(type),
      sample_bytes_(type == Imf::HALF ? 2 : 4),
      pixel_bytes_(sample_bytes_ * plane_channels),
      window_(window) {
  const auto& data = part_.header().dataWindow();
  data_begin_x_ = data.min.x;
  data_width_px_ = data.max.x - data.min.x + 1;
  visible_ = {std::max(data.min.x, window.min_x), std::max(data.min.y, window.min_y),
              std::min(data.max.x, window.max_x), std::min(data.max.y, window.max_y)};
}

void ExrPlaneReader::readInto(std::vector<uint8_t>& plane, std::span<const std::string> names) {
  if (visible_.width() < 1) return;
  // OpenEXR refuses to read into nothing.
  if (std::all_of(names.begin(), names.end(), [](const auto& name) { return name.empty(); }))
    return;
  const size_t row_bytes = pixel_bytes_ * static_cast<size_t>(data_width_px_);
  std::vector<uint8_t> rows(row_bytes * kRowsAtOnce);
  for (int y = visible_.min_y; y <= visible_.max_y; y += kRowsAtOnce) {
    const int end_y = std::min(y + kRowsAtOnce, visible_.max_y + 1);
    readRows(y, end_y, rows, names);
    for (int row = y; row < end_y; ++row) {
      copyRow(row, &rows[row_bytes * static_cast<size_t>(row - y)], plane);
    }
  }
}

void ExrPlaneReader::readRows(int begin_y, int end_y, std::vector<uint8_t>& rows,
                              std::span<const std::string> names) {
  Imf::FrameBuffer frame_buffer;
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) continue;
    frame_buffer.insert(
        names[i],
        Imf::Slice::Make(type_, &rows[i * sample_bytes_], Imath::V2i(data_begin_x_, begin_y),
                         data_width_px_, end_y - begin_y, pixel_bytes_,
                         pixel_bytes_ * static_cast<size_t>(data_width_px_)));
  }
  part_.setFrameBuffer(frame_buffer);
  part_.readPixels(begin_y, end_y - 1);
}

void ExrPlaneReader::copyRow(int y, const uint8_t* row, std::vector<uint8_t>& plane) const {
  const auto skipped = static_cast<size_t>(visible_.min_x - data_begin_x_);
  const auto x = static_cast<size_t>(visible_.min_x - window_.min_x);
  const auto plane_row =
      static_cast<size_t>(y - window_.min_y) * static_cast<size_t>(window_.width());
  std::memcpy(&plane[(plane_row + x) * pixel_bytes_], row + skipped * pixel_bytes_,
              static_cast<size_t>(visible_.width()) * pixel_bytes_);
}

ExrSubsampledChannel::ExrSubsampledChannel(Imf::MultiPartInputFile& file, const ExrChannel& channel)
    : x_sampling_(channel.x_sampling), y_sampling_(channel.y_sampling) {
  Imf::InputPart part(file, channel.part);
  const Imath::Box2i data = part.header().dataWindow();
  // OpenEXR has samples where x and y are whole multiples of the sampling.
  first_column_ = -floorDivided(-data.min.x, x_sampling_);
  first_row_ = -floorDivided(-data.min.y, y_sampling_);
  columns_ = floorDivided(data.max.x, x_sampling_) - first_column_ + 1;
  rows_ = floorDivided(data.max.y, y_sampling_) - first_row_ + 1;
  if (columns_ < 1 || rows_ < 1) return;
  samples_.resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
  Imf::FrameBuffer buffer;
  const size_t row_bytes = sizeof(float) * static_cast<size_t>(columns_);
  // The slice begins where the file's px 0, 0 would lie.
  char* const base = reinterpret_cast<char*>(samples_.data()) -
                     std::ptrdiff_t(sizeof(float)) * first_column_ -
                     std::ptrdiff_t(row_bytes) * first_row_;
  buffer.insert(channel.name,
                Imf::Slice(Imf::FLOAT, base, sizeof(float), row_bytes, x_sampling_, y_sampling_));
  part.setFrameBuffer(buffer);
  part.readPixels(data.min.y, data.max.y);
}

float ExrSubsampledChannel::sample(int column, int row) const {
  const int x = std::clamp(column - first_column_, 0, columns_ - 1);
  const int y = std::clamp(row - first_row_, 0, rows_ - 1);
  return samples_[static_cast<size_t>(y) * static_cast<size_t>(columns_) + static_cast<size_t>(x)];
}

float ExrSubsampledChannel::at(int x, int y) const {
  if (samples_.empty()) return 0;
  const int column = floorDivided(x, x_sampling_), row = floorDivided(y, y_sampling_);
  const float right = float(x - column * x_sampling_) / float(x_sampling_);
  const float down = float(y - row * y_sampling_) / float(y_sampling_);
  const auto across = [&](int of_row) {
    return sample(column, of_row) * (1 - right) + sample(column + 1, of_row) * right;
  };
  return across(row) * (1 - down) + across(row + 1) * down;
}

}  // namespace viewloom::files
