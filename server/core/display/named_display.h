// SPDX-License-Identifier: Apache-2.0
// Displays by the names of their devices, whatever kind they are.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "display/atlas_layout.h"
#include "display/display_kinds.h"

namespace viewloom {

// A device, and the display that its name alone opens.
struct NamedDevice {
  KnownDevice device;
  std::vector<std::string> kinds;  // of displays that it has; the first is that display's
  AtlasLayout layout;              // without what the stream gives it
};

// Sorted by name.
std::vector<NamedDevice> namedDevices();

// Names of all devices, sorted.
std::vector<std::string> displayNames();

// The display of a named device. A device that takes several kinds gets a quilt. NOT_FOUND names
// the nearest devices, for the field "preset".
absl::StatusOr<DisplayKind> namedDisplay(std::string_view name);

// NOT_FOUND for a name that is none of `names`, those of one kind of display. `field`
// ("rgbd.preset") names the kind. The message suggests the nearest of `names`, or a display of
// another kind.
absl::Status unknownPreset(std::string_view name, std::string_view field,
                           const std::vector<std::string>& names);

}  // namespace viewloom
