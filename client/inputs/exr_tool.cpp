// SPDX-License-Identifier: Apache-2.0
#include "inputs/exr_tool.h"

#include <algorithm>
#include <array>
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

}  // namespace viewloom::inputs
