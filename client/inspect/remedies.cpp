// SPDX-License-Identifier: Apache-2.0
#include "inspect/remedies.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <set>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "inspect/stored_numbers.h"

namespace viewloom::inspect {
namespace {

// Half of the surfaces of a scene lie here, as a rule. Units are chosen by it.
constexpr double kUsualNear_m = 0.1, kUsualFar_m = 30;
constexpr double kStreetFar_m = 100;  // what scanners on cars see

struct Candidate {
  std::string options;
  std::string meaning;         // "if the values are millimetres"; "" = the sign says it
  std::string instead;         // said in place of the options: what to leave out
  double far_m = kUsualFar_m;  // nearer than this lies half of the surfaces, as a rule
};
using Candidates = std::vector<Candidate>;

// Suspicions that a remedy may not raise.
const std::set<std::string> kGrave{"empty",   "inside-out", "flat",       "scale",
                                   "nothing", "bad",        "upside-down"};

// Points of a scanner leave most of the picture empty, and are right so.
bool isGrave(const Suspicion& suspicion, const LayerInspection& layer) {
  if (suspicion.kind == "empty" && layer.samples.has_points_alone &&
      layer.samples.surface_count > 0) {
    return false;
  }
  return kGrave.contains(suspicion.kind);
}

bool isMetric(const v1::DepthFormat& format) {
  return format.meaning() == v1::DEPTH_MEANING_PLANAR ||
         format.meaning() == v1::DEPTH_MEANING_RAY_DISTANCE;
}

double scaleOf(const v1::DepthFormat& format) {
  return format.scale() == 0 ? 1 : format.scale();
}

// The shortest text for a command line that reads back the same: "0.001", "1e+30", "inf".
std::string numberText(std::floating_point auto number) {
  std::array<char, 64> text;
  const auto written = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), written.ptr};
}

std::string scaleOption(double scale) {
  return strCat("--depth-scale ", numberText(scale));
}

// Negative Z, of cameras that look along -z; in metres, or in other units.
Candidates mirrored(const LayerInspection& layer) {
  const double scale = scaleOf(layer.depth.depth());
  Candidates candidates;
  for (const double unit : {1.0, 0.01, 0.001}) {
    candidates.push_back({.options = scaleOption(-unit * scale),
                          .meaning = "if depth counts along -z",
                          .instead = {}});
  }
  candidates.push_back({.options = scaleOption(-scale) + " --depth-meaning disparity",
                        .meaning = "if they are inverse depth (1/Z) along -z",
                        .instead = {}});
  return candidates;
}

Candidates swapped(const LayerInspection& layer) {
  const v1::DepthFormat& format = layer.depth.depth();
  Candidates candidates;
  if (format.meaning() == v1::DEPTH_MEANING_WINDOW) {
    candidates.push_back({.options = strCat("--depth-near ", numberText(format.far_z_m()),
                                            " --depth-far ", numberText(format.near_z_m())),
                          .meaning = "if depth is reversed",
                          .instead = {}});
  }
  candidates.push_back({.options = "--black-near", .meaning = "if black is near", .instead = {}});
  candidates.push_back({.options = "--black-near=false",
                        .meaning = "if white is near",
                        .instead = "without --black-near"});
  candidates.push_back({.options = "--depth-meaning disparity",
                        .meaning = "if the values are inverse depth (1/Z)",
                        .instead = {}});
  candidates.push_back(
      {.options = "--depth-meaning planar", .meaning = "if the values are metres", .instead = {}});
  candidates.push_back(
      {.options = "--input relative", .meaning = "if white is near", .instead = {}});
  candidates.push_back(
      {.options = "--input relative --black-near", .meaning = "if black is near", .instead = {}});
  return candidates;
}

// Distances as the KITTI benchmark stores them, also where they were taken for 1/Z.
Candidate ofScanner(const std::string& more = "") {
  return {.options = "--input kitti" + more,
          .meaning = "if the values are 1/256 m and 0 is no surface",
          .instead = {},
          .far_m = kStreetFar_m};
}

Candidates smaller(const LayerInspection& layer) {
  const double scale = scaleOf(layer.depth.depth());
  Candidates candidates;
  const auto add = [&](double unit, const char* name) {
    candidates.push_back({.options = scaleOption(unit * scale),
                          .meaning = strCat("if the values are ", name),
                          .instead = {}});
  };
  const bool is_whole = layer.depth.encoding() == v1::PLANE_ENCODING_DEPTH_U16;
  if (is_whole && scale == 1) {
    if (layer.samples.has_points_alone) candidates.push_back(ofScanner());
    candidates.push_back({.options = "--input sensor",
                          .meaning = "if the values are millimetres and 0 is no surface",
                          .instead = {}});
    if (!layer.samples.has_points_alone && layer.samples.has_scattered_zeros) {
      candidates.push_back(ofScanner());
    }
  }
  if (!is_whole) add(0.01, "centimetres");
  add(0.001, "millimetres");
  if (is_whole) add(0.01, "centimetres");
  add(0.0001, "tenths of a millimetre");
  add(1e-6, "micrometres");
  return candidates;
}

Candidates larger(const LayerInspection& layer) {
  const double scale = scaleOf(layer.depth.depth());
  Candidates candidates;
  for (const auto& [unit, name] :
       {std::pair{1000.0, "kilometres"}, std::pair{100.0, "units of 100 m"}}) {
    candidates.push_back({.options = scaleOption(unit * scale),
                          .meaning = strCat("if the values are ", name),
                          .instead = {}});
  }
  return candidates;
}

Candidates otherUnits(const LayerInspection& layer) {
  const bool is_far = layer.measures.inv_z_median < 1;
  const bool is_metric = isMetric(layer.depth.depth());
  Candidates candidates;
  if (is_metric) candidates = is_far ? smaller(layer) : larger(layer);
  const bool is_whole = layer.depth.encoding() == v1::PLANE_ENCODING_DEPTH_U16;
  if (!is_metric && is_whole && layer.samples.has_points_alone) {
    candidates.push_back(ofScanner(" --depth-meaning planar"));
  }
  candidates.push_back({.options = "--input relative",
                        .meaning = "if the values have no unit and white is near",
                        .instead = {}});
  candidates.push_back({.options = "--input relative --black-near",
                        .meaning = "if the values have no unit and black is near",
                        .instead = {}});
  return candidates;
}

// A number that stands for no surface.
Candidates invalid(float number) {
  return {
      {.options = strCat(number < 0 ? "--depth-invalid=" : "--depth-invalid ", numberText(number)),
       .meaning = "add --depth-invalid-is-far if a sky is there",
       .instead = {}}};
}

Candidates candidatesFor(const std::string& kind, const LayerInspection& layer) {
  const DepthSamples& samples = layer.samples;
  if (kind == "inside-out") return swapped(layer);
  if (kind == "scale") return otherUnits(layer);
  if (kind == "nothing") {
    Candidates candidates = invalid(samples.huge.most_frequent);
    candidates.push_back({.options = strCat("--no-surface-beyond ", numberText(kHuge / 1000)),
                          .meaning = "",
                          .instead = {}});
    return candidates;
  }
  if (kind == "scattered") {
    return {{.options = "--depth-invalid 0", .meaning = "", .instead = {}}};
  }
  if (kind == "bits") {
    const auto fewer = fewerBits(double{samples.largest_stored});
    if (!fewer) return {};
    const std::string white = strCat(" --depth-white ", fewer->last_code);
    return {{.options = white.substr(1), .meaning = "if that is white", .instead = {}},
            {.options = "--input relative" + white, .meaning = "if white is near", .instead = {}}};
  }
  if (kind == "clipped") {
    const bool is_at_max = samples.at_max_count > samples.at_min_count;
    return invalid(is_at_max ? samples.stored_max : samples.stored_min);
  }
  if (kind == "upside-down") {
    return {
        {.options = "--flip", .meaning = "if depth is stored from bottom to top", .instead = {}},
        {.options = "--flip=false", .meaning = "", .instead = {}}};
  }
  if (kind == "alpha") return {{.options = "--alpha opaque", .meaning = "", .instead = {}}};
  if (kind != "empty" && kind != "bad") return {};
  Candidates candidates;
  if (2 * samples.bad_negative_count > samples.sampleCount()) candidates = mirrored(layer);
  if (samples.bad_minus_infinity_count > 0 && samples.surface_count > 0) {
    candidates.push_back({.options = "--depth-invalid=-inf --depth-invalid-is-far",
                          .meaning = "if a sky is there",
                          .instead = {}});
  }
  if (kind == "empty" && samples.invalid_count > samples.bad_count && samples.surface_count > 0 &&
      !samples.has_scattered_zeros) {
    candidates.push_back(
        {.options = "--depth-far-zero", .meaning = "if a sky is there", .instead = {}});
  }
  return candidates;
}

bool has(const std::vector<Suspicion>& suspicions, const std::string& kind) {
  return std::any_of(suspicions.begin(), suspicions.end(),
                     [&kind](const Suspicion& its) { return its.kind == kind; });
}

// Whether the suspicion is gone and no other has come for it.
bool helps(const Suspicion& suspicion, const LayerInspection& before,
           const LayerInspection& after) {
  if (has(after.suspicions, suspicion.kind)) return false;
  return std::none_of(after.suspicions.begin(), after.suspicions.end(), [&](const Suspicion& its) {
    return isGrave(its, after) && !has(before.suspicions, its.kind);
  });
}

// Whether nothing grave is left, and units put surfaces where scenes have them.
bool isWhole(const Suspicion& suspicion, const LayerInspection& after, double far_m) {
  const bool is_grave = std::any_of(after.suspicions.begin(), after.suspicions.end(),
                                    [&](const Suspicion& its) { return isGrave(its, after); });
  if (is_grave) return false;
  if (suspicion.kind != "scale" && suspicion.kind != "empty") return true;
  const double median_m = 1 / double{after.measures.inv_z_median};
  return median_m >= kUsualNear_m && median_m <= far_m;
}

std::string resultOf(const Suspicion& suspicion, const LayerInspection& after) {
  if (suspicion.kind == "alpha") return "views then show these surfaces";
  if (suspicion.kind == "upside-down") return "edges of depth then match edges of colour";
  const uint64_t all = after.samples.sampleCount();
  const double none = double(after.samples.invalid_count + after.samples.bad_count);
  const double none_percent = std::round(1000 * none / double(all)) / 10;
  return strCat("surfaces then lie at ", 1 / after.measures.inv_z_max, " .. ",
                1 / after.measures.inv_z_min, " m",
                none > 0 ? strCat(", and ", none_percent, " % of samples are no surface") : "");
}

// The layer as it is with the options; nothing where the files cannot be read so.
std::optional<LayerInspection> readWith(const std::string& options, const LayerPlace& place,
                                        const Rereading& rereading) {
  if (rereading.stop().stop_requested()) return std::nullopt;
  const std::optional<files::LoadedFrame> frame = rereading.read(options);
  if (!frame) return std::nullopt;
  auto sources = inspectFrame(*frame, rereading.stop());
  if (!sources.ok() || place.source >= sources->size()) return std::nullopt;
  std::vector<LayerInspection>& layers = (*sources)[place.source].layers;
  if (place.layer >= layers.size()) return std::nullopt;
  return std::move(layers[place.layer]);
}

}  // namespace

std::string remedyFor(const Suspicion& suspicion, const LayerInspection& layer,
                      const LayerPlace& place, const Rereading& rereading) {
  std::string second_best;  // leaves other suspicions that there were, or an unusual range
  for (const Candidate& candidate : candidatesFor(suspicion.kind, layer)) {
    const auto after = readWith(candidate.options, place, rereading);
    if (!after || !helps(suspicion, layer, *after)) continue;
    const std::string what =
        candidate.instead.empty() ? rereading.spoken(candidate.options) : candidate.instead;
    const std::string remedy =
        strCat("try ", what, candidate.meaning.empty() ? "" : strCat(" (", candidate.meaning, ")"),
               ": ", resultOf(suspicion, *after));
    if (isWhole(suspicion, *after, candidate.far_m)) return remedy;
    if (second_best.empty()) second_best = remedy;
  }
  return second_best;
}

}  // namespace viewloom::inspect
