// SPDX-License-Identifier: Apache-2.0
#include "patterns/lettering.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewloom::patterns {
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

}  // namespace viewloom::patterns
