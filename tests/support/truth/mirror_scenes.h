// SPDX-License-Identifier: Apache-2.0
// Scenes with mirrors, to look at from the origin along -z, and from around it. The same at every
// call.
#pragma once

#include "support/truth/scene.h"

namespace viewloom::truth {

// A closed room, 4.5 m deep, in which balls, boxes and a pillar stand on a mirror. `roughness`: of
// that.
Scene mirrorFloor(double roughness);

// The same room with a floor that mirrors nothing, and a ball that does.
Scene mirrorSphere();

// The same room, with a mirror at each side, which face each other.
Scene facingMirrors();

}  // namespace viewloom::truth
