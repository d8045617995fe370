// SPDX-License-Identifier: Apache-2.0
// A live MP4 (ISO 14496-12, 8.8): a head without pictures, then one fragment for each picture.
#pragma once

#include <cstdint>
#include <vector>

#include "mp4/avc_track.h"
#include "mp4/movie_boxes.h"

namespace viewloom {

// The bytes before the first fragment.
std::vector<uint8_t> makeFragmentsHead(const AvcTrack& track, const MovieTags& tags);

struct FragmentTimes {
  uint32_t number = 1;  // of the fragment, from 1
  uint64_t begin_ticks = 0;
  uint32_t duration_ticks = 0;
};

// A fragment up to its sample, whose bytes follow it.
std::vector<uint8_t> makeFragmentHead(const AvcSample& sample, const FragmentTimes& times);

}  // namespace viewloom
