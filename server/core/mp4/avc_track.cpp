// SPDX-License-Identifier: Apache-2.0
#include "mp4/avc_track.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/str_cat.h"
#include "video/annex_b.h"

namespace viewloom {
namespace {

absl::Status refuseUnit(std::string_view problem) {
  return absl::InvalidArgumentError(strCat("H.264 for a file: ", problem));
}

// Takes the only set of a kind. The lengths in a file have 16 bits.
absl::Status takeSet(const NalUnit& unit, std::vector<uint8_t>& set) {
  if (unit.bytes.size() > std::numeric_limits<uint16_t>::max()) {
    return refuseUnit(strCat("a parameter set of ", unit.bytes.size(), " bytes"));
  }
  if (!set.empty() && !std::ranges::equal(set, unit.bytes)) {
    return refuseUnit("there is more than one parameter set of a kind");
  }
  set.assign(unit.bytes.begin(), unit.bytes.end());
  return absl::OkStatus();
}

absl::Status takeUnit(const NalUnit& unit, const AvcParameterSets& sets, AvcSample& sample) {
  switch (unit.type()) {
    case NalType::kDelimiter:
      return absl::OkStatus();
    case NalType::kSequenceParameters:
      if (std::ranges::equal(unit.bytes, sets.sequence)) return absl::OkStatus();
      return refuseUnit("the sequence parameters of the stream have changed");
    case NalType::kPictureParameters:
      if (std::ranges::equal(unit.bytes, sets.picture)) return absl::OkStatus();
      return refuseUnit("the picture parameters of the stream have changed");
    default:
      break;
  }
  sample.is_sync |= unit.type() == NalType::kIdrSlice;
  for (int shift = 24; shift >= 0; shift -= 8) {
    sample.bytes.push_back(uint8_t(unit.bytes.size() >> shift));
  }
  sample.bytes.insert(sample.bytes.end(), unit.bytes.begin(), unit.bytes.end());
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<AvcTrack> readAvcTrack(std::span<const uint8_t> access_unit) {
  AvcTrack track;
  for (const NalUnit& unit : nalUnits(access_unit)) {
    if (unit.type() == NalType::kSequenceParameters) {
      VIEWLOOM_RETURN_IF_ERROR(takeSet(unit, track.sets.sequence));
    }
    if (unit.type() == NalType::kPictureParameters) {
      VIEWLOOM_RETURN_IF_ERROR(takeSet(unit, track.sets.picture));
    }
  }
  if (track.sets.sequence.empty() || track.sets.picture.empty()) {
    return refuseUnit("the first picture has no parameter sets");
  }
  absl::StatusOr<H264Parameters> parameters = parseH264Parameters(track.sets.sequence);
  VIEWLOOM_RETURN_IF_ERROR(parameters.status());
  track.parameters = *std::move(parameters);
  return track;
}

absl::StatusOr<AvcSample> makeAvcSample(std::span<const uint8_t> access_unit,
                                        const AvcParameterSets& sets) {
  AvcSample sample;
  bool has_picture = false;
  for (const NalUnit& unit : nalUnits(access_unit)) {
    if (unit.bytes.size() > std::numeric_limits<uint32_t>::max()) {
      return refuseUnit("a unit of 4 GiB or more");
    }
    VIEWLOOM_RETURN_IF_ERROR(takeUnit(unit, sets, sample));
    has_picture |= unit.type() == NalType::kSlice || unit.type() == NalType::kIdrSlice;
  }
  if (!has_picture) return refuseUnit("the bytes hold no picture");
  return sample;
}

}  // namespace viewloom
