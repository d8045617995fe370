// SPDX-License-Identifier: Apache-2.0
// H.264 as files hold it (ISO 14496-15): parameter sets apart, and units with their lengths.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/status.h"
#include "video/h264_parameters.h"

namespace viewloom {

// Sequence and picture parameter set, from their type bytes on.
struct AvcParameterSets {
  std::vector<uint8_t> sequence;
  std::vector<uint8_t> picture;

  bool operator==(const AvcParameterSets&) const = default;
};

// All that a file says of a track of H.264.
struct AvcTrack {
  AvcParameterSets sets;
  H264Parameters parameters;  // of the sequence parameter set
};

// Reads the sets of an access unit in Annex B format. INVALID_ARGUMENT unless it has one of each,
// of a kind that parseH264Parameters accepts.
absl::StatusOr<AvcTrack> readAvcTrack(std::span<const uint8_t> access_unit);

// A picture as a sample of a file.
struct AvcSample {
  std::vector<uint8_t> bytes;  // units with a length of four bytes before each
  bool is_sync = false;        // an IDR picture: players may begin with it
};

// Makes a sample of an access unit in Annex B format. The sets and delimiters are left out, because
// the file has them. INVALID_ARGUMENT if no picture is left, or if the unit has other sets than the
// track.
absl::StatusOr<AvcSample> makeAvcSample(std::span<const uint8_t> access_unit,
                                        const AvcParameterSets& sets);

}  // namespace viewloom
