// SPDX-License-Identifier: Apache-2.0
#include "display/named_display.h"

#include <algorithm>
#include <optional>

#include "base/nearest_name.h"
#include "base/str_cat.h"
#include "display/integral.h"
#include "display/presets.h"
#include "display/rgbd.h"

namespace viewloom {
namespace {

template <typename Presets>
bool holdsName(const Presets& presets, std::string_view name) {
  return std::ranges::any_of(presets, [&](const auto& preset) { return name == preset.name; });
}

std::optional<DisplayKind> displayOf(std::string_view name) {
  if (holdsName(allPresets(), name)) return QuiltSpec{.preset = std::string(name)};
  if (holdsName(integralPresets(), name)) return IntegralSpec{.preset = std::string(name)};
  if (holdsName(rgbdPresets(), name)) return RgbdSpec{.preset = std::string(name)};
  return std::nullopt;
}

// A display of another kind that has the name, or one near it; "" where the kind of `names` has
// one.
std::string otherKind(std::string_view name, const std::vector<std::string>& names) {
  if (!displayOf(name) && !nearestNames(name, names).empty()) return "";
  const std::string other = nearestName(name, displayNames());
  if (other.empty() || std::ranges::find(names, other) != names.end()) return "";
  return strCat("; \"", other, "\" is a display of another kind: open it by its name alone");
}

}  // namespace

std::vector<std::string> displayNames() {
  std::vector<std::string> names;
  for (const Preset& preset : allPresets()) names.emplace_back(preset.name);
  for (const IntegralPreset& preset : integralPresets()) names.emplace_back(preset.name);
  for (const RgbdPreset& preset : rgbdPresets()) names.emplace_back(preset.name);
  std::ranges::sort(names);
  return names;
}

absl::StatusOr<DisplayKind> namedDisplay(std::string_view name) {
  std::optional<DisplayKind> display = displayOf(name);
  if (!display) return unknownPreset(name, "preset", displayNames());
  return *std::move(display);
}

absl::Status unknownPreset(std::string_view name, std::string_view field,
                           const std::vector<std::string>& names) {
  return fieldError(absl::StatusCode::kNotFound, field,
                    strCat(noSuchName(name, names), otherKind(name, names)));
}

}  // namespace viewloom
