// SPDX-License-Identifier: Apache-2.0
#include "video/uniform_units.h"

#include <algorithm>
#include <array>

#include "base/str_cat.h"
#include "video/annex_b.h"
#include "video/h264_parameters.h"
#include "video/unit_bits.h"
#include "video/unit_writer.h"

namespace viewloom {
namespace {

constexpr uint8_t kBaselineProfile = 66;
constexpr uint8_t kAlsoMain = 0x40;  // constraint_set1_flag
constexpr std::array<uint8_t, 4> kLongStartCode = {0, 0, 0, 1};

absl::Status refuseStream(std::string_view problem) {
  return absl::FailedPreconditionError(strCat("its stream cannot be served: ", problem));
}

absl::Status checkSet(const H264Parameters& parameters, SizePx size_px) {
  const bool is_main =
      parameters.profile == kMainProfile ||
      (parameters.profile == kBaselineProfile && (parameters.constraints & kAlsoMain) != 0);
  if (!is_main) {
    return refuseStream(strCat("its profile is ", parameters.profile, "; served is main (77)"));
  }
  if (parameters.size_px != size_px) {
    return refuseStream(strCat("its pictures have ", parameters.size_px.width, "x",
                               parameters.size_px.height, " px instead of ", size_px.width, "x",
                               size_px.height));
  }
  if (parameters.reference_count > 1) {
    return refuseStream(strCat("a picture refers to ", parameters.reference_count,
                               " others; served is one, the picture before"));
  }
  return absl::OkStatus();
}

// From one unit to another.
class SetCopy {
 public:
  SetCopy(UnitBits& from, UnitWriter& to) : from_(from), to_(to) {}

  uint32_t number() {
    const uint32_t value = from_.number();
    to_.number(value);
    return value;
  }
  bool flag() {
    const bool value = from_.flag();
    to_.flag(value);
    return value;
  }

 private:
  UnitBits& from_;
  UnitWriter& to_;
};

// vui_parameters() of E.1.1, as OpenH264 writes them.
void writeUsability(UnitWriter& to) {
  constexpr uint32_t kFormatNotSaid = 5;
  to.flag(false);  // aspect ratio
  to.flag(false);  // overscan
  to.flag(true);   // video signal
  to.bits(kFormatNotSaid, 3);
  to.flag(kVideoColor.is_full_range);
  to.flag(true);  // colour description
  to.bits(kVideoColor.primaries, 8);
  to.bits(kVideoColor.transfer, 8);
  to.bits(kVideoColor.matrix, 8);
  to.flag(false);  // places of chroma samples
  to.flag(false);  // timing
  to.flag(false);  // NAL HRD
  to.flag(false);  // VCL HRD
  to.flag(false);  // pic_struct
  to.flag(true);   // restrictions
  to.flag(true);   // motion vectors over picture boundaries
  to.number(0);    // max_bytes_per_pic_denom
  to.number(0);    // max_bits_per_mb_denom
  to.number(16);   // log2_max_mv_length_horizontal
  to.number(16);   // log2_max_mv_length_vertical
  to.number(0);    // max_num_reorder_frames
  to.number(1);    // max_dec_frame_buffering
}

void appendUnit(std::span<const uint8_t> unit, std::vector<uint8_t>& to) {
  to.insert(to.end(), kLongStartCode.begin(), kLongStartCode.end());
  to.insert(to.end(), unit.begin(), unit.end());
}

}  // namespace

absl::StatusOr<std::vector<uint8_t>> uniformParameterSet(std::span<const uint8_t> unit,
                                                         SizePx size_px) {
  const absl::StatusOr<H264Parameters> parameters = parseH264Parameters(unit);
  if (!parameters.ok()) return refuseStream(strCat(parameters.status().message()));
  VIEWLOOM_RETURN_IF_ERROR(checkSet(*parameters, size_px));
  UnitBits from(unit);
  UnitWriter to;
  SetCopy copy(from, to);
  to.bits(from.bits(8), 8);
  from.bits(24);
  to.bits(kMainProfile, 8);
  to.bits(kVideoConstraints, 8);
  to.bits(h264Level(size_px), 8);
  copy.number();                          // seq_parameter_set_id
  copy.number();                          // log2_max_frame_num_minus4
  if (copy.number() == 0) copy.number();  // order of pictures; type 1 was refused
  copy.number();                          // max_num_ref_frames
  copy.flag();                            // gaps_in_frame_num_value_allowed_flag
  copy.number();                          // width
  copy.number();                          // height
  copy.flag();                            // frame_mbs_only_flag: fields were refused
  copy.flag();                            // direct_8x8_inference_flag
  if (copy.flag()) {                      // cropping
    for (int i = 0; i < 4; ++i) copy.number();
  }
  to.flag(true);
  writeUsability(to);
  return to.finish();
}

absl::Status writeUniformUnit(std::span<const uint8_t> coded, SizePx size_px, bool is_idr,
                              std::vector<uint8_t>& access_unit) {
  access_unit.clear();
  bool has_sequence_set = false;
  bool has_picture_set = false;
  bool has_idr_slice = false;
  bool has_other_slice = false;
  NalReader units(coded);
  while (const std::optional<NalUnit> unit = units.next()) {
    switch (unit->type()) {
      case NalType::kSequenceParameters: {
        const auto set = uniformParameterSet(unit->bytes, size_px);
        VIEWLOOM_RETURN_IF_ERROR(set.status());
        appendUnit(*set, access_unit);
        has_sequence_set = true;
        continue;
      }
      case NalType::kPictureParameters:
        has_picture_set = true;
        break;
      case NalType::kIdrSlice:
        has_idr_slice = true;
        break;
      case NalType::kSlice:
        has_other_slice = true;
        break;
      default:
        continue;
    }
    appendUnit(unit->bytes, access_unit);
  }
  if (has_idr_slice == has_other_slice) return refuseStream("a picture is not one whole picture");
  if (is_idr && !has_idr_slice)
    return refuseStream("a picture refers to another, which was not asked");
  if (has_idr_slice && (!has_sequence_set || !has_picture_set)) {
    return refuseStream("a picture that others refer to has no parameter sets");
  }
  return absl::OkStatus();
}

}  // namespace viewloom
