// SPDX-License-Identifier: Apache-2.0
#include "show/text_overlay.h"

#include <utility>
#include <vector>

namespace viewloom::show {
namespace {

constexpr int kEm_px = 22;
constexpr double kMargin_px = 16;

}  // namespace

absl::StatusOr<std::unique_ptr<TextOverlay>> TextOverlay::make() {
  absl::StatusOr<std::unique_ptr<Font>> font = Font::open(kEm_px);
  if (!font.ok()) return font.status();
  return std::unique_ptr<TextOverlay>(new TextOverlay(*std::move(font)));
}

absl::Status TextOverlay::draw(const std::string& text, Painter& painter) {
  const absl::StatusOr<WrittenText> written = font_->write(text);
  if (!written.ok()) return written.status();
  std::vector<uint8_t> samples;
  samples.reserve(4 * written->coverage.size());
  for (const uint8_t white : written->coverage) {
    samples.insert(samples.end(), {white, white, white, 255});
  }
  VIEWLOOM_RETURN_IF_ERROR(texture_.upload(written->size_px, 4, samples));
  const PixelArea whole{.width_px = static_cast<double>(written->size_px.width),
                        .height_px = static_cast<double>(written->size_px.height)};
  PixelArea target = whole;
  target.left_px = target.top_px = kMargin_px;
  painter.place(texture_, whole, target);
  return absl::OkStatus();
}

}  // namespace viewloom::show
