// SPDX-License-Identifier: Apache-2.0
// One way to make all views of a load. Every contestant makes the whole atlas in colour, in memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "bench/bench_load.h"

namespace viewloom::bench {

// [row][column] of the atlas.
struct Picture {
  std::vector<uint32_t> rgba;  // sRGB, red in the low byte
  std::vector<float> inv_z;    // of the hit, in the source, 1/m; kNoSurface: no hit
};

// Thread-safety: none; may use threads of its own.
class Contestant {
 public:
  virtual ~Contestant() = default;

  virtual std::string_view name() const = 0;
  // Whether it can make the views of a load at all.
  virtual bool takes(const BenchLoad& load) const = 0;
  // Allocates, uploads, compiles: not timed. `load` outlives what follows.
  virtual void prepare(const BenchLoad& load) = 0;
  // Everything that a new frame of the same shape needs before its first ray. Returns when done.
  virtual void build() = 0;
  // All views, in colour. Returns when done.
  virtual void trace() = 0;
  // Picture of the last trace; not timed, and may trace again for inv_z.
  virtual Picture picture() = 0;
};

}  // namespace viewloom::bench
