// SPDX-License-Identifier: Apache-2.0
#include "text/font.h"

#include <SDL.h>
#include <SDL_ttf.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr char kFont[] = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
constexpr SDL_Color kWhite = {255, 255, 255, 255};
constexpr size_t kBytesPerPx = 4;
constexpr size_t kAlpha = 3;

using Surface = std::unique_ptr<SDL_Surface, void (*)(SDL_Surface*)>;

absl::Status writeError() {
  return absl::InternalError(strCat("text cannot be drawn: ", SDL_GetError()));
}

}  // namespace

absl::StatusOr<std::unique_ptr<Font>> Font::open(int em_px) {
  if (TTF_Init() != 0) return writeError();
  TTF_Font* font = TTF_OpenFont(kFont, em_px);
  if (font == nullptr) {
    const std::string problem =
        strCat("no font for text (", SDL_GetError(), "); install the package fonts-dejavu-core");
    TTF_Quit();
    return absl::FailedPreconditionError(problem);
  }
  return std::unique_ptr<Font>(new Font(font));
}

Font::~Font() {
  TTF_CloseFont(font_);
  TTF_Quit();
}

absl::StatusOr<WrittenText> Font::write(const std::string& text) const {
  const Surface written(TTF_RenderUTF8_Blended_Wrapped(font_, text.c_str(), kWhite, 0),
                        &SDL_FreeSurface);
  if (written == nullptr) return writeError();
  const Surface rgba(SDL_ConvertSurfaceFormat(written.get(), SDL_PIXELFORMAT_RGBA32, 0),
                     &SDL_FreeSurface);
  if (rgba == nullptr) return writeError();
  WrittenText picture{.size_px = {static_cast<uint32_t>(rgba->w), static_cast<uint32_t>(rgba->h)},
                      .coverage = {}};
  picture.coverage.reserve(picture.size_px.area());
  for (size_t row = 0; row < picture.size_px.height; ++row) {
    const auto* from =
        static_cast<const uint8_t*>(rgba->pixels) + row * static_cast<size_t>(rgba->pitch);
    for (size_t x = 0; x < picture.size_px.width; ++x) {
      picture.coverage.push_back(from[kBytesPerPx * x + kAlpha]);
    }
  }
  return picture;
}

namespace {

constexpr double kEmMin_px = 5;  // smaller letters are none

}  // namespace

WrittenText Lettering::write(double em_px, const std::string& text) {
  if (!status_.ok()) return {};
  const int size_px = static_cast<int>(std::floor(std::max(em_px, kEmMin_px)));
  std::unique_ptr<Font>& font = fonts_[size_px];
  if (font == nullptr) {
    absl::StatusOr<std::unique_ptr<Font>> opened = Font::open(size_px);
    if (!opened.ok()) {
      status_ = opened.status();
      return {};
    }
    font = *std::move(opened);
  }
  absl::StatusOr<WrittenText> written = font->write(text);
  if (written.ok()) return *std::move(written);
  status_ = written.status();
  return {};
}

}  // namespace viewloom
