// SPDX-License-Identifier: Apache-2.0
// One source as the surface model of shaders/structure.md sees it: facets and links, by definition
// alone.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace viewloom::oracle {

// The pinhole of a source, px of its depth planes.
struct Pinhole {
  glm::dvec2 focal_px{1.0};
  glm::dvec2 principal_px{0.0};
};

constexpr float kNoSurface = -1.0f;

// Depth planes of one source. inv_z: float[layer][row][column], 1/m, kNoSurface where there is
// none.
struct InvZPlanes {
  int width = 0;
  int height = 0;
  int layer_count = 0;
  std::vector<float> inv_z;

  size_t index(int layer, int column, int row) const {
    return (size_t(layer) * size_t(height) + size_t(row)) * size_t(width) + size_t(column);
  }
  float& at(int layer, int column, int row) { return inv_z[index(layer, column, row)]; }
  float at(int layer, int column, int row) const { return inv_z[index(layer, column, row)]; }
};

// Empty planes of this size.
InvZPlanes makePlanes(int width, int height, int layer_count);

// The depth step of binary32 samples, a share of inv_z: an ulp, and one of a division.
constexpr float kRelativeStepF32 = 0x1p-22f;

// Sorts every column, drops surfaces within the depth step of the last one kept, closes gaps.
InvZPlanes canonicalPlanes(const InvZPlanes& planes, float relative_step = kRelativeStepF32);

// Percentiles of layer 0, 1/m, from which shares of 1/Z are counted: the base lies a third of the
// range behind the far one.
struct ShownRange {
  float near = 0;
  float far = 0;

  float base() const { return far - (1.0F / 3.0F) * (near - far); }
};

// kappa(a, b) = max(absolute, relative * (max(a, b) - the base of the range)), 1/m.
struct ConnectionTolerance {
  float absolute = 0;
  float relative = 0;
  ShownRange range;

  // In binary32, as the structure decides, and as is measured afterwards.
  float at(float nearer) const;
  double at(double nearer) const;
  // Surfaces that are further apart are two things: 15 % of the nearer one's distance from the
  // base, but no less than `absolute`.
  float deepStep(float nearer) const;
};

// Names a facet: a layer of a column. layer -1 names none.
struct FacetAt {
  int layer = -1;
  int column = -1;
  int row = -1;

  bool operator==(const FacetAt&) const = default;
};

// The plane of one sample over its footprint; inv_z 1/m, slopes 1/m per px.
struct Facet {
  float inv_z = kNoSurface;
  float slope_x = 0;
  float slope_y = 0;
};

// Immutable. What the model decides (slopes, links) is decided in binary32, as specified;
// everything measured afterwards is double. Thread-safety: all methods may be called from any
// thread.
class OracleSource {
 public:
  OracleSource(InvZPlanes canonical_planes, Pinhole pinhole, ConnectionTolerance kappa);

  int width() const { return planes_.width; }
  int height() const { return planes_.height; }
  int layerCount() const { return planes_.layer_count; }
  const Pinhole& pinhole() const { return pinhole_; }
  const ConnectionTolerance& kappa() const { return kappa_; }
  const InvZPlanes& planes() const { return planes_; }

  bool exists(const FacetAt& at) const { return facet(at).inv_z >= 0; }
  const Facet& facet(const FacetAt& at) const {
    return facets_[planes_.index(at.layer, at.column, at.row)];
  }
  // inv_z of the facet's plane at an image position in px, without the bound at 0.
  double planeInvZ(const FacetAt& at, double x_px, double y_px) const;
  // Slope of a facet along x (1, 0) or y (0, 1), before it is rounded.
  float slope(const FacetAt& at, int step_x, int step_y) const;

  // Whether two facets in columns that share an edge are one connected surface there.
  bool linked(const FacetAt& a, const FacetAt& b) const;

  // Whether `far` is the far side of a deep silhouette towards the column of `near`, of the same
  // layer: linked to nothing there, and further away by more than a deep step.
  bool deepBehind(const FacetAt& far, const FacetAt& near) const;

  // Whether a deeper layer of the column of `near` holds at the edge what is as far back as `far`,
  // of near's layer, which is linked to nothing there; or further, or no more than kappa in front
  // of it.
  bool knownBehind(const FacetAt& far, const FacetAt& near) const;

  // Whether the far side that a ray passed behind at one point of the image, px, is taken to go on
  // to another: the column mirrored there holds, in some layer, a surface within a deep step of it,
  // or lies beyond the image.
  bool reachesAsFar(double far_inv_z, glm::dvec2 passed_px, glm::dvec2 met_px) const;

 private:
  // Whether a facet is linked to nothing in the column of `towards`.
  bool isSilhouette(const FacetAt& at, const FacetAt& towards) const;
  float differenceTo(const FacetAt& from, int step_x, int step_y, FacetAt& neighbour) const;
  float oneSidedSlope(const FacetAt& at, int step_x, int step_y) const;
  float invZAtEdge(const FacetAt& at, const FacetAt& towards) const;
  bool mayBeLinked(const FacetAt& a, const FacetAt& b) const;
  FacetAt nearestUnlinked(const FacetAt& from, const FacetAt& towards) const;

  InvZPlanes planes_;
  Pinhole pinhole_;
  ConnectionTolerance kappa_;
  std::vector<Facet> facets_;
};

// Rounds to 8 significant bits, half away from zero; what is below 2^-100 becomes 0.
float roundSlope(float slope);

}  // namespace viewloom::oracle
