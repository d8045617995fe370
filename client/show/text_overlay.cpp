// SPDX-License-Identifier: Apache-2.0
#include "show/text_overlay.h"

#include <SDL.h>
#include <SDL_ttf.h>

#include <cstring>
#include <vector>

#include "base/str_cat.h"

namespace viewloom::show {
namespace {

constexpr char kFont[] = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
constexpr int kFontHeight_px = 22;
constexpr double kMargin_px = 16;
constexpr SDL_Color kWhite = {255, 255, 255, 255};
constexpr SDL_Color kBlack = {0, 0, 0, 255};

using Surface = std::unique_ptr<SDL_Surface, void (*)(SDL_Surface*)>;

absl::Status drawError() {
  return absl::InternalError(strCat("text cannot be drawn: ", SDL_GetError()));
}

}  // namespace

absl::StatusOr<std::unique_ptr<TextOverlay>> TextOverlay::make() {
  if (TTF_Init() != 0) return drawError();
  TTF_Font* font = TTF_OpenFont(kFont, kFontHeight_px);
  if (font == nullptr) {
    const std::string problem = strCat("no font for the statistics (", SDL_GetError(),
                                       "); install the package fonts-dejavu-core");
    TTF_Quit();
    return absl::FailedPreconditionError(problem);
  }
  return std::unique_ptr<TextOverlay>(new TextOverlay(font));
}

TextOverlay::~TextOverlay() {
  TTF_CloseFont(font_);
  TTF_Quit();
}

absl::Status TextOverlay::draw(const std::string& text, Painter& painter) {
  const Surface written(TTF_RenderUTF8_Shaded_Wrapped(font_, text.c_str(), kWhite, kBlack, 0),
                        &SDL_FreeSurface);
  if (written == nullptr) return drawError();
  const Surface rgba(SDL_ConvertSurfaceFormat(written.get(), SDL_PIXELFORMAT_RGBA32, 0),
                     &SDL_FreeSurface);
  if (rgba == nullptr) return drawError();
  const SizePx size_px{static_cast<uint32_t>(rgba->w), static_cast<uint32_t>(rgba->h)};
  const size_t row_bytes = size_t{size_px.width} * 4;
  std::vector<uint8_t> samples(row_bytes * size_px.height);
  for (size_t row = 0; row < size_px.height; ++row) {
    const auto* from =
        static_cast<const uint8_t*>(rgba->pixels) + row * static_cast<size_t>(rgba->pitch);
    std::memcpy(&samples[row * row_bytes], from, row_bytes);
  }
  VIEWLOOM_RETURN_IF_ERROR(texture_.upload(size_px, 4, samples));
  const PixelArea whole{.width_px = static_cast<double>(size_px.width),
                        .height_px = static_cast<double>(size_px.height)};
  PixelArea target = whole;
  target.left_px = target.top_px = kMargin_px;
  painter.place(texture_, whole, target);
  return absl::OkStatus();
}

}  // namespace viewloom::show
