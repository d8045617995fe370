// SPDX-License-Identifier: Apache-2.0
// Random sources with everything that is hard on a structure: seeded, equal on every machine.
#pragma once

#include <cstdint>
#include <iterator>
#include <string>

#include "oracle/oracle_source.h"

namespace viewloom::oracle {

// Equal numbers from equal seeds everywhere (the standard distributions promise that only per
// library).
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t bits();
  double uniform(double low, double high);  // [low, high)
  int integer(int low, int high);           // [low, high]
  bool chance(double probability) { return uniform(0, 1) < probability; }
  double normal();

 private:
  uint64_t state_;
};

struct Scene {
  std::string name;   // what it was made of, for messages
  InvZPlanes planes;  // as a publisher would send them: may be unsorted
  Pinhole pinhole;
  ConnectionTolerance kappa;
};

// Every size and kind comes up within a few dozen seeds.
Scene randomScene(uint64_t seed);

// How exact the structure of such a scene is asked for, px: each third seed the same.
inline double toleranceOfSeed_px(uint64_t seed) {
  constexpr double kTolerances_px[] = {0.25, 0.05, 0.01};
  return kTolerances_px[seed % std::size(kTolerances_px)];
}

// A scene of given size and layer count.
Scene randomScene(uint64_t seed, int width, int height, int layer_count);

// A smooth, slightly curved surface that fills the image.
Scene smoothScene(int width, int height, int layer_count);

// The same with blocks before it and layers close behind each other in places; rounded to codes, or
// with noise (odd seeds), so coarse that it is smoothed.
Scene coarseScene(uint64_t seed, int width, int height, int layer_count);

}  // namespace viewloom::oracle
