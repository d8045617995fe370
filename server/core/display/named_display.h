// SPDX-License-Identifier: Apache-2.0
// Displays of any kind by the names of their devices.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "display/atlas_layout.h"
#include "display/display_kinds.h"

namespace viewloom {

// A device, and the display that its name opens.
struct NamedDevice {
  KnownDevice device;
  std::vector<std::string> kinds;  // kinds of displays that it accepts; its name opens the first
  AtlasLayout layout;              // without values from a stream
};

// All devices, sorted by name.
std::vector<NamedDevice> namedDevices();

// Names of all devices, sorted.
std::vector<std::string> displayNames();

// Display of a named device. A device that accepts several kinds gets a quilt. NOT_FOUND names the
// nearest devices, for the field "preset".
absl::StatusOr<DisplayKind> namedDisplay(std::string_view name);

// Returns NOT_FOUND for a name that is not among `names`, the names of one kind of display. `field`
// ("rgbd.preset") names the kind. The message suggests the nearest of `names`, or a display of
// another kind.
absl::Status unknownPreset(std::string_view name, std::string_view field,
                           const std::vector<std::string>& names);

}  // namespace viewloom
