// SPDX-License-Identifier: Apache-2.0
#include "inputs/exr_tool.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "files/exr_layer_names.h"

namespace viewloom::inputs {
namespace {

bool has(const std::string& text, const char* word) {
  return text.find(word) != std::string::npos;
}

bool hasChannel(const files::ExrDescription& description, const char* word) {
  for (const files::ExrDescribedPart& part : description.parts) {
    for (const files::ExrDescribedChannel& channel : part.channels) {
      if (has(files::lowered(channel.name), word)) return true;
    }
  }
  return false;
}

// Attributes whose text names the program.
bool namesProgram(const std::string& key) {
  constexpr std::array<const char*, 5> kKeys{"software", "renderer", "program", "creator", "host"};
  return std::any_of(kKeys.begin(), kKeys.end(),
                     [&key](const char* known) { return has(key, known); });
}

}  // namespace

std::optional<InputKind> toolOf(const files::ExrDescription& description) {
  constexpr std::array<std::pair<const char*, InputKind>, 8> kWords{
      {{"arnold", InputKind::kArnold},
       {"redshift", InputKind::kRedshift},
       {"v-ray", InputKind::kVray},
       {"vray", InputKind::kVray},
       {"mantra", InputKind::kHoudini},
       {"karma", InputKind::kHoudini},
       {"houdini", InputKind::kHoudini},
       {"blender", InputKind::kBlender}}};
  for (const auto& [word, kind] : kWords) {
    for (const auto& [name, value] : description.texts) {
      const std::string key = files::lowered(name);
      if (has(key, word) || (namesProgram(key) && has(files::lowered(value), word))) return kind;
    }
  }
  if (hasChannel(description, "vrayzdepth")) return InputKind::kVray;
  return std::nullopt;
}

bool isOfNuke(const files::ExrDescription& description) {
  const auto is_nuke = [](const auto& text) { return text.first.starts_with("nuke/"); };
  return std::any_of(description.texts.begin(), description.texts.end(), is_nuke);
}

bool isDepthOfNuke(const std::string& channel) {
  const std::string name = files::lowered(channel);
  const size_t at = name.find("depth.");
  const bool begins = at == 0 || (at != std::string::npos && name[at - 1] == '.');
  return begins && name.ends_with(".z");
}

namespace {

using NameSet = std::set<std::string>;

NameSet namesIn(const files::ExrDescription& description) {
  NameSet names;
  for (const files::ExrDescribedPart& part : description.parts) {
    for (const files::ExrDescribedChannel& channel : part.channels) names.insert(channel.name);
  }
  return names;
}

// R, G, B and, where it is there, A, each behind the prefix.
std::optional<std::vector<std::string>> colorBehind(const NameSet& names,
                                                    const std::string& prefix) {
  std::vector<std::string> color;
  for (const char* channel : {"R", "G", "B"}) {
    if (!names.contains(prefix + channel)) return std::nullopt;
    color.push_back(prefix + channel);
  }
  if (names.contains(prefix + "A")) color.push_back(prefix + "A");
  return color;
}

}  // namespace

std::optional<ExrLayers> blenderLayers(const files::ExrDescription& description,
                                       const std::string& view) {
  const NameSet names = namesIn(description);
  const std::string of_view = view.empty() ? "" : view + ".";
  const std::string ending = ".Combined." + of_view + "R";
  for (const std::string& name : names) {
    if (!name.ends_with(ending)) continue;
    const std::string layer = name.substr(0, name.size() - ending.size());
    const auto color = colorBehind(names, layer + ".Combined." + of_view);
    const std::string depth = layer + ".Depth." + of_view + "Z";
    if (color && names.contains(depth)) return ExrLayers{*color, depth};
  }
  return std::nullopt;
}

std::optional<ExrLayers> unrealLayers(const files::ExrDescription& description) {
  const NameSet names = namesIn(description);
  const auto is_depth = [](const std::string& name) { return name.ends_with("WorldDepth.R"); };
  const auto depth = std::find_if(names.begin(), names.end(), is_depth);
  if (depth == names.end()) return std::nullopt;
  for (const std::string& name : names) {
    const bool is_pass = name.find("MovieRenderQueue_") != std::string::npos;
    if (is_pass || !name.starts_with("FinalImage") || !name.ends_with(".R")) continue;
    if (const auto color = colorBehind(names, name.substr(0, name.size() - 1))) {
      return ExrLayers{*color, *depth};
    }
  }
  if (const auto color = colorBehind(names, "")) return ExrLayers{*color, *depth};
  return std::nullopt;
}

}  // namespace viewloom::inputs
