// SPDX-License-Identifier: Apache-2.0
#include "files/exr_layer_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"

namespace viewloom::files {
namespace {

bool isLetterOrDigit(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

// Letters and digits alone, in lower case: "Z Depth" and "z_depth" are one word.
std::string wordOf(const std::string& text) {
  std::string word = lowered(text);
  std::erase_if(word, [](char c) { return !isLetterOrDigit(c); });
  return word;
}

template <size_t count>
bool isAnyOf(const std::string& word, const std::array<const char*, count>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// The view that a name says, taken out of its words; "" = none.
std::string takeView(const std::vector<std::string>& views, std::vector<std::string>& words) {
  for (size_t i = 0; i + 1 < words.size(); ++i) {
    if (std::find(views.begin(), views.end(), words[i]) == views.end()) continue;
    const std::string view = words[i];
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
    return view;
  }
  return "";
}

// Words of the kind "rgba" and "main" in "rgba_main".
std::vector<std::string> partsOfWord(const std::string& word) {
  std::vector<std::string> parts{""};
  for (const char c : lowered(word)) {
    if (isLetterOrDigit(c)) {
      parts.back() += c;
    } else {
      parts.emplace_back();
    }
  }
  return parts;
}

}  // namespace

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string defaultExrView(const ExrDescription& description) {
  const auto has_view = [](const ExrDescribedPart& part) { return !part.view.empty(); };
  if (std::any_of(description.parts.begin(), description.parts.end(), has_view)) {
    return description.parts.front().view;
  }
  return description.views.empty() ? "" : description.views.front();
}

std::vector<std::string> ExrLayer::color() const {
  const auto firstOf = [this](const char* a, const char* b) -> std::string {
    const auto found = channels.contains(a) ? channels.find(a) : channels.find(b);
    return found == channels.end() ? "" : found->second;
  };
  const std::string alpha = firstOf("a", "alpha");
  for (const auto& names :
       {std::vector{firstOf("r", "red"), firstOf("g", "green"), firstOf("b", "blue")},
        std::vector{firstOf("y", "y"), firstOf("ry", "ry"), firstOf("by", "by")}}) {
    if (std::find(names.begin(), names.end(), "") != names.end()) continue;
    std::vector<std::string> color = names;
    if (!alpha.empty()) color.push_back(alpha);
    return color;
  }
  if (hasVectors() || !channels.contains("y")) return {};
  return {channels.at("y")};
}

bool ExrLayer::hasVectors() const {
  return channels.contains("x") && channels.contains("y") && channels.contains("z");
}

std::vector<ExrLayer> exrLayersOf(const ExrDescription& description, const std::string& view) {
  std::vector<std::string> views = description.views;
  views.push_back(view);
  const std::string default_view = defaultExrView(description);
  std::vector<ExrLayer> layers;
  for (size_t part = 0; part < description.parts.size(); ++part) {
    const ExrDescribedPart& its = description.parts[part];
    if (its.isDeep()) continue;
    for (const ExrDescribedChannel& channel : its.channels) {
      std::vector<std::string> words = absl::StrSplit(channel.name, '.');
      std::string said = takeView(views, words);
      if (said.empty()) said = its.view.empty() ? default_view : its.view;
      if (said != view) continue;
      const std::string base = lowered(words.back());
      words.pop_back();
      const std::string path = absl::StrJoin(words, ".");
      auto layer = std::find_if(layers.begin(), layers.end(), [&](const ExrLayer& other) {
        return other.part == part && other.path == path;
      });
      if (layer == layers.end()) {
        ExrLayer added{.part = part, .path = path};
        if (!words.empty()) {
          added.last = words.back();
          words.pop_back();
          added.parent = absl::StrJoin(words, ".");
        }
        layers.push_back(std::move(added));
        layer = layers.end() - 1;
      }
      layer->channels.emplace(base, channel.name);
      layer->order.push_back(base);
    }
  }
  return layers;
}

std::optional<int> pictureRank(const std::string& word) {
  constexpr std::array<const char*, 14> kPictures{
      "",    "rgba", "combined", "beauty", "finalimage", "image",     "color",
      "rgb", "main", "colour",   "final",  "composite",  "rgb_color", "c"};
  constexpr std::array<const char*, 18> kOthers{
      "n",        "normal",   "normals",      "p",
      "pos",      "position", "positions",    "pref",
      "uv",       "st",       "vector",       "motion",
      "velocity", "vectors",  "motionvector", "motionvectors",
      "objectid", "id"};
  if (isDepthWord(word)) return std::nullopt;
  const std::vector<std::string> parts = partsOfWord(word);
  for (size_t rank = 0; rank < kPictures.size(); ++rank) {
    if (std::find(parts.begin(), parts.end(), kPictures[rank]) != parts.end() &&
        (rank > 0 || word.empty())) {
      return int(rank);
    }
  }
  const std::string whole = wordOf(word);
  if (isAnyOf(whole, kOthers) || whole.starts_with("crypto")) return std::nullopt;
  return kUnknownPicture;
}

bool isDepthWord(const std::string& word) {
  constexpr std::array<const char*, 9> kWords{"z",       "zz",   "pz",    "zbuf", "zbuffer",
                                              "cameraz", "camz", "viewz", "zpass"};
  const std::string whole = wordOf(word);
  if (whole.find("depthoffield") != std::string::npos) return false;
  return isAnyOf(whole, kWords) || whole.find("depth") != std::string::npos;
}

bool isDerivedDepth(const std::string& word) {
  constexpr std::array<const char*, 5> kWords{"filter", "norm", "invert", "aliased", "denois"};
  const std::string whole = wordOf(word);
  return std::any_of(kWords.begin(), kWords.end(), [&whole](const char* known) {
    return whole.find(known) != std::string::npos;
  });
}

}  // namespace viewloom::files
