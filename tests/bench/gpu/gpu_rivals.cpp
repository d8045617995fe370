// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/gpu_rivals.h"

namespace viewloom::bench {

std::vector<std::unique_ptr<Contestant>> makeGpuRivals(const Device& device) {
  std::vector<std::unique_ptr<Contestant>> rivals;
  rivals.push_back(makeDda(device));
  rivals.push_back(makeHiZ(device));
  rivals.push_back(makeFloor(device));
  rivals.push_back(makeCopy(device));
  return rivals;
}

}  // namespace viewloom::bench
