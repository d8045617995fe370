// SPDX-License-Identifier: Apache-2.0
#include "cli/bounded_options.h"

#include <charconv>
#include <optional>

#include "base/printable.h"
#include "base/str_cat.h"
#include "display/display_spec.h"

namespace viewloom::cli {
namespace {

std::optional<SizePx> parseSize(const std::string& text) {
  SizePx size_px;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size_px.width);
  if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
  const auto height = std::from_chars(width.ptr + 1, end, size_px.height);
  if (height.ec != std::errc() || height.ptr != end) return std::nullopt;
  return size_px;
}

}  // namespace

usage::Option addSizeOption(const usage::Command& app, const std::string& name, SizePx& size_px,
                            uint32_t side_max_px, const std::string& description) {
  const auto take = [&size_px, name, side_max_px](const std::string& text) {
    const std::optional<SizePx> parsed = parseSize(text);
    const auto in_range = [&](uint32_t side) { return side >= 1 && side <= side_max_px; };
    if (!parsed || !in_range(parsed->width) || !in_range(parsed->height)) {
      throw usage::BadValue(strCat("got \"", printable(text),
                                   "\"; accepted is WIDTHxHEIGHT, such as 960x540, 1..",
                                   side_max_px, " px per side"));
    }
    size_px = *parsed;
  };
  return app.addTaken(name, take, description).valueName("WxH");
}

usage::Option within(const usage::Option& option, std::string_view field) {
  const Range range = rangeOf(field);
  return option.between(range.min, range.max);
}

usage::Option upTo(const usage::Option& option, std::string_view field) {
  return option.between(0, static_cast<int>(rangeOf(field).max));
}

uint32_t sideMax(std::string_view field) {
  return static_cast<uint32_t>(rangeOf(field).max);
}

}  // namespace viewloom::cli
