// SPDX-License-Identifier: Apache-2.0
#include "fidelity/score_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/str_cat.h"
#include "fidelity/flicker.h"
#include "fidelity/own_views.h"
#include "fidelity/value_or_throw.h"
#include "offline/truth_image.h"

namespace viewloom::fidelity {
namespace {

// Thresholds at which the cut mesh does well on each set, which lie far above the disparity steps
// within its surfaces and far below those at its silhouettes.
constexpr double kBeachBallCut_px = 1;
constexpr double kAntinousCut_px = 0.15;
// With noise, those that did best on each set of 0.15, 0.3, 0.5, 0.7, 1, 1.5, 2 and 3 px.
constexpr double kNoisyBeachBallCut_px = 3;
constexpr double kNoisyAntinousCut_px = 1;

// Additions to every 1/Z of antinous, 0.047 .. 0.19 1/m, with the same pictures.
constexpr double kShifts[] = {-0.04, 0.2, 10};
constexpr const char* kShiftedViews[] = {"036", "041", "044", "076", "080"};

// In the view that moves things the most: beachball's other eye, antinous' fourth column.
constexpr double kNoise_px = 0.4;

// All that the methods of a trial are measured by. The source's own view comes last.
class Judge {
 public:
  explicit Judge(const Trial& trial)
      : trial_(trial), inner_{trial.border_px, trial.set.size_px}, views_(trial.set.views) {
    views_.push_back({.name = "source", .columns = 0, .rows = 0, .color = trial.set.color});
    for (const test::TrueView& view : views_) {
      truths_.push_back(valueOrThrow(loadScoredImage(view.color, {}, trial.transfer)));
      classes_.push_back(cropped(classesOf(trial.set, view, trial.cut_px), inner_));
    }
  }

  const std::vector<test::TrueView>& views() const { return views_; }
  const ScoredImage& source() const { return truths_.back(); }

  ImageComparison compare(const ScoredImage& got, size_t view) const {
    return {cropped(got, inner_), cropped(truths_[view], inner_), trial_.transfer};
  }
  std::vector<PixelClass> inside(const std::vector<PixelClass>& classes) const {
    return cropped(classes, inner_);
  }

  MethodReport judge(std::string method, const std::vector<ScoredImage>& pictures) const {
    MethodReport report = {.method = std::move(method)};
    for (size_t view = 0; view + 1 < views_.size(); ++view) {
      report.by_mask.push_back(scoreByClass(compare(pictures[view], view), classes_[view]));
    }
    report.row_flicker = *flickerAlong(&test::TrueView::columns, &test::TrueView::rows, pictures);
    report.column_flicker = flickerAlong(&test::TrueView::rows, &test::TrueView::columns, pictures);
    return report;
  }

 private:
  // Flicker of the views from which the source is not `across` away, in the order of `along`.
  std::optional<double> flickerAlong(int test::TrueView::*along, int test::TrueView::*across,
                                     const std::vector<ScoredImage>& pictures) const {
    std::vector<size_t> stack;
    for (size_t view = 0; view < views_.size(); ++view) {
      if (views_[view].*across == 0) stack.push_back(view);
    }
    if (stack.size() < 2) return std::nullopt;
    std::sort(stack.begin(), stack.end(),
              [&](size_t a, size_t b) { return views_[a].*along < views_[b].*along; });
    std::vector<ScoredImage> got;
    std::vector<ScoredImage> truth;
    for (const size_t view : stack) {
      got.push_back(pictures[view]);
      truth.push_back(truths_[view]);
    }
    return flicker(got, truth, inner_);
  }

  const Trial& trial_;
  InnerPart inner_;
  std::vector<test::TrueView> views_;
  std::vector<ScoredImage> truths_;               // [view]
  std::vector<std::vector<PixelClass>> classes_;  // [view][pixel of the inner part]
};

}  // namespace

namespace {

// The same set with coarse depth, seen by one of its views.
Trial coarsened(const Trial& trial, const std::string& how, CoarseDepth coarse,
                const std::string& view_name) {
  Trial result = trial;
  result.set.name += ", " + how;
  std::erase_if(result.set.views,
                [&](const test::TrueView& view) { return view.name != view_name; });
  result.coarse = std::move(coarse);
  return result;
}

void addCoarse(std::vector<Trial>& trials, const Trial& trial, const std::string& view_name,
               double noisy_cut_px) {
  for (const int bits : {8, 6}) {
    trials.push_back(coarsened(trial, "depth in " + std::to_string(bits) + " bits",
                               quantizedDepth(trial.set, 1u << bits), view_name));
  }
  const auto view = std::find_if(trial.set.views.begin(), trial.set.views.end(),
                                 [&](const auto& each) { return each.name == view_name; });
  const double sigma_px = kNoise_px / std::abs(view->columns);
  trials.push_back(coarsened(trial, "noise of 0.4 px", noisyDepth(trial.set, sigma_px), view_name));
  trials.back().mesh_cut_px = noisy_cut_px;
}

// The same pictures with another place of infinity, seen by some of its views.
Trial shiftedTrial(const Trial& trial, double inv_z) {
  Trial result = trial;
  result.set = test::shifted(trial.set, inv_z);
  result.set.name += strCat(", 1/Z + ", inv_z);
  std::erase_if(result.set.views, [](const test::TrueView& view) {
    return std::find(std::begin(kShiftedViews), std::end(kShiftedViews), view.name) ==
           std::end(kShiftedViews);
  });
  return result;
}

}  // namespace

std::vector<Trial> loadTrials(const std::filesystem::path& data) {
  const Trial ball{.set = valueOrThrow(test::loadBeachBall(data, {"R", "G", "B"})),
                   .transfer = ScoreTransfer::kGamma22,
                   .border_px = 0,
                   .cut_px = kBeachBallCut_px,
                   .mesh_cut_px = kBeachBallCut_px};
  const Trial antinous{.set = valueOrThrow(test::loadAntinous(data)),
                       .transfer = ScoreTransfer::kSrgb,
                       .border_px = 8,
                       .cut_px = kAntinousCut_px,
                       .mesh_cut_px = kAntinousCut_px};
  std::vector<Trial> trials = {ball, antinous};
  addCoarse(trials, ball, "left", kNoisyBeachBallCut_px);
  addCoarse(trials, antinous, "044", kNoisyAntinousCut_px);
  for (const double inv_z : kShifts) trials.push_back(shiftedTrial(antinous, inv_z));
  return trials;
}

TrialReport runTrial(OfflineRenderer& renderer, const Trial& trial) {
  const Judge judge(trial);
  TrialReport report;
  std::vector<ScoredImage> pictures;
  const auto rendered = renderViews(renderer, trial.set, judge.views(), trial.transfer,
                                    trial.coarse ? &*trial.coarse : nullptr);
  for (const RenderedView& view : rendered) pictures.push_back(view.image);
  report.methods.push_back(judge.judge("viewloom", pictures));
  for (size_t view = 0; view < trial.set.views.size(); ++view) {
    report.by_own_classes.push_back(
        scoreByClass(judge.compare(pictures[view], view), judge.inside(rendered[view].classes)));
  }
  test::DataSet given = trial.set;
  if (trial.coarse) given.disparity_px = trial.coarse->disparity_px;
  for (const Rival& rival : rivalsOf(trial.mesh_cut_px)) {
    pictures.clear();
    for (const test::TrueView& view : judge.views()) {
      pictures.push_back(rivalView(judge.source(), given, view, rival));
    }
    report.methods.push_back(judge.judge(rival.name, pictures));
  }
  return report;
}

}  // namespace viewloom::fidelity
