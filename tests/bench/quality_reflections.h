// SPDX-License-Identifier: Apache-2.0
// What reflections are worth, on scenes of exact surfaces that mirror each other.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "frame/stage_times.h"
#include "gpu/device.h"

namespace viewloom::bench {

// PSNR of the px of mirrors, dB, sRGB: over those that mirror what some layer of the source holds,
// and over all.
struct MirrorPsnr {
  double known_db = 0;
  double all_db = 0;
};

// Of one view of a scene.
struct ReflectionScore {
  std::string scene;
  std::string view;
  double known_share = 0;  // of the px of mirrors
  MirrorPsnr without;      // the effect
  MirrorPsnr got;
  ReflectionCounts counts;
};

std::vector<ReflectionScore> reflectionScores(const Device& device);

nlohmann::ordered_json qualityOfReflections(const Device& device);

}  // namespace viewloom::bench
