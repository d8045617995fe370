// SPDX-License-Identifier: Apache-2.0
#include "inspect/suspicions.h"

#include <algorithm>
#include <cmath>

#include "base/str_cat.h"
#include "files/plane_image.h"
#include "inspect/arrangement.h"
#include "inspect/stored_numbers.h"
#include "shared/histogram.h"

namespace viewloom::inspect {
namespace {

constexpr double kFarClip_m = 100;  // far planes of renderers lie here or further away
constexpr double kFarMedian_m = 200, kNearMedian_m = 0.02;
constexpr uint64_t kSteppedCount = 32;  // fewer places are too few to judge by

double percent(uint64_t count, uint64_t of) {
  return of == 0 ? 0 : std::round(1000.0 * double(count) / double(of)) / 10;
}

class Rules {
 public:
  explicit Rules(const DepthFacts& facts)
      : facts_(facts), samples_(facts.samples), measures_(facts.measures) {}

  std::vector<Suspicion> all() {
    if (samples_.surface_count == 0) {
      say("empty", emptySentence());
      return std::move(found_);
    }
    suspectSamples();
    suspectBits();
    suspectInsideOut();
    suspectFlat();
    suspectClipped();
    suspectStepsAndNoise();
    suspectScale();
    return std::move(found_);
  }

 private:
  void say(const std::string& kind, const std::string& sentence) {
    found_.push_back({.kind = kind, .sentence = sentence, .remedy = {}});
  }

  std::string emptySentence() const {
    const uint64_t all = samples_.sampleCount();
    if (samples_.sky_count > 0) {
      return strCat("no sample is a surface: ", percent(samples_.sky_count, all),
                    " % are infinitely far");
    }
    if (samples_.bad_nan_count == all) return "no sample is a surface: all are NaN";
    if (2 * samples_.bad_negative_count > all) {
      return strCat("no sample is a surface: ", percent(samples_.bad_negative_count, all),
                    " % are negative");
    }
    return strCat("no sample is a surface: ", percent(samples_.invalid_count, all),
                  " % have the value of no surface, ", percent(samples_.bad_count, all),
                  " % are NaN, negative or infinitely near");
  }

  void suspectInsideOut() {
    if (facts_.is_cube_map) return;  // its top is not above
    const std::string sign = insideOutSign(samples_, measures_);
    if (!sign.empty()) say("inside-out", sign + ": near and far may be swapped");
  }

  void suspectFlat() {
    if (samples_.sky_count > 0) return;
    if (measures_.inv_z_near - measures_.inv_z_far > 0.01F * measures_.inv_z_near) return;
    say("flat",
        strCat("all surfaces lie within a hundredth of ", 1 / measures_.inv_z_median,
               " m: check that this is the depth file, and that its unit and range are right"));
  }

  void suspectClipped() {
    if (samples_.stored_min == samples_.stored_max) return;  // flat, as is said
    const double code_max = facts_.plane.encoding() == v1::PLANE_ENCODING_DEPTH_F16
                                ? double{files::kHalfMax}
                                : std::max(facts_.code_max, 1U);
    const bool is_cut = 1 / double{measures_.inv_z_min} >= kFarClip_m &&
                        1 / double{measures_.inv_z_median} <= kFarMedian_m;
    // Inverse depth that is spread over all codes has its farthest surface at 0.
    const bool is_inverse = facts_.plane.depth().meaning() == v1::DEPTH_MEANING_DISPARITY;
    clippedAt(samples_.at_min_count, samples_.stored_min,
              samples_.stored_min == 0 && !is_inverse ? Limit::kHard : Limit::kNone, "least");
    clippedAt(samples_.at_max_count, samples_.stored_max,
              double{samples_.stored_max} == code_max ? Limit::kHard
              : is_cut                                ? Limit::kSoft
                                                      : Limit::kNone,
              "largest");
  }

  enum class Limit { kNone, kSoft, kHard };
  void clippedAt(uint64_t count, float value, Limit limit, const char* which) {
    const double share = double(count) / double(samples_.surface_count);
    if (limit == Limit::kNone || share <= (limit == Limit::kHard ? 0.01 : 0.05)) return;
    if (value >= kHuge) return;  // "nothing"
    say("clipped", strCat(percent(count, samples_.surface_count), " % of surfaces have the ", which,
                          " value, ", value, ": depth seems to be cut off there"));
  }

  void suspectBits() {
    if (facts_.code_max != kU16Max) return;
    if (samples_.is_stretched) {
      say("bits",
          "the 16-bit values are stretched 8-bit codes, so the file has 256 depths at most: write "
          "it with 16 bits from the start");
      return;
    }
    // Distances may end anywhere, unless their unit is unlikely.
    if (isMetric() && 1 / double{measures_.inv_z_median} <= kFarMedian_m) return;
    const std::optional<FewerBits> fewer = fewerBits(double{samples_.largest_stored});
    if (!fewer) return;
    say("bits",
        strCat("the largest value is ", samples_.largest_stored, ": codes seem to end at ",
               fewer->last_code, ", as in ", fewer->what, ", and not at the last code of 16 bits"));
  }

  void suspectStepsAndNoise() {
    // The sky is what is furthest where as much as a percentile shows it.
    const bool shows_sky =
        float(samples_.sky_count) > abi::kFarQuantile * float(samples_.surface_count);
    const float range = measures_.inv_z_near - (shows_sky ? 0 : measures_.inv_z_far);
    const float step = abi::stepOfDepth(measures_.step, float(measures_.bent_count),
                                        float(measures_.changing_count), range);
    if (abi::isStepped(step, measures_.difference_median) &&
        measures_.bent_count >= kSteppedCount && abi::kShownSteps * step > range) {
      say("quantised",
          strCat("depth has about ", std::round(range / step),
                 " steps from far to near; on a wide display one is ",
                 std::round(10 * abi::kWideSpan_px * step / range) / 10,
                 " px, which shows as terraces: write inverse depth (1/Z) with 16 bits or floats, "
                 "with near and far close to the scene"));
    }
    const bool is_noisy = measures_.noise_sigma > abi::kStepsOfNoise * measures_.step &&
                          abi::isNoiseShown(measures_.noise_sigma, range, samples_.width_px);
    if (is_noisy) {
      say("noisy", strCat("noise of depth is ", measures_.noise_sigma, " 1/m, ",
                          std::round(abi::kWideSpan_px * measures_.noise_sigma / range),
                          " px on a wide display: filter it before publishing"));
    }
  }

  bool isMetric() const {
    return facts_.plane.depth().meaning() == v1::DEPTH_MEANING_PLANAR ||
           facts_.plane.depth().meaning() == v1::DEPTH_MEANING_RAY_DISTANCE;
  }

  void suspectScale() {
    const double median_m = 1 / double{measures_.inv_z_median};
    if (median_m > kFarMedian_m) {
      say("scale", strCat("half of the surfaces are beyond ", median_m, " m"));
    } else if (median_m < kNearMedian_m) {
      say("scale", strCat("half of the surfaces are nearer than ", median_m, " m"));
    }
  }

  void suspectSamples() {
    const uint64_t all = samples_.sampleCount();
    const v1::DepthFormat& format = facts_.plane.depth();
    const bool is_said = format.has_invalid_value() &&
                         static_cast<float>(format.invalid_value()) == samples_.huge.most_frequent;
    if (samples_.huge.count > (is_said ? samples_.huge.most_frequent_count : 0)) {
      say("nothing",
          strCat(percent(samples_.huge.count, all), " % of samples are ",
                 samples_.huge.most_frequent_count == samples_.huge.count
                     ? ""
                     : "1e9 or more, most of them ",
                 samples_.huge.most_frequent, ", which renderers write where they hit nothing"));
    }
    const bool is_inverse = format.meaning() == v1::DEPTH_MEANING_DISPARITY;
    if (is_inverse && samples_.has_scattered_zeros && !format.has_invalid_value() &&
        samples_.sky_count > 0) {
      say("scattered", strCat(percent(samples_.sky_count, all),
                              " % of samples are 0, which is infinitely far, but they are "
                              "scattered over the picture like failed measurements"));
    }
    const uint64_t none = samples_.invalid_count + samples_.bad_count;
    if (2 * none > all) {
      say("empty",
          strCat(percent(none, all), " % of samples are no surface",
                 samples_.has_points_alone
                     ? ", scattered over the picture like failed measurements of "
                       "a scanner: views have holes there; fill the depth before publishing"
                     : ""));
    }
    if (100 * samples_.bad_count > all) {
      say("bad",
          strCat(percent(samples_.bad_count, all), " % of samples are no surface: ", badKinds()));
    }
  }

  std::string badKinds() const {
    std::string kinds;
    const auto add = [&kinds](uint64_t count, const char* what) {
      if (count > 0) kinds += (kinds.empty() ? "" : ", ") + strCat(count, " are ", what);
    };
    add(samples_.bad_nan_count, "NaN");
    add(samples_.bad_minus_infinity_count, "-inf");
    add(samples_.bad_negative_count, "negative");
    add(samples_.bad_count - samples_.bad_nan_count - samples_.bad_minus_infinity_count -
            samples_.bad_negative_count,
        "beyond infinity or nearer than 1 nm");
    return kinds;
  }

  const DepthFacts& facts_;
  const DepthSamples& samples_;
  const DepthMeasures& measures_;
  std::vector<Suspicion> found_;
};

}  // namespace

std::vector<Suspicion> suspectDepth(const DepthFacts& facts) {
  return Rules(facts).all();
}

std::vector<Suspicion> suspectShapes(const v1::SizePx& color, const v1::SizePx& depth) {
  const double of_color = double(color.width()) / color.height();
  const double of_depth = double(depth.width()) / depth.height();
  if (std::abs(of_color - of_depth) <= 0.01 * of_color) return {};
  return {{.kind = "shape",
           .sentence = strCat("colour is ", color.width(), "x", color.height(), ", depth ",
                              depth.width(), "x", depth.height(),
                              ": both must show the same view; crop or align one to the other"),
           .remedy = {}}};
}

}  // namespace viewloom::inspect
