// SPDX-License-Identifier: Apache-2.0
#include "cli/user_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string_view>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::cli {
namespace {

// Fields by the end of their path.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kOptions{{
    {"preset", "--preset"},
    {"columns", "--columns"},
    {"rows", "--rows"},
    {"quilt.size", "--size"},
    {"view_cone_rad", "--cone (radians)"},
    {"focal_distance_m", "--focal-distance"},
    {"fov_y_rad", "--fov (radians)"},
    {"focus_following_s", "--focus-follow"},
    {"filter.sample_count", "--samples"},
    {"reflection.bounces", "--reflections"},
    {"jpeg_quality", "--quality"},
    {"calibration_json", "--calibration"},
    {"rgbd.view_size", "--rgbd"},
    {"output_rate_hz", "--output-rate"},
    {"lens.aperture_m", "--aperture"},
    {"lens.focus_distance_m", "--lens-focus"},
}};

bool isPath(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '.' || letter == '[' ||
           letter == ']';
  });
}

// Takes "NAME[N]." or "NAME[N]" off the front; 0 = it does not begin so. Counts from 1.
uint64_t takeIndex(std::string_view& path, std::string_view name) {
  std::string_view rest = path;
  if (!rest.starts_with(name)) return 0;
  rest.remove_prefix(name.size());
  uint64_t index = 0;
  if (!rest.starts_with('[')) return 0;
  const auto [stop, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), index);
  if (error != std::errc() || stop == rest.data() + rest.size() || *stop != ']') return 0;
  rest.remove_prefix(size_t(stop - rest.data()) + 1);
  if (rest.starts_with('.')) rest.remove_prefix(1);
  path = rest;
  return index + 1;
}

std::string placeInFrame(std::string_view path) {
  std::string place;
  const auto add = [&](const std::string& part) { place += (place.empty() ? "" : ", ") + part; };
  const uint64_t source = takeIndex(path, "sources");
  if (source == 0) return "";
  // Most frames have one source, and users who gave none number none.
  if (source > 1) add(strCat("source ", source));
  const uint64_t layer = takeIndex(path, "layers");
  if (layer != 0) add(strCat("layer ", layer));
  const uint64_t plane = takeIndex(path, "planes");
  if (plane != 0) add(strCat("plane ", plane));
  std::string rest(path);
  std::ranges::replace(rest, '_', ' ');
  std::ranges::replace(rest, '.', ' ');
  if (!rest.empty()) add(rest);
  return place.empty() ? "the frame" : place;
}

}  // namespace

std::string inUserWords(const std::string& message) {
  const size_t colon = message.find(": ");
  if (colon == std::string::npos) return message;
  const std::string_view path = std::string_view(message).substr(0, colon);
  if (!isPath(path)) return message;
  // The file's name follows.
  if (path == "deep") return message.substr(colon + 2);
  for (const auto& [end, option] : kOptions) {
    const size_t before = path.size() - std::min(path.size(), end.size());
    if (path.ends_with(end) && (before == 0 || path[before - 1] == '.')) {
      return strCat(option, message.substr(colon));
    }
  }
  const std::string place = placeInFrame(path);
  return place.empty() ? message : strCat(place, message.substr(colon));
}

}  // namespace viewloom::cli
