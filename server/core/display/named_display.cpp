// SPDX-License-Identifier: Apache-2.0
#include "display/named_display.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

// The display of the first kind that has such a device.
std::optional<DisplayKind> displayOf(std::string_view name) {
  std::optional<DisplayKind> found;
  forEachKind([&](auto kind) {
    const bool has_name =
        !found && std::ranges::any_of(devicesOf(kind),
                                      [&](const KnownDevice& known) { return known.name == name; });
    if constexpr (requires { kind.preset; }) {
      if (!has_name) return;
      kind.preset = name;
      found = std::move(kind);
    }
  });
  return found;
}

// A display of another kind that has the name, or one near it; "" where the kind of `names` has
// one.
std::string otherKind(std::string_view name, const std::vector<std::string>& names) {
  if (!displayOf(name) && !nearestNames(name, names).empty()) return "";
  const std::string other = nearestName(name, displayNames());
  if (other.empty() || std::ranges::find(names, other) != names.end()) return "";
  return strCat("; \"", other, "\" is a display of another kind: open it by its name alone");
}

// The grid of a device does not depend on what a stream would give: any source will do.
AtlasLayout layoutOf(DisplayKind kind) {
  const absl::StatusOr<DisplaySpec> completed = completeDisplaySpec({.kind = std::move(kind)});
  VIEWLOOM_CHECK(completed.ok());
  const StreamDefaults any_source{
      .source_intrinsics = {.focal_px = {1, 1}, .principal_px = {0.5, 0.5}},
      .source_size_px = {.width = 1, .height = 1}};
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(*completed, any_source);
  VIEWLOOM_CHECK(layout.ok());
  layout->focal_distance_m = 0;  // from the stream
  return *std::move(layout);
}

// Adds what another kind knows of a device that is in the list already.
void join(const KnownDevice& device, NamedDevice& known) {
  if (known.device.panel_px != SizePx{}) return;
  known.device.panel_px = device.panel_px;
  known.device.panel_dpi = device.panel_dpi;
}

}  // namespace

std::vector<NamedDevice> namedDevices() {
  std::map<std::string_view, NamedDevice> devices;
  forEachKind([&](const auto& kind) {
    for (const KnownDevice& device : devicesOf(kind)) {
      const auto [place, is_new] = devices.try_emplace(device.name, NamedDevice{device, {}, {}});
      place->second.kinds.emplace_back(kind.kName);
      if (is_new) {
        place->second.layout = layoutOf(*displayOf(device.name));
      } else {
        join(device, place->second);
      }
    }
  });
  std::vector<NamedDevice> sorted;
  for (auto& [name, device] : devices) sorted.push_back(std::move(device));
  return sorted;
}

std::vector<std::string> displayNames() {
  std::set<std::string> names;  // a device may have displays of several kinds
  forEachKind([&](const auto& kind) {
    for (const KnownDevice& device : devicesOf(kind)) names.emplace(device.name);
  });
  return {names.begin(), names.end()};
}

absl::StatusOr<DisplayKind> namedDisplay(std::string_view name) {
  std::optional<DisplayKind> display = displayOf(name);
  if (!display) return unknownPreset(name, "preset", displayNames());
  return *std::move(display);
}

absl::Status unknownPreset(std::string_view name, std::string_view field,
                           const std::vector<std::string>& names) {
  return fieldError(absl::StatusCode::kNotFound, field,
                    strCat(noSuchName("preset", name, names), otherKind(name, names)));
}

}  // namespace viewloom
