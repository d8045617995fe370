// SPDX-License-Identifier: Apache-2.0
// Computes which source would serve displays: the union of what their views see between two depths,
// as dense as the densest view.
#pragma once

#include <limits>
#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// Depths in front of a source: 1/Z, 1/m; 0 is infinity. far <= near.
struct InvZRange {
  double far = 0;
  double near = 0;
};

// A range of depths that stays the same while measurements of a moving scene merely fluctuate.
// Thread-safety: none; one owner.
class SettledRange {
 public:
  // Margin that a new range adds to the measurement at either end, as a share of the nearest 1/Z.
  // The range stays while it contains the measurement and is at most twice the margin wider. A
  // scene that moves by less than 6 % of its distance changes nothing.
  static constexpr double kMargin = 1.0 / 16;

  const InvZRange& settle(const InvZRange& measured);

 private:
  InvZRange settled_;
};

// Pinhole cameras of `size_px` that together see everything that any ray of the display sees. They
// see nothing else if all rays of its views come from their eyes.
struct OutermostViews {
  std::vector<Camera> cameras;  // relative to the display
  SizePx size_px;
};

// Outermost views for one view, and for all views.
OutermostViews outermostViewsOf(const AtlasLayout& layout, const View& view);
OutermostViews outermostViews(const AtlasLayout& layout);

// Demand on a pinhole camera that looks along -z from the origin of the poses. It serves up to 1.3
// rad to each side: a wider view asks for that much.
class SourceDemand {
 public:
  // Adds what the views see between the depths of `range`. `view` is relative to the source.
  void include(const Camera& view, SizePx size_px, const InvZRange& range);
  void include(const OutermostViews& views, const Pose& source_from_display,
               const InvZRange& range);

  // Whether anything can be served. All other methods except hasParallax() expect that.
  bool isServable() const { return left_ < right_ && down_ < up_; }
  Fov fov() const;
  // Size of the source, at most the largest plane that the server accepts.
  SizePx sizePx() const;
  double tangentWidth() const { return right_ - left_; }
  // Whether a view stands elsewhere than the source.
  bool hasParallax() const { return has_parallax_; }

 private:
  void includeCorner(const Camera& view, glm::dvec2 tangents, double inv_z);
  void includeTangents(glm::dvec2 tangents);

  // Tangents; the union is empty while nothing is included.
  double left_ = std::numeric_limits<double>::infinity();
  double right_ = -std::numeric_limits<double>::infinity();
  double up_ = -std::numeric_limits<double>::infinity();
  double down_ = std::numeric_limits<double>::infinity();
  glm::dvec2 focal_px_{0.0};  // focal length of the densest view, in terms of the source
  bool has_parallax_ = false;
};

}  // namespace viewloom
