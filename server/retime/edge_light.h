// SPDX-License-Identifier: Apache-2.0
// The light of px at edges, where a thing and what is behind it move differently: taken apart as
// the frame has it, and put together where the edge has gone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "base/worker_pool.h"
#include "retime/color_plane.h"
#include "retime/edge_sides.h"
#include "retime/moved_surfaces.h"

namespace viewloom {

inline constexpr uint32_t kNoSample = UINT32_MAX;

// Edge light of the first layer. Thread-safety: none; it shares its work among threads.
class EdgeLight {
 public:
  // Looks for the edges in surfaces that have been moved. Keeps its memory.
  void find(const MovedSurfaces& surfaces, WorkerPool& workers);

  // The light of what is behind, where a sample beside an edge holds some of the thing's, too.
  // nullptr: it is as it is, as are those of deeper layers.
  const Texel* cleanAt(uint32_t sample) const;
  // [px]: not 0 only where the first layer's sample may be clean.
  const uint32_t* rims() const { return rim_of_px_.data(); }

  // The first two layers as drawn.
  struct Drawn {
    const float* inv_z = nullptr;         // of the first
    const uint32_t* sample = nullptr;     // that most of its px is, kNoSample where nothing is
    const float* inv_z_behind = nullptr;  // nullptr: there is one layer
    ColorPlane behind;
    uint8_t* color = nullptr;  // of the first, to be changed
  };
  void blendInto(const MovedSurfaces& surfaces, const Drawn& drawn, WorkerPool& workers);

 private:
  // A px that an edge runs beside.
  struct Rim {
    uint32_t px = 0;
    uint32_t near_px = 0;  // of the thing: this px, or the one beside it
    uint32_t far_px = 0;   // of what is behind, likewise
    float share = 0;       // of the thing in the px's light
    Texel light{};         // of the thing, times its share
    Texel clean{};         // of what is behind
  };
  // Some of a thing.
  struct Part {
    float share = 0;
    Texel light{};
  };

  // Shares of a thing in the px that its light may come from.
  struct Shares {
    int x = 0;  // of the first
    int y = 0;
    // Pixels within reach each way, and as many for interpolation between them.
    static constexpr int kCount = 8;
    float shares[kCount][kCount];
  };

  std::optional<Rim> rimAt(const MovedSurfaces& surfaces, uint32_t px) const;
  void takeApart(const EdgeSides& sides, float apart, Rim& rim) const;
  bool isOfThing(const MovedSurfaces& surfaces, const Rim& rim, uint32_t sample) const;
  void findRims(const MovedSurfaces& surfaces, WorkerPool& workers);
  void offerAround(const MovedSurfaces& surfaces, const Rim& rim, std::vector<uint32_t>& reached);
  float shareOf(const MovedSurfaces& surfaces, const Rim& rim, uint32_t px) const;
  Shares sharesFrom(const MovedSurfaces& surfaces, const Rim& rim, const glm::dvec2& first_px,
                    const glm::dvec2& last_px) const;
  Part partAt(const MovedSurfaces& surfaces, const Rim& rim, const glm::dvec2& at_px) const;
  std::optional<Texel> blendAt(const MovedSurfaces& surfaces, const Drawn& drawn,
                               uint32_t px) const;

  ColorPlane color_;
  std::vector<std::vector<Rim>> found_;  // [row piece]
  std::vector<Rim> rims_;                // by px
  std::vector<uint32_t> rim_of_px_;      // [px]: 1 + its index, 0 = none
  std::vector<uint64_t> nearest_;  // [px]: of the rims that come near it, 1/Z before the number
  std::vector<uint32_t> reached_;  // px with one
};

}  // namespace viewloom
