// SPDX-License-Identifier: Apache-2.0
// Errors of the graphics device in words that say what to do.
#pragma once

#include <exception>
#include <string>

namespace viewloom {

// What a user can know of the error: that memory has run out, or that the driver has given up. The
// driver's own words follow in brackets. Other errors say what they say.
std::string deviceErrorText(const std::exception& error);

// Whether the device has no memory left for what was asked of it.
bool isOutOfDeviceMemory(const std::exception& error);

}  // namespace viewloom
