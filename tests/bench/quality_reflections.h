// SPDX-License-Identifier: Apache-2.0
// Value of reflections, on scenes of exact surfaces that mirror each other.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/mirror_loads.h"
#include "frame/stage_times.h"
#include "gpu/device.h"

namespace viewloom::bench {

// Score of one view of a scene, by one set of sources.
struct ReflectionScore {
  std::string scene;
  std::string sources;
  std::string view;
  double known_share = 0;      // of the px of mirrors, by the first source
  double elsewhere_share = 0;  // and by others alone
  MirrorPsnr without;          // the effect
  MirrorPsnr alone;            // the first source of several
  MirrorPsnr got;
  ReflectionCounts counts;
};

std::vector<ReflectionScore> reflectionScores(const Device& device);

nlohmann::ordered_json qualityOfReflections(const Device& device);

}  // namespace viewloom::bench
