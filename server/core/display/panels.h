// SPDX-License-Identifier: Apache-2.0
// The panels of named devices, with usual calibrations: every unit is glued by itself, so a
// device's own file is needed for a clear picture. None is verified on hardware.
#pragma once

#include <optional>
#include <string_view>

#include "calibration/calibration.h"

namespace viewloom {

// Of a preset's name. None where no calibration of such a device is published.
std::optional<Calibration> panelOfPreset(std::string_view preset);

}  // namespace viewloom
