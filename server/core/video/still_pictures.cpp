// SPDX-License-Identifier: Apache-2.0
#include "video/still_pictures.h"

#include <algorithm>
#include <optional>

#include "base/str_cat.h"
#include "video/annex_b.h"
#include "video/h264_parameters.h"
#include "video/unit_bits.h"
#include "video/video_decoder.h"
#include "video/video_encoder.h"

namespace viewloom {
namespace {

// Parameter sets, slices, delimiters and supplements of one picture together.
constexpr uint32_t kStillUnitsMax = 64;
constexpr size_t kSliceHeadBytes = 16;  // more than the first two numbers of a slice take
constexpr size_t kStartCodeBytes = 3;

absl::Status refuseStill(std::string_view problem, std::string_view remedy) {
  return absl::InvalidArgumentError(strCat("the H.264 ", problem, "; ", remedy));
}

std::string stillText(SizePx size_px) {
  return strCat(size_px.width, "x", size_px.height, " px");
}

absl::Status checkStillColor(const H264Color& color) {
  constexpr uint8_t kBt470bg = 5;  // the same weights as BT.601 of 525 lines
  constexpr uint8_t kSmpte170m = 6;
  const bool is_bt601 = color.matrix == kBt470bg || color.matrix == kSmpte170m;
  if (color.is_full_range && is_bt601) return absl::OkStatus();
  return refuseStill(
      strCat("says ", color.is_full_range ? "full" : "limited", " range and colour matrix ",
             int{color.matrix}),
      "accepted is full range with the weights of BT.601 (matrix 5 or 6): set both in the "
      "encoder");
}

absl::Status checkStillSize(SizePx size_px, uint32_t row, SizePx whole_px) {
  const uint32_t rows_left = whole_px.height - row;
  if (size_px.width != whole_px.width || size_px.height > rows_left) {
    return refuseStill(strCat("has a picture of ", stillText(size_px), " at row ", row),
                       strCat("accepted is ", whole_px.width, " px of width and up to ", rows_left,
                              " px of height, the declared size with even sides: declare the "
                              "size that is encoded"));
  }
  if (size_px.area() > kVideoAreaMax_px || size_px.height < kVideoSideMin_px ||
      size_px.width < kVideoSideMin_px) {
    return refuseStill(
        strCat("has a picture of ", stillText(size_px)),
        strCat("accepted are sides of at least ", kVideoSideMin_px, " px and up to ",
               kVideoAreaMax_px, " px together: cut the plane into pictures below each other"));
  }
  return absl::OkStatus();
}

// Takes units in their order, and gives pictures.
class StillSplitter {
 public:
  explicit StillSplitter(SizePx plane_px) : whole_px_(stillSize(plane_px)) {}

  absl::Status take(std::span<const uint8_t> unit) {
    if (++unit_count_ > kStillUnitsMax) {
      return refuseStill(strCat("has more than ", kStillUnitsMax, " units in a picture"),
                         "use fewer slices and supplements");
    }
    switch (NalUnit{unit}.type()) {
      case NalType::kDelimiter:
      case NalType::kSupplement:
        return absl::OkStatus();
      case NalType::kSequenceParameters:
        return takeParameters(unit);
      case NalType::kPictureParameters:
        if (begin_) return absl::OkStatus();
        break;
      case NalType::kIdrSlice:
        return takeSlice(unit);
      default:
        break;
    }
    return refuseStill(strCat("has a unit of type ", int(NalUnit{unit}.type()),
                              begin_ ? "" : " before a sequence parameter set"),
                       "accepted are IDR pictures, each with its parameter sets before it: make "
                       "every picture a key frame");
  }

  absl::StatusOr<std::vector<StillPicture>> end() {
    VIEWLOOM_RETURN_IF_ERROR(endPicture());
    if (row_ == whole_px_.height) return std::move(pictures_);
    return refuseStill(
        strCat("has pictures of ", row_, " rows together"),
        strCat("accepted are ", whole_px_.height, ", the declared height: send all pictures"));
  }

 private:
  absl::Status takeParameters(std::span<const uint8_t> unit) {
    if (begin_ && slice_count_ == 0) {
      return refuseStill("has two sequence parameter sets before a picture", "accepted is one");
    }
    VIEWLOOM_RETURN_IF_ERROR(endPicture());
    const absl::StatusOr<H264Parameters> parameters = parseH264Parameters(unit);
    VIEWLOOM_RETURN_IF_ERROR(parameters.status());
    VIEWLOOM_RETURN_IF_ERROR(checkStillColor(parameters->color));
    VIEWLOOM_RETURN_IF_ERROR(checkStillSize(parameters->size_px, row_, whole_px_));
    if (parameters->reference_count > kVideoReferencesMax) {
      return refuseStill(strCat("keeps ", parameters->reference_count, " pictures"),
                         strCat("accepted are up to ", kVideoReferencesMax,
                                ": set the number of reference frames to 1"));
    }
    begin_ = unit.data() - kStartCodeBytes;
    size_px_ = parameters->size_px;
    unit_count_ = 1;
    return absl::OkStatus();
  }

  absl::Status takeSlice(std::span<const uint8_t> unit) {
    if (!begin_) return refuseStill("has a slice without parameter sets", "send them before it");
    UnitBits bits(unit.first(std::min(unit.size(), kSliceHeadBytes)));
    bits.bits(8);
    const uint32_t first_macroblock = bits.number();
    const uint32_t slice_type = bits.number();
    constexpr uint32_t kIntra = 2;
    if (slice_type % 5 != kIntra || !bits.isWhole()) {
      return refuseStill(strCat("has a slice of type ", slice_type),
                         "accepted are I slices: make every picture a key frame");
    }
    const bool follows =
        slice_count_ == 0 ? first_macroblock == 0 : first_macroblock > last_first_macroblock_;
    if (!follows || slice_count_ == kStillSlicesMax) {
      return refuseStill(
          strCat("has slice ", slice_count_, " of a picture at macroblock ", first_macroblock),
          strCat("accepted are up to ", kStillSlicesMax,
                 " slices of one picture in order: encode one picture for each "
                 "sequence parameter set"));
    }
    ++slice_count_;
    last_first_macroblock_ = first_macroblock;
    end_ = unit.data() + unit.size();
    return absl::OkStatus();
  }

  absl::Status endPicture() {
    if (!begin_) return absl::OkStatus();
    if (slice_count_ == 0) return refuseStill("has parameter sets without a picture", "send both");
    pictures_.push_back({.access_unit = {begin_, end_}, .size_px = size_px_});
    row_ += size_px_.height;
    begin_ = nullptr;
    slice_count_ = 0;
    return absl::OkStatus();
  }

  const SizePx whole_px_;
  std::vector<StillPicture> pictures_;
  uint32_t row_ = 0;                // px, of the picture that is being read
  const uint8_t* begin_ = nullptr;  // start code of its parameter set; null = there is none
  const uint8_t* end_ = nullptr;    // behind its last slice
  SizePx size_px_;
  uint32_t unit_count_ = 0;
  uint32_t slice_count_ = 0;
  uint32_t last_first_macroblock_ = 0;
};

}  // namespace

SizePx stillSize(SizePx plane_px) {
  return {plane_px.width + plane_px.width % 2, plane_px.height + plane_px.height % 2};
}

absl::StatusOr<std::vector<StillPicture>> stillPicturesOf(std::span<const uint8_t> stream,
                                                          SizePx plane_px) {
  StillSplitter splitter(plane_px);
  NalReader reader(stream);
  while (const std::optional<NalUnit> unit = reader.next()) {
    VIEWLOOM_RETURN_IF_ERROR(splitter.take(unit->bytes));
  }
  return splitter.end();
}

}  // namespace viewloom
