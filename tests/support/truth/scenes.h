// SPDX-License-Identifier: Apache-2.0
// Scenes to look at from the origin along -z, and from around it. The same at every call.
#pragma once

#include "support/truth/scene.h"

namespace viewloom::truth {

// A closed room, 1.4..5.5 m deep: a table, a chair, shelves, balls, rods, some of them moving.
Scene clutteredRoom();

// Wires, rods and slats 2..30 mm thick, 1.5..3.5 m away, before a wall.
Scene thinStructures();

// Ground, gentle hills and the sky; nothing nearer than 3 m and few edges.
Scene largeSmooth();

}  // namespace viewloom::truth
