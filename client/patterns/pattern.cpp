// SPDX-License-Identifier: Apache-2.0
#include "patterns/pattern.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/str_cat.h"
#include "patterns/card.h"
#include "patterns/focal_grid.h"
#include "patterns/parallax_ruler.h"
#include "patterns/view_numbers.h"

namespace viewloom::patterns {

double DisplayViews::angle_rad(uint32_t view) const {
  return cone_rad * ((view + 0.5) / count - 0.5);
}

double DisplayViews::eyeTangent(uint32_t view) const {
  return std::tan(angle_rad(view));
}

double DisplayViews::focalPx(double source_focal_px, SizePx source_px) const {
  const double aspect = double{1} * size_px.width / size_px.height;
  const double shown_px = std::min<double>(source_px.width, source_px.height * aspect);
  return source_focal_px * size_px.width / shown_px;
}

namespace {

struct NamedPattern {
  std::string_view name;
  PatternKind kind;
};

constexpr NamedPattern kPatterns[] = {{"view-numbers", PatternKind::kViewNumbers},
                                      {"parallax-ruler", PatternKind::kParallaxRuler},
                                      {"focal-grid", PatternKind::kFocalGrid},
                                      {"card", PatternKind::kCard}};

absl::Status checkOptions(const PatternOptions& options) {
  const SizePx size_px = options.size_px;
  if (size_px.width < kPatternMin_px.width || size_px.height < kPatternMin_px.height) {
    return absl::InvalidArgumentError(strCat("--size is ", size_px.width, "x", size_px.height,
                                             "; accepted for patterns are ", kPatternMin_px.width,
                                             "x", kPatternMin_px.height, " px and more"));
  }
  if (options.views.count < 2 || options.views.count > kPatternViewsMax) {
    return absl::InvalidArgumentError(
        strCat("--views is ", options.views.count, "; accepted are 2..", kPatternViewsMax));
  }
  return absl::OkStatus();
}

}  // namespace

std::optional<PatternKind> patternFromName(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kPatterns), std::end(kPatterns),
                                         [&](const NamedPattern& row) { return row.name == name; });
  if (found == std::end(kPatterns)) return std::nullopt;
  return found->kind;
}

absl::StatusOr<Pattern> makePattern(const PatternOptions& options) {
  VIEWLOOM_RETURN_IF_ERROR(checkOptions(options));
  switch (options.kind) {
    case PatternKind::kViewNumbers:
      return drawViewNumbers(options);
    case PatternKind::kParallaxRuler:
      return drawParallaxRuler(options);
    case PatternKind::kFocalGrid:
      return drawFocalGrid(options);
    case PatternKind::kCard:
      return drawCard(options);
  }
  return absl::InternalError("a pattern without a name");
}

}  // namespace viewloom::patterns
