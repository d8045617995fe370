// SPDX-License-Identifier: Apache-2.0
// Value of atlases between the frames of a stream, on synthetic sequences with dropped frames.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "gpu/device.h"

namespace viewloom::bench {

// PSNR of the frames that were dropped, dB, sRGB, all px; means over the sequence.
struct TimeScore {
  std::string sequence;
  std::string mode;
  uint32_t kept_one_of = 2;
  double repeated_db = 0;  // the last frame once more
  double warped_db = 0;    // its px moved to where the display stands, holes filled along rows
  double blended_db = 0;   // moved so, but with colours in proportion between px
  double got_db = 0;
  // The dropped frames themselves, traced: of sequences of several sources.
  std::optional<double> traced_db = std::nullopt;
};

std::vector<TimeScore> timeScores(const Device& device);

nlohmann::ordered_json qualityOfTime(const Device& device);

}  // namespace viewloom::bench
