// SPDX-License-Identifier: Apache-2.0
// Named devices. Published tables lag the hardware: defaults only, none verified on hardware.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "base/status.h"
#include "calibration/calibration.h"
#include "frame/size.h"

namespace viewloom {

struct Preset {
  std::string_view name;    // "portrait"
  std::string_view device;  // "Looking Glass Portrait"
  uint32_t columns;
  uint32_t rows;
  SizePx size_px;
  double aspect;
  double view_cone_deg;
  std::string_view note;  // where sources disagree; "" = they do not
};

// Sorted by name.
std::span<const Preset> allPresets();
// nullptr when there is none.
const Preset* findPreset(std::string_view name);
// NOT_FOUND with those that there are.
absl::Status checkPreset(std::string_view name, std::string_view field);

// The panel of a preset's device, with its usual calibration. Every unit is glued by itself, so a
// device's own file is needed for a clear picture; none is verified on hardware. Empty where no
// calibration of such a device is published.
std::optional<Calibration> panelOfPreset(std::string_view preset);

}  // namespace viewloom
