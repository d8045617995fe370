// SPDX-License-Identifier: Apache-2.0
// What a source has to show so that the rays of displays find something: the union of what their
// views see between two depths, as dense as the densest of them.
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

// Depths that stay while what is measured of a moving scene merely trembles. Thread-safety: none;
// one owner.
class SettledRange {
 public:
  // How much wider than what is measured it is when it is settled anew, at either end, as a share
  // of the nearest 1/Z; it stays while it holds what is measured and is up to twice that wider.
  // A scene that moves by less than 6 % of its distance moves nothing.
  static constexpr double kMargin = 1.0 / 16;

  const InvZRange& settle(const InvZRange& measured);

 private:
  InvZRange settled_;
};

// Pinholes of `size_px` that see whatever any ray of the display does, and nothing else where all
// rays of its views come from their eyes.
struct OutermostViews {
  std::vector<Camera> cameras;  // relative to the display
  SizePx size_px;
};

// Of one view, and of all of them.
OutermostViews outermostViewsOf(const AtlasLayout& layout, const View& view);
OutermostViews outermostViews(const AtlasLayout& layout);

// Of a pinhole that looks along -z from where poses are relative to. It serves what lies up to
// 1.3 rad to its sides: a view of more asks for that much.
class SourceDemand {
 public:
  // What the views see between the depths of `range`. `view` is relative to the source.
  void include(const Camera& view, SizePx size_px, const InvZRange& range);
  void include(const OutermostViews& views, const Pose& source_from_display,
               const InvZRange& range);

  // Something that a view sees can be served; the others expect it, but for hasParallax().
  bool isServable() const { return left_ < right_ && down_ < up_; }
  Fov fov() const;
  // Up to the largest plane that is accepted.
  SizePx sizePx() const;
  double tangentWidth() const { return right_ - left_; }
  // Some view stands elsewhere than the source.
  bool hasParallax() const { return has_parallax_; }

 private:
  void includeCorner(const Camera& view, glm::dvec2 tangents, double inv_z);
  void includeTangents(glm::dvec2 tangents);

  // Tangents; the union is empty while nothing is included.
  double left_ = std::numeric_limits<double>::infinity();
  double right_ = -std::numeric_limits<double>::infinity();
  double up_ = -std::numeric_limits<double>::infinity();
  double down_ = std::numeric_limits<double>::infinity();
  glm::dvec2 focal_px_{0.0};  // of the densest view, as a px of the source moves in it
  bool has_parallax_ = false;
};

}  // namespace viewloom
