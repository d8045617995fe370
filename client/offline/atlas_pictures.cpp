// SPDX-License-Identifier: Apache-2.0
#include "offline/atlas_pictures.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_format.h"
#include "encode/encoded_band.h"
#include "files/file_bytes.h"
#include "files/png_image.h"

namespace viewloom {
namespace {

using Bytes = std::vector<uint8_t>;

void appendRgb(uint32_t color, Bytes& rgb) {
  for (const uint32_t shift : {0U, 8U, 16U}) rgb.push_back(static_cast<uint8_t>(color >> shift));
}

// A rectangle of the atlas as RGB8.
Bytes cropRgb(const RenderedAtlas& atlas, TileOrigin origin, SizePx size_px) {
  Bytes rgb;
  rgb.reserve(3 * size_px.area());
  for (size_t y = origin.y_px; y < origin.y_px + size_px.height; ++y) {
    const uint32_t* row = &atlas.color[y * atlas.layout->size_px.width + origin.x_px];
    std::for_each_n(row, size_px.width, [&](uint32_t color) { appendRgb(color, rgb); });
  }
  return rgb;
}

// Black, red, yellow, white at 0, 1/3, 2/3, 1.
std::array<uint8_t, 3> heatColor(double heat) {
  std::array<uint8_t, 3> rgb{};
  for (int c = 0; c < 3; ++c) {
    rgb[static_cast<size_t>(c)] = static_cast<uint8_t>(255 * std::clamp(3 * heat - c, 0.0, 1.0));
  }
  return rgb;
}

Bytes heatMap(const std::vector<uint32_t>& visits, uint32_t white_visits) {
  Bytes rgb;
  rgb.reserve(3 * visits.size());
  for (const uint32_t count : visits) {
    const auto color = heatColor(double(count) / std::max(white_visits, 1u));
    rgb.insert(rgb.end(), color.begin(), color.end());
  }
  return rgb;
}

Bytes greyMask(const Bytes& mask) {
  Bytes grey(mask.size());
  std::transform(mask.begin(), mask.end(), grey.begin(),
                 [](uint8_t ray_class) { return uint8_t(ray_class * kGreyPerRayClass); });
  return grey;
}

}  // namespace

VisitStats visitStats(const RenderedAtlas& atlas) {
  std::vector<uint32_t> visits;
  visits.reserve(atlas.visits.size());
  double sum = 0;
  for (size_t i = 0; i < atlas.visits.size(); ++i) {
    if (atlas.mask[i] == static_cast<uint8_t>(RayClass::kPadding)) continue;
    visits.push_back(atlas.visits[i]);
    sum += atlas.visits[i];
  }
  if (visits.empty()) return {};
  const auto p99 = visits.begin() + static_cast<std::ptrdiff_t>(visits.size() * 99 / 100);
  std::nth_element(visits.begin(), p99, visits.end());
  return {.mean = sum / static_cast<double>(visits.size()),
          .p99 = *p99,
          .max = *std::max_element(p99, visits.end())};
}

absl::StatusOr<std::vector<std::string>> writeAtlasPictures(const RenderedAtlas& atlas,
                                                            const std::filesystem::path& folder) {
  std::vector<std::string> names;
  const auto write = [&](const std::string& name, const Bytes& samples, SizePx size_px,
                         uint32_t channels) -> absl::Status {
    const auto png = files::encodePng(samples, size_px.width, size_px.height, channels);
    if (!png.ok()) return png.status();
    names.push_back(name);
    return files::writeFileWhole(folder / name, *png);
  };
  const AtlasLayout& layout = *atlas.layout;
  VIEWLOOM_RETURN_IF_ERROR(write("atlas" + layout.suffix + ".png",
                                 cropRgb(atlas, {}, layout.size_px), layout.size_px, 3));
  for (uint32_t view = 0; view < layout.views.size(); ++view) {
    VIEWLOOM_RETURN_IF_ERROR(write(absl::StrFormat("view_%03u.png", view),
                                   cropRgb(atlas, layout.tileOrigin(view), layout.tile_size_px),
                                   layout.tile_size_px, 3));
  }
  VIEWLOOM_RETURN_IF_ERROR(write("mask.png", greyMask(atlas.mask), layout.size_px, 1));
  VIEWLOOM_RETURN_IF_ERROR(
      write("visits.png", heatMap(atlas.visits, visitStats(atlas).p99), layout.size_px, 3));
  return names;
}

}  // namespace viewloom
