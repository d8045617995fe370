// SPDX-License-Identifier: Apache-2.0
// The scene that all pictures show, and the row of it that they cut through.
#pragma once

#include "frame/frame.h"
#include "oracle/scene_generator.h"
#include "oracle/view_generator.h"

namespace viewloom::pictures {

inline constexpr int kSceneSize_px = 64;
// Through a slanted board, behind which the wall is known, and a ball, behind which it is not.
inline constexpr int kDrawnRow = 30;
inline constexpr int kFirstDrawnColumn = 10;
inline constexpr int kDrawnColumns = 40;

// A wall, also behind the board as a second layer, a board and a ball before it.
oracle::Scene sceneToDraw();
// The same with colours: stripes on the wall, one colour each for what stands before it.
FramePtr frameToDraw();

// An eye to the right of the source, which looks along the drawn row; as many px as the source has.
oracle::OutputView viewToDraw();

}  // namespace viewloom::pictures
