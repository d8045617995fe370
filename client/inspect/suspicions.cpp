// SPDX-License-Identifier: Apache-2.0
#include "inspect/suspicions.h"

#include <algorithm>
#include <cmath>

#include "base/str_cat.h"
#include "shared/histogram.h"

namespace viewloom::inspect {
namespace {

constexpr double kHalfMax = 65504;  // of binary16

double percent(uint64_t count, uint64_t of) {
  return of == 0 ? 0 : std::round(1000.0 * double(count) / double(of)) / 10;
}

class Rules {
 public:
  explicit Rules(const DepthFacts& facts)
      : facts_(facts), samples_(facts.samples), measures_(facts.measures) {}

  std::vector<Suspicion> all() {
    if (samples_.surface_count == 0) {
      say("empty",
          "no sample is a surface: name the unit and meaning with --depth-scale and "
          "--depth-meaning, or the tool with --input");
      return std::move(found_);
    }
    suspectInsideOut();
    suspectFlat();
    suspectClipped();
    suspectStepsAndNoise();
    suspectScale();
    suspectSamples();
    return std::move(found_);
  }

 private:
  void say(const std::string& kind, const std::string& sentence) {
    found_.push_back({kind, sentence});
  }

  // Share of the px of some rows that lie at the nearest depth of all.
  double shareAtNearest(double top, double bottom) const {
    const float nearest = measures_.inv_z_max * 0.999F;
    const auto first = static_cast<std::ptrdiff_t>(top * samples_.height_px) * samples_.width_px;
    const auto last = static_cast<std::ptrdiff_t>(bottom * samples_.height_px) * samples_.width_px;
    if (last <= first) return 0;
    const auto count = std::count_if(samples_.inv_z.begin() + first, samples_.inv_z.begin() + last,
                                     [nearest](float inv_z) { return inv_z >= nearest; });
    return double(count) / double(last - first);
  }

  void suspectInsideOut() {
    const float top = medianIn(samples_, {.bottom = 0.15});
    const float bottom = medianIn(samples_, {.top = 0.85});
    const float left = medianIn(samples_, {.right = 0.12, .bottom = 0.7});
    const float right = medianIn(samples_, {.left = 0.88, .bottom = 0.7});
    const float middle = medianIn(samples_, {.left = 0.3, .top = 0.3, .right = 0.7, .bottom = 0.7});
    const bool has_all = std::min({top, bottom, left, right, middle}) >= 0;
    const bool top_is_near = top > 1.1F * bottom;
    const bool sides_are_near = std::min(left, right) > 1.1F * middle;
    const bool sky_is_nearest = measures_.inv_z_max > measures_.inv_z_median * 1.01F &&
                                shareAtNearest(0, 0.25) > 0.2 && shareAtNearest(0.75, 1) < 0.05;
    if (!sky_is_nearest && !(has_all && top_is_near && sides_are_near)) return;
    say("inside-out",
        sky_is_nearest
            ? "the top of the picture is where depth is nearest, as if a sky lay before "
              "everything: "
              "if near and far are swapped, swap --depth-near and --depth-far, or give --black-near"
            : "the top is nearer than the bottom and the sides nearer than the middle: if near and "
              "far are swapped, swap --depth-near and --depth-far, or give --black-near, or "
              "--depth-meaning disparity for what grows with nearness");
  }

  void suspectFlat() {
    if (samples_.sky_count > 0) return;
    if (measures_.inv_z_near - measures_.inv_z_far > 0.01F * measures_.inv_z_near) return;
    say("flat", strCat("all surfaces lie within a hundredth of ", 1 / measures_.inv_z_median,
                       " m: is this the depth, and are --depth-scale, --depth-offset, --depth-near "
                       "and --depth-far those of the file?"));
  }

  void suspectClipped() {
    clippedAt(samples_.at_min_count, samples_.stored_min, samples_.stored_min == 0, "least");
    const double code_max = facts_.plane.encoding() == v1::PLANE_ENCODING_DEPTH_F16
                                ? kHalfMax
                                : std::max(facts_.code_max, 1U);
    clippedAt(samples_.at_max_count, samples_.stored_max, double{samples_.stored_max} == code_max,
              "largest");
  }

  void clippedAt(uint64_t count, float value, bool is_limit, const char* which) {
    if (samples_.stored_min == samples_.stored_max) return;  // flat, as is said
    const double share = double(count) / double(samples_.surface_count);
    if (share <= (is_limit ? 0.01 : 0.05)) return;
    say("clipped", strCat(percent(count, samples_.surface_count), " % of surfaces have the ", which,
                          " number, ", value,
                          ": depth ends there unless it is a wall square to the view; widen the "
                          "range when writing, or say what the number means with --depth-invalid "
                          "(and --depth-invalid-is-far for a sky)"));
  }

  void suspectStepsAndNoise() {
    const float near = measures_.inv_z_near;
    const bool is_stepped = abi::isStepped(measures_.step, measures_.difference_median, near);
    if (is_stepped && abi::kShownSteps * measures_.step > near) {
      say("quantised",
          strCat("depth has about ", std::round(near / measures_.step),
                 " steps from infinity to near; on a wide display one is ",
                 std::round(10 * abi::kWideSpan_px * measures_.step / near) / 10,
                 " px, which shows as terraces where smoothing does not reach: write depth of 16 "
                 "bits or floats, in inverse depth, with near and far close about the scene"));
    }
    const bool is_noisy = measures_.noise_sigma > abi::kStepsOfNoise * measures_.step &&
                          abi::kShownSigmas * measures_.noise_sigma > near;
    if (is_noisy) {
      say("noisy", strCat("noise of depth is ", measures_.noise_sigma, " 1/m, ",
                          std::round(abi::kWideSpan_px * measures_.noise_sigma / near),
                          " px on a wide display: filter it before, or name edges with "
                          "--connection-tolerance"));
    }
  }

  void suspectScale() {
    const double median_m = 1 / double{measures_.inv_z_median};
    const bool is_metric = facts_.plane.depth().meaning() == v1::DEPTH_MEANING_PLANAR ||
                           facts_.plane.depth().meaning() == v1::DEPTH_MEANING_RAY_DISTANCE;
    if (median_m > 200) {
      say("scale",
          strCat("half of the surfaces are beyond ", median_m, " m: ",
                 is_metric ? facts_.code_max > 0
                                 ? "if the numbers are millimetres, give --input sensor or "
                                   "--depth-scale 0.001; for centimetres 0.01"
                                 : "if the numbers are centimetres, give --depth-scale "
                                   "0.01; for millimetres 0.001"
                           : "check --depth-near, --depth-far and --depth-scale"));
    } else if (median_m < 0.02) {
      say("scale", strCat("half of the surfaces are nearer than ", median_m, " m: ",
                          is_metric ? "if the numbers are other units, give --depth-scale; if they "
                                      "run from 0 to 1, they are no metres: give --input rgbd, "
                                      "openxr or relative"
                                    : "check --depth-near, --depth-far and --depth-scale"));
    }
  }

  void suspectSamples() {
    const v1::DepthFormat& format = facts_.plane.depth();
    const bool is_said = format.has_invalid_value() && format.invalid_value() >= 1e9;
    if (samples_.huge_count > 0 && !is_said) {
      say("nothing", strCat(percent(samples_.huge_count, samples_.sampleCount()),
                            " % of samples are 1e9 and more, as Blender writes where it hits "
                            "nothing: give --input blender, or --depth-invalid 1e10 "
                            "--depth-invalid-is-far"));
    }
    const uint64_t none = samples_.invalid_count + samples_.bad_count;
    if (2 * none > samples_.sampleCount()) {
      say("empty", strCat(percent(none, samples_.sampleCount()),
                          " % of samples are no surface: if they are a sky, give --depth-far-zero, "
                          "or --depth-invalid N --depth-invalid-is-far"));
    }
    if (100 * samples_.bad_count > samples_.sampleCount()) {
      say("bad", strCat(percent(samples_.bad_count, samples_.sampleCount()),
                        " % of samples are NaN or negative once read, and so no surface: check "
                        "--depth-meaning, --depth-scale and --depth-offset"));
    }
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
  return {{"shape", strCat("colour is ", color.width(), "x", color.height(), ", depth ",
                           depth.width(), "x", depth.height(),
                           ": both must show the same view; crop or align one to the other")}};
}

}  // namespace viewloom::inspect
