// SPDX-License-Identifier: Apache-2.0
// Synthetic sequences: what a camera truly sees from frame to frame.
#pragma once

#include <cstdint>
#include <string>

#include "scoring/image_score.h"
#include "support/truth/picture.h"

namespace viewloom::bench {

inline constexpr double kSequenceRate_hz = 60;

// A scene, and the path of the camera through it.
struct Sequence {
  std::string name;
  truth::Scene scene;
  Pose (*camera_at)(double time_s);
};

// A room in which nothing moves, seen by a camera in a hand.
Sequence movingCamera();
// The same room with things that fly, roll and turn, seen by a camera that stands.
Sequence movingThings();

inline constexpr SizePx kSequence_px{320, 240};

Intrinsics sequenceIntrinsics();

// Frame `index` of the sequence, with so many layers.
truth::Picture pictureOf(const Sequence& sequence, uint32_t index, uint32_t layer_count);

// The first layer, sRGB-encoded.
ScoredImage imageOf(const truth::Picture& picture);

// The picture's first layer, px by px moved to a camera of the same size; the nearest stays. Holes
// take the farther of their neighbours in the row.
ScoredImage rowWarp(const truth::Picture& picture, const Pose& camera);

double psnrDb(const ScoredImage& got, const ScoredImage& truth);

}  // namespace viewloom::bench
