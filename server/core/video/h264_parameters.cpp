// SPDX-License-Identifier: Apache-2.0
#include "video/h264_parameters.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_format.h"
#include "base/check.h"
#include "base/str_cat.h"
#include "video/annex_b.h"
#include "video/picture_limit.h"
#include "video/unit_bits.h"

namespace viewloom {
namespace {

constexpr uint32_t kMacroblock_px = 16;
constexpr uint8_t kHighProfile = 100;
constexpr uint32_t kExtendedAspect = 255;  // Extended_SAR of table E-1

absl::Status refuse(std::string_view problem) {
  return absl::InvalidArgumentError(strCat("H.264 parameter set: ", problem));
}

void skipTiming(UnitBits& bits) {
  bits.bits(32);  // num_units_in_tick
  bits.bits(32);  // time_scale
  bits.flag();    // fixed_frame_rate_flag
}

// hrd_parameters() of E.1.2.
void skipHrd(UnitBits& bits) {
  const uint32_t count = std::min(bits.number() + 1, uint32_t{32});
  bits.bits(8);
  for (uint32_t i = 0; i < count; ++i) {
    bits.number();
    bits.number();
    bits.flag();
  }
  bits.bits(20);
}

void readColor(UnitBits& bits, H264Color& color) {
  bits.bits(3);  // video_format
  color.is_full_range = bits.flag();
  if (!bits.flag()) return;
  color.primaries = uint8_t(bits.bits(8));
  color.transfer = uint8_t(bits.bits(8));
  color.matrix = uint8_t(bits.bits(8));
}

// vui_parameters() of E.1.1.
void readUsability(UnitBits& bits, H264Parameters& parameters) {
  if (bits.flag() && bits.bits(8) == kExtendedAspect) bits.bits(32);
  if (bits.flag()) bits.flag();  // overscan
  if (bits.flag()) readColor(bits, parameters.color);
  if (bits.flag()) {  // places of chroma samples
    bits.number();
    bits.number();
  }
  if (bits.flag()) skipTiming(bits);
  const bool has_nal_hrd = bits.flag();
  if (has_nal_hrd) skipHrd(bits);
  const bool has_vcl_hrd = bits.flag();
  if (has_vcl_hrd) skipHrd(bits);
  if (has_nal_hrd || has_vcl_hrd) bits.flag();
  bits.flag();               // pic_struct_present_flag
  if (!bits.flag()) return;  // bitstream_restriction_flag
  bits.flag();
  for (int i = 0; i < 4; ++i) bits.number();
  parameters.reorder_count = bits.number();
}

// Fields that only some profiles have. Scaling lists and samples of other forms are not served.
absl::Status readHighProfile(UnitBits& bits) {
  if (bits.number() != 1) return refuse("the chroma is not 4:2:0");
  if (bits.number() != 0 || bits.number() != 0) return refuse("samples have more than 8 bits");
  bits.flag();
  if (bits.flag()) return refuse("it has scaling lists, which are not accepted");
  return absl::OkStatus();
}

absl::Status readPictureOrder(UnitBits& bits) {
  switch (bits.number()) {
    case 0:
      bits.number();
      return absl::OkStatus();
    case 2:
      return absl::OkStatus();
    default:
      return refuse("the order of its pictures is of type 1, which is not accepted");
  }
}

absl::Status readSize(UnitBits& bits, H264Parameters& parameters) {
  // A side of more px would exceed every level (A.3.1).
  constexpr uint32_t kSideMax_mb = 1055;
  const uint32_t width_mb = bits.number() + 1;
  const uint32_t height_mb = bits.number() + 1;
  if (width_mb > kSideMax_mb || height_mb > kSideMax_mb || width_mb == 0 || height_mb == 0) {
    return refuse("the size of its pictures exceeds every level");
  }
  if (!bits.flag()) return refuse("pictures are fields; accepted are whole frames");
  bits.flag();  // direct_8x8_inference_flag
  SizePx& size_px = parameters.size_px;
  size_px = {width_mb * kMacroblock_px, height_mb * kMacroblock_px};
  if (!bits.flag()) return absl::OkStatus();
  std::array<uint32_t, 4> crop_px = {};  // left, right, top, bottom
  for (uint32_t& px : crop_px) px = std::min(bits.number(), size_px.width + size_px.height) * 2;
  if (crop_px[0] + crop_px[1] >= size_px.width || crop_px[2] + crop_px[3] >= size_px.height) {
    return refuse("pictures are cropped to nothing");
  }
  size_px.width -= crop_px[0] + crop_px[1];
  size_px.height -= crop_px[2] + crop_px[3];
  return absl::OkStatus();
}

// Level, and its MaxFS: macroblocks of a picture.
struct LevelLimit {
  uint32_t level;
  uint32_t macroblocks_max;
};
constexpr LevelLimit kLevels[] = {{10, 99},    {11, 396},   {21, 792},   {22, 1620},
                                  {31, 3600},  {32, 5120},  {40, 8192},  {42, 8704},
                                  {50, 22080}, {51, 36864}, {60, 139264}};

}  // namespace

absl::StatusOr<H264Parameters> parseH264Parameters(std::span<const uint8_t> unit) {
  if (unit.size() < 4) return refuse(strCat("it has ", unit.size(), " bytes"));
  H264Parameters parameters;
  UnitBits bits(unit);
  bits.bits(8);
  parameters.profile = uint8_t(bits.bits(8));
  parameters.constraints = uint8_t(bits.bits(8));
  parameters.level = uint8_t(bits.bits(8));
  bits.number();
  if (parameters.profile == kHighProfile) {
    VIEWLOOM_RETURN_IF_ERROR(readHighProfile(bits));
  } else if (parameters.profile != 66 && parameters.profile != kMainProfile) {
    return refuse(strCat("its profile is ", parameters.profile,
                         "; accepted is baseline (66), main (77) or high (100)"));
  }
  bits.number();  // log2_max_frame_num_minus4
  VIEWLOOM_RETURN_IF_ERROR(readPictureOrder(bits));
  parameters.reference_count = bits.number();
  bits.flag();  // gaps_in_frame_num_value_allowed_flag
  VIEWLOOM_RETURN_IF_ERROR(readSize(bits, parameters));
  if (bits.flag()) readUsability(bits, parameters);
  if (!bits.isWhole()) return refuse("it ends too early");
  return parameters;
}

absl::StatusOr<H264Parameters> h264ParametersOf(std::span<const uint8_t> stream) {
  for (const NalUnit& unit : nalUnits(stream)) {
    if (unit.type() == NalType::kSequenceParameters) return parseH264Parameters(unit.bytes);
  }
  return absl::InvalidArgumentError("H.264: there is no sequence parameter set");
}

uint32_t h264Level(SizePx size_px) {
  for (const LevelLimit& limit : kLevels) {
    constexpr uint64_t kArea_px = kMacroblock_px * kMacroblock_px;
    if (PictureLimit{.area_max_px = kArea_px * limit.macroblocks_max}.holds(size_px)) {
      return limit.level;
    }
  }
  failCheck(__FILE__, __LINE__, "a picture is within level 6");
}

std::string codedVideoString(SizePx size_px) {
  return h264CodecString({.profile = kMainProfile,
                          .constraints = kVideoConstraints,
                          .level = uint8_t(h264Level(size_px))});
}

std::string h264CodecString(const H264Parameters& parameters) {
  return absl::StrFormat("avc1.%02X%02X%02X", parameters.profile, parameters.constraints,
                         parameters.level);
}

}  // namespace viewloom
