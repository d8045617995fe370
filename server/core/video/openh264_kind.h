// SPDX-License-Identifier: Apache-2.0
// OpenH264 as a kind of video encoder. It works on every machine.
#pragma once

#include <string_view>

#include "video/encoder_kind.h"

namespace viewloom {

inline constexpr std::string_view kOpenH264Name = "openh264";

VideoEncoderKind openH264Kind();

}  // namespace viewloom
