// SPDX-License-Identifier: Apache-2.0
#include "gpu/judge_views.h"

#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

namespace viewloom {

using oracle::RayClass;

void JudgedViews::add(const JudgedViews& other) {
  verdict.add(other.verdict);
  visits += other.visits;
  visits_largest = std::max(visits_largest, other.visits_largest);
  visits_bound_share = std::max(visits_bound_share, other.visits_bound_share);
}

std::string JudgedViews::summary() const {
  std::ostringstream text;
  text << verdict.summary() << "\nvisits: mean "
       << double(visits) / double(std::max<uint64_t>(verdict.rays, 1)) << ", largest "
       << visits_largest << ", at most " << visits_bound_share << " x 4 (width + height) layers";
  return text.str();
}

oracle::TestedAnswer testedAnswer(const abi::RayRecord& record) {
  constexpr RayClass kClasses[] = {RayClass::kHit, RayClass::kHitAssumed, RayClass::kHidden,
                                   RayClass::kOutside, RayClass::kEmpty};
  return {kClasses[record.ray_class - abi::kClassHit], int(record.layer), double{record.x_px},
          double{record.y_px}, double{record.inv_z}};
}

JudgedViews judgeViews(WalkUnderTest& walk, const StructureSlot& slot,
                       const oracle::OracleSource& source,
                       const std::vector<oracle::OutputView>& views, double tolerance_px,
                       const std::string& where, int stride) {
  return judgeTraced(walk.trace(slot, views, tolerance_px), source, views, tolerance_px, where,
                     stride);
}

JudgedViews judgeTraced(const std::vector<TracedView>& traced, const oracle::OracleSource& source,
                        const std::vector<oracle::OutputView>& views, double tolerance_px,
                        const std::string& where, int stride) {
  oracle::Judge judge(source, oracle::toleranceOf(source, tolerance_px));
  JudgedViews judged;
  for (size_t index = 0; index < views.size(); ++index) {
    const oracle::OutputView& view = views[index];
    for (int row = 0; row < view.height; row += stride) {
      for (int column = 0; column < view.width; column += stride) {
        const abi::RayRecord& record = traced[index].records[traced[index].index(column, row)];
        std::ostringstream name;
        name << where << ", view " << view.name << " px (" << column << ", " << row << ")";
        judge.consider(oracle::rayOf(view, column + 0.5, row + 0.5), testedAnswer(record),
                       name.str());
        judged.visits += record.visits;
        judged.visits_largest = std::max(judged.visits_largest, record.visits);
      }
    }
  }
  judged.verdict = judge.verdict();
  judged.visits_bound_share = double(judged.visits_largest) /
                              (4.0 * (source.width() + source.height()) * source.layerCount());
  return judged;
}

void expectSeesItself(const TracedView& traced, const oracle::OracleSource& source,
                      const std::string& where) {
  for (int row = 0; row < source.height(); ++row) {
    for (int column = 0; column < source.width(); ++column) {
      const abi::RayRecord& record = traced.records[traced.index(column, row)];
      if (!source.exists({0, column, row})) {
        EXPECT_EQ(record.ray_class, abi::kClassEmpty);
        continue;
      }
      ASSERT_EQ(record.ray_class, abi::kClassHit) << where;
      EXPECT_EQ(record.layer, 0u);
      // Rounding alone: a thousandth of a px.
      EXPECT_NEAR(record.x_px, column + 0.5, 1e-3);
      EXPECT_NEAR(record.y_px, row + 0.5, 1e-3);
    }
  }
}

}  // namespace viewloom
