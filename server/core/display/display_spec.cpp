// SPDX-License-Identifier: Apache-2.0
#include "display/display_spec.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "video/quantisation.h"

namespace viewloom {
namespace {

// By quality: draft, balanced, best.
constexpr std::array<double, 3> kTolerances_px = {1, kDefaultTolerance_px, 0.0625};

absl::Status checkFocusFollowing(const DisplaySpec& spec) {
  if (spec.focus_following_s == 0) return absl::OkStatus();
  if (withFocalDistance(spec, 1)) return absl::OkStatus();
  return invalidField(
      "focus_following_s",
      "this display has no focal plane that could follow the content; accepted is a quilt, stereo "
      "without given or tracked eyes, a grid of cameras or a lenticular panel");
}

struct MatchedQp {
  uint32_t jpeg_quality;
  uint32_t qp;
};
// Measured on the built-in scene (tests/performance.md). The last two would be finer than encoders
// are safe with (video/quantisation.h).
constexpr MatchedQp kMatchedQps[] = {{1, kVideoQpMax},  {10, 44},          {25, 38}, {50, 32},
                                     {60, 30},          {75, 27},          {85, 24}, {90, 21},
                                     {95, kVideoQpMin}, {100, kVideoQpMin}};

absl::Status refuseVideo(std::string_view what, std::string_view problem) {
  return invalidField("color", strCat("H264 is for views, and ", what, " ", problem,
                                      "; accepted are JPEG, JPEG_PLANES, ZSTD or RAW"));
}

absl::Status validateVideoOf(const DisplaySpec& spec) {
  if (std::holds_alternative<LenticularSpec>(spec.kind)) {
    return refuseVideo("a lenticular panel", "has another view in each subpixel");
  }
  if (std::holds_alternative<IntegralSpec>(spec.kind)) {
    return refuseVideo("a panel behind microlenses", "has another view in each pixel");
  }
  if (std::holds_alternative<RgbdSpec>(spec.kind)) {
    return refuseVideo("an RGBD display", "has depth, which video would change");
  }
  const TileGrid grid = tileGridOf(spec);
  const absl::Status planned = planVideoStack(grid.tile_size_px, grid.view_count).status();
  return planned.ok() ? planned : withFieldPrefix(planned, "color");
}

// A visitor that notes the range of every number.
class RangeNotes {
 public:
  template <typename Number>
  void operator()(const char* name, const Number&, const Range& range) {
    ranges_[prefix_ + name] = range;
  }
  void operator()(const char* name, SizePx, const Range& range) {
    ranges_[strCat(prefix_, name, ".width")] = range;
    ranges_[strCat(prefix_, name, ".height")] = range;
  }
  void operator()(const char*, bool) {}
  template <typename... Parts>
  void word(const char*, const Parts&...) {}
  template <typename... Parts>
  void label(const char*, const Parts&...) {}
  void color(const char*, uint32_t) {}
  void cameras(const char*, const std::vector<ViewCamera>&, const Range&) {}
  void pose(const char*, const std::optional<Pose>&) {}
  template <typename Spec>
  void part(const char* name, const std::optional<Spec>&) {
    group(name, [&] {
      Spec any;
      visitFields(any, *this);
    });
  }
  template <typename Function>
  void group(const char* name, const Function& visit) {
    const std::string outer = prefix_;
    prefix_ += strCat(name, ".");
    visit();
    prefix_ = outer;
  }
  void kind(const DisplayKind&) {
    forEachKind([this](const auto& spec) { part(spec.kName, std::optional(spec)); });
  }
  template <typename Function>
  void made(const Function&) {}

  std::map<std::string, Range, std::less<>> take() { return std::move(ranges_); }

 private:
  std::string prefix_;
  std::map<std::string, Range, std::less<>> ranges_;
};

}  // namespace

const std::map<std::string, Range, std::less<>>& fieldRanges() {
  static const auto kRanges = [] {
    RangeNotes notes;
    const DisplaySpec any;
    visitFields(any, notes);
    return notes.take();
  }();
  return kRanges;
}

Range rangeOf(std::string_view field) {
  const auto found = fieldRanges().find(field);
  VIEWLOOM_CHECK(found != fieldRanges().end());
  return found->second;
}

std::optional<DisplaySpec> withFocalDistance(DisplaySpec spec, double focal_distance_m) {
  double* const place = std::visit([](auto& kind) { return focalPlane(kind); }, spec.kind);
  if (place == nullptr) return std::nullopt;
  *place = focal_distance_m;
  return spec;
}

absl::StatusOr<DisplaySpec> completeDisplaySpec(DisplaySpec spec) {
  VIEWLOOM_RETURN_IF_ERROR(std::visit([](auto& kind) { return takePreset(kind); }, spec.kind));
  FieldChecks checks;
  visitFields(std::as_const(spec), checks);
  VIEWLOOM_RETURN_IF_ERROR(checks.status());
  VIEWLOOM_RETURN_IF_ERROR(std::visit([](auto& kind) { return settle(kind); }, spec.kind));
  VIEWLOOM_RETURN_IF_ERROR(checkFocusFollowing(spec));
  if (spec.lens) {
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(settle(*spec.lens, spec.quality), "effects.lens"));
  }
  if (spec.temporal) settle(*spec.temporal);
  if (spec.reflection) settle(*spec.reflection, spec.quality);
  if (spec.tolerance_px == 0) spec.tolerance_px = kTolerances_px[size_t(spec.quality)];
  if (spec.filter.sample_count == 1) spec.filter.width = RayFilter{}.width;  // nothing is spread
  // Stills and browsers take any display as JPEG, so no atlas may be larger than a JPEG.
  VIEWLOOM_RETURN_IF_ERROR(validateAtlasLimits(
      spec,
      {.side_px_max = kJpegSidePxMax, .area_px_max = uint64_t{kJpegSidePxMax} * kJpegSidePxMax}));
  return spec;
}

absl::Status validateEncodingSpec(const EncodingSpec& encoding) {
  VIEWLOOM_RETURN_IF_ERROR(checkRange(encoding.jpeg_quality, {1, 100}, "jpeg_quality"));
  VIEWLOOM_RETURN_IF_ERROR(checkRange(encoding.video_qp, {kVideoQpMin, kVideoQpMax}, "video_qp"));
  if (encoding.color == BandEncoding::kCompactDepth) {
    return invalidField("color",
                        "COMPACT_DEPTH holds no color; accepted is JPEG, JPEG_PLANES, H264, "
                        "ZSTD or RAW");
  }
  if (encoding.planes == BandEncoding::kZstd || encoding.planes == BandEncoding::kRaw) {
    return absl::OkStatus();
  }
  if (encoding.planes != BandEncoding::kCompactDepth) {
    return invalidField("planes",
                        "JPEG and H264 would change depth and mask; accepted is ZSTD, RAW or, for "
                        "depth alone, COMPACT_DEPTH");
  }
  if (!encoding.with_mask && !encoding.with_depth_codes) return absl::OkStatus();
  return invalidField("planes",
                      "COMPACT_DEPTH holds depth alone; with masks or depth codes, accepted is "
                      "ZSTD or RAW");
}

uint32_t coarsestAdaptedQp(uint32_t finest_qp) {
  constexpr uint32_t kSpan = 16;
  return std::min(finest_qp + kSpan, kVideoQpMax);
}

bool adaptsQuality(const EncodingSpec& encoding) {
  return encoding.color == BandEncoding::kH264 && encoding.video_qp_max > encoding.video_qp;
}

bool adaptsToLines(const EncodingSpec& encoding) {
  const bool has_limit = encoding.color == BandEncoding::kH264 && encoding.bits_per_second_max != 0;
  return has_limit || adaptsQuality(encoding);
}

uint32_t rungNumber(const EncodingSpec& encoding) {
  return adaptsQuality(encoding) ? uint32_t(encoding.rung) + 1 : 0;
}

EncodingSpec onOtherRung(EncodingSpec encoding) {
  const bool is_first = encoding.rung == VideoRung::kFirst;
  encoding.rung = is_first ? VideoRung::kSecond : VideoRung::kFirst;
  return encoding;
}

bool isChained(const EncodingSpec& encoding) {
  return encoding.color == BandEncoding::kH264 && encoding.prediction == Prediction::kAcrossAtlases;
}

uint32_t matchedVideoQp(uint32_t jpeg_quality) {
  const MatchedQp* const above =
      std::ranges::lower_bound(kMatchedQps, jpeg_quality, {}, &MatchedQp::jpeg_quality);
  if (above == std::begin(kMatchedQps)) return above->qp;
  if (above == std::end(kMatchedQps)) return std::rbegin(kMatchedQps)->qp;
  const MatchedQp& below = *(above - 1);
  const uint32_t span = above->jpeg_quality - below.jpeg_quality;
  return below.qp - (below.qp - above->qp) * (jpeg_quality - below.jpeg_quality) / span;
}

absl::Status validateEncodingOf(const DisplaySpec& spec, const EncodingSpec& encoding) {
  if (encoding.color == BandEncoding::kH264) return validateVideoOf(spec);
  const bool shares_chroma =
      encoding.color == BandEncoding::kJpeg && encoding.chroma == Chroma::k420;
  if (!shares_chroma || tileGridOf(spec).rays_per_px == 1) return absl::OkStatus();
  return invalidField("chroma",
                      "420 would mix neighbouring subpixels, which show different views on a "
                      "lenticular panel; accepted is 444, or color as JPEG_PLANES, ZSTD or RAW");
}

}  // namespace viewloom
