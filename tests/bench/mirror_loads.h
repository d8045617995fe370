// SPDX-License-Identifier: Apache-2.0
// Scenes of exact surfaces that mirror each other, as sources see them and as they truly look.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "display/atlas_layout.h"
#include "display/effects.h"
#include "frame/frame.h"
#include "support/truth/mirrored.h"
#include "support/truth/scene.h"

namespace viewloom::bench {

struct MirrorView {
  const char* name;
  Camera camera;
};

inline constexpr SizePx kMirrorView_px{400, 300};  // as fine as the sources

// From where the first source stands, and from beside it.
std::vector<MirrorView> mirrorViews();

// Parts of a frame: pictures from these places; the last six may be those of a cube map.
struct Stand {
  const char* name;
  std::vector<truth::SourceCamera> cameras;
  bool has_cube = false;
};

struct MirrorScene {
  const char* name;
  truth::Scene scene;
  uint32_t bounce_count;
  uint32_t sample_count;      // of the truth, where surfaces are rough
  std::vector<Stand> stands;  // the first is of one source

  ReflectionSpec effect() const;
  std::vector<glm::vec3> truthOf(const truth::Instant& instant, const Camera& view) const;
};

std::vector<MirrorScene> mirrorScenes();

FramePtr frameOf(const truth::Instant& instant, const Stand& stand);

// Which source holds what the px of mirrors mirror.
struct HeldBy {
  std::vector<uint8_t> first;  // truth::mirroredKnownFrom
  std::vector<uint8_t> any;

  bool isMirror(size_t px) const { return first[px] != truth::kNoMirror; }
  bool isKnown(size_t px) const;
  bool isElsewhere(size_t px) const;
};

HeldBy heldBy(const truth::Instant& instant, const Stand& stand, const Camera& view);

// PSNR of the px of mirrors that the first source sees, dB, sRGB: over those that mirror what some
// layer of it holds, over those that mirror what others hold alone, over the rest, and over all.
// Not a number where there are none.
struct MirrorPsnr {
  double known_db = 0;
  double elsewhere_db = 0;
  double unknown_db = 0;
  double all_db = 0;
};

// Score of an atlas of one view. `linear`: float[height][width][4], sRGB-encoded.
MirrorPsnr mirrorPsnr(const AtlasLayout& layout, std::span<const float> linear,
                      const std::vector<glm::vec3>& truth, const HeldBy& held);

}  // namespace viewloom::bench
