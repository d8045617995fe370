// SPDX-License-Identifier: Apache-2.0
#include "inputs/nuke_depth.h"

#include <algorithm>
#include <cmath>

#include "base/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::inputs {
namespace {

constexpr float kBeyondScenes = 1e9F;  // beyond every scene
constexpr double kNearPlane = 0.1;     // of Nuke's cameras
constexpr double kInverseOfNear = 1 / kNearPlane;
constexpr double kNearestInverse = 1;    // scenes that are told by 1/Z begin at a distance of 1
constexpr double kShareOfSpecks = 0.01;  // the largest samples may be specks of a filter

// The sample that `share` of all lie below.
double quantile(std::vector<float>& samples, double share) {
  const auto index = static_cast<size_t>(share * static_cast<double>(samples.size() - 1));
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

const char* nameOf(NukeDepth depth) {
  return depth == NukeDepth::kInverse ? "1/Z" : "Z";
}

}  // namespace

NukeVerdict judgeNukeDepth(const std::vector<float>& samples) {
  std::vector<float> surfaces;
  size_t huge_count = 0, negative_count = 0;
  for (const float sample : samples) {
    if (std::abs(sample) >= kBeyondScenes) {
      ++huge_count;
    } else if (sample < 0) {
      ++negative_count;
    } else if (sample > 0) {
      surfaces.push_back(sample);
    }
  }
  NukeVerdict verdict;
  const auto say = [&verdict](NukeDepth depth, std::string reason) {
    verdict.depth = depth;
    verdict.reason = std::move(reason);
  };
  if (!surfaces.empty()) {
    const auto [least, largest] = std::minmax_element(surfaces.begin(), surfaces.end());
    verdict.least = *least;
    verdict.largest = *largest;
  }
  if (negative_count > surfaces.size()) {
    say(NukeDepth::kDistance, "it is negative");
  } else if (huge_count > 0) {
    say(NukeDepth::kDistance, "it is 1e9 or more where there is nothing");
  } else if (surfaces.empty()) {
    verdict.reason = "it is 0 everywhere";
  } else {
    const double near_largest = quantile(surfaces, 1 - kShareOfSpecks);
    const double median = quantile(surfaces, 0.5);
    if (near_largest > kInverseOfNear && median > kNearPlane) {
      say(NukeDepth::kDistance, strCat("it reaches ", near_largest));
    } else if (near_largest < kNearestInverse && median < kNearPlane) {
      say(NukeDepth::kInverse, strCat("half of it is below ", kNearPlane));
    }
  }
  return verdict;
}

absl::StatusOr<NukeDepth> NukeConvention::settle(const NukeVerdict& verdict,
                                                 const std::string& file,
                                                 const std::string& channel) {
  constexpr const char* kRemedy = "; say which with --input nuke (1/Z) or --input plain (Z)";
  if (known_ && verdict.depth && *known_ != *verdict.depth) {
    return files::refuseFile(file, strCat("Nuke wrote ", channel, " as ", nameOf(*verdict.depth),
                                          " here, because ", verdict.reason, ", but as ",
                                          nameOf(*known_), " in the frames before", kRemedy));
  }
  // A frame without surfaces looks alike either way, and says nothing of the next.
  if (!known_ && !verdict.depth && verdict.largest == 0) return NukeDepth::kInverse;
  if (!known_ && !verdict.depth) {
    return files::refuseFile(
        file, strCat("Nuke wrote ", channel, " from ", verdict.least, " to ", verdict.largest,
                     ", which may be inverse depth (1/Z, as ScanlineRender makes it) or distance "
                     "(Z of a renderer, passed on)",
                     kRemedy));
  }
  if (!known_) known_ = verdict.depth;
  return *known_;
}

std::string noteOf(NukeDepth depth, const NukeVerdict& verdict, const std::string& channel) {
  const bool is_inverse = depth == NukeDepth::kInverse;
  return strCat(
      "nuke: ", channel, " is read as ", is_inverse ? "inverse depth (1/Z)" : "distance (Z)",
      verdict.reason.empty() ? ", as in the frames before" : ", because " + verdict.reason,
      is_inverse ? " (--input plain reads Z)" : " (--input nuke reads 1/Z)");
}

}  // namespace viewloom::inputs
