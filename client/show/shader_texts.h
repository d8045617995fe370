// SPDX-License-Identifier: Apache-2.0
// The shaders of shaders/show as texts, what they include written out. A #version comes before
// them: they are OpenGL 3.3 and OpenGL ES 3.0 alike.
#pragma once

#include <string_view>

namespace viewloom::show {

extern const std::string_view kWindowVertex;
extern const std::string_view kWeaveFragment;
extern const std::string_view kPlaceFragment;
extern const std::string_view kTuneFragment;

}  // namespace viewloom::show
