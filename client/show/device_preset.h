// SPDX-License-Identifier: Apache-2.0
// Which of the server's named quilts suits a calibrated device.
#pragma once

#include <string_view>

#include "calibration/calibration.h"

namespace viewloom::show {

// By the serial number's prefix, else by the panel's size; "portrait" for a device nobody knows.
std::string_view presetOf(const Calibration& calibration);

}  // namespace viewloom::show
