// SPDX-License-Identifier: Apache-2.0
// True pictures of eyes that move before a scene of exact surfaces, beside the served ones.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "encode/encoded_band.h"
#include "frame/frame.h"
#include "support/truth/picture.h"
#include "support/truth/scene.h"

namespace viewloom::test {

// Score of one eye. PSNR in dB over sRGB codes, NaN where there is no such px.
struct EyeScore {
  double inside_db = 0;  // of px that a layer of the source holds, away from edges
  double known_db = 0;   // of px that a layer of the source holds
  double full_db = 0;    // of all
  // Share of the px away from edges whose 1/Z is more than 1 % off.
  double depth_off_share = 0;
  double outside_share = 0;          // of all px: they look past the source
  double outside_differs_share = 0;  // of all px away from edges: the mask says otherwise
};

// True picture of one eye.
class TrueEye {
 public:
  TrueEye(truth::Picture picture, std::vector<uint8_t> known, uint32_t layer_count)
      : picture_(std::move(picture)), known_(std::move(known)), layer_count_(layer_count) {}

  // Score of the view with that index in an atlas of RAW colour, depth and mask.
  EyeScore score(const EncodedAtlas& atlas, size_t view) const;

 private:
  const truth::Picture picture_;
  const std::vector<uint8_t> known_;  // as by truth::knownFrom()
  const uint32_t layer_count_;
};

// A source that stands in the world's origin and looks along -z.
class HeadTruth {
 public:
  HeadTruth(const truth::Scene& scene, SizePx source_px, double focal_px, uint32_t layer_count);

  // The source's layers, at time 0, of things that stand.
  FramePtr frame() const;
  // True picture for a display in the source's place: the eye's camera is relative to that, as it
  // was sent.
  TrueEye seenBy(const Camera& eye, SizePx eye_px) const;

 private:
  const truth::Instant instant_;
  const Camera source_;
  const SizePx source_px_;
  const uint32_t layer_count_;
};

// A field of view as wide as that of such a source: what eyes of any size see of it.
Fov fovOf(SizePx source_px, double focal_px);

}  // namespace viewloom::test
