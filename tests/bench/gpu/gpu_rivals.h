// SPDX-License-Identifier: Apache-2.0
// Rivals that run on the device that viewloom itself runs on, and the floors below both.
//
// dda, hiz  a hit where a ray meets a sample, kappa thick and constant over its px (in viewloom a
//           sample is a plane); colour is bilinear over the px within kappa of the one hit, of one
//           layer (lib/light/color.glsl follows links, which also lead to other layers), in the
//           same light. A px without a hit shows viewloom's fill, simplified: the surface before
//           the first silhouette that the ray passed behind, or the image's border.
// floor     viewloom's own colour of hits that are known beforehand
// copy      the bytes that viewloom's build must read and write, moved
#pragma once

#include <memory>
#include <vector>

#include "bench/contestant.h"
#include "gpu/device.h"

namespace viewloom::bench {

// The device must outlive them.
std::unique_ptr<Contestant> makeDda(const Device& device);
std::unique_ptr<Contestant> makeHiZ(const Device& device);
std::unique_ptr<Contestant> makeFloor(const Device& device);
std::unique_ptr<Contestant> makeCopy(const Device& device);
std::vector<std::unique_ptr<Contestant>> makeGpuRivals(const Device& device);

}  // namespace viewloom::bench
