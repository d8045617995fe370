// SPDX-License-Identifier: Apache-2.0
// Synthetic sequences: what a camera truly sees from frame to frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "scoring/image_score.h"
#include "support/truth/picture.h"

namespace viewloom::bench {

inline constexpr double kSequenceRate_hz = 60;

// A scene, and the path of the camera through it.
struct Sequence {
  std::string name;
  truth::Scene scene;
  Pose (*camera_at)(double time_s);
  // Bodies of the scene that have sources of their own, whose cameras go with them.
  std::vector<uint32_t> things = {};
};

// A room in which nothing moves, seen by a camera in a hand.
Sequence movingCamera();
// The room with its things that fly, roll and turn, seen by a camera that stands.
Sequence movingThings();
// These things twice as fast.
Sequence fastThings();
// The same as movingThings, but the camera sees the room alone, and each thing is a source of its
// own.
Sequence movingSources();

inline constexpr SizePx kSequence_px{320, 240};

Intrinsics sequenceIntrinsics();

// Frame `index` of the sequence, with so many layers, as it truly is.
truth::Picture pictureOf(const Sequence& sequence, uint32_t index, uint32_t layer_count);
// Frame of a stream: that picture, or the room's and the things'.
FramePtr frameOf(const Sequence& sequence, const truth::Picture& picture, uint32_t index,
                 uint32_t layer_count);

// The first layer, sRGB-encoded.
ScoredImage imageOf(const truth::Picture& picture);

// Colour that a px of a warp takes from the source: that of the px that came there, or a blend of
// neighbours at the place that has come to its middle.
enum class WarpedColor : uint8_t { kOfPx, kBetweenPx };

// The picture's first layer, px by px moved to a camera of the same size; the nearest stays. Holes
// take the farther of their neighbours in the row; rows of nothing but holes, the next row.
ScoredImage rowWarp(const truth::Picture& picture, const Pose& camera, WarpedColor color);

double psnrDb(const ScoredImage& got, const ScoredImage& truth);

}  // namespace viewloom::bench
