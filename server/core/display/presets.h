// SPDX-License-Identifier: Apache-2.0
// Named devices, with published values as defaults. None is verified on hardware.
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
  std::string_view note;  // where published sources disagree; "" = nowhere
};

// All presets, sorted by name.
std::span<const Preset> allPresets();
// Preset of this name; nullptr if there is none.
const Preset* findPreset(std::string_view name);
// NOT_FOUND with the known names if there is no such preset.
absl::Status checkPreset(std::string_view name, std::string_view field);

// Panel of a preset's device, with its usual calibration. Every unit is glued on its own, so a
// clear picture needs the file of the device. None is verified on hardware. Empty if no calibration
// of such a device is published.
std::optional<Calibration> panelOfPreset(std::string_view preset);

}  // namespace viewloom
