// SPDX-License-Identifier: Apache-2.0
// The beginning of an MP4 file whose index stands before its pictures ("fast start").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mp4/avc_track.h"
#include "mp4/movie_boxes.h"

namespace viewloom {

// A picture in a file. Samples follow each other without gaps.
struct MovieSample {
  uint32_t size_bytes = 0;
  uint32_t duration_ticks = 0;  // until the next one
  bool is_sync = false;
};

// All bytes before the samples: file type, index, and the header of the media data. Expects at
// least one sample. Sizes and offsets have 64 bits where 32 bits do not hold them.
std::vector<uint8_t> makeMovieHead(const AvcTrack& track, const MovieTags& tags,
                                   std::span<const MovieSample> samples);

}  // namespace viewloom
