// SPDX-License-Identifier: Apache-2.0
#include "pictures/ray_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/str_cat.h"
#include "pictures/scene_to_draw.h"
#include "pictures/slice.h"

namespace viewloom::pictures {
namespace {

constexpr double kNear = 0.88;  // 1/m; where rays are drawn from
constexpr double kMeets_px = 2.5;
constexpr int kEveryRay = 2;

// How far a ray of the view moves along the row per 1/m.
double pxPerInvZ() {
  const oracle::OutputView view = viewToDraw();
  return view.position_m.x * view.pinhole.focal_px.x;
}

std::string_view styleOf(uint32_t ray_class) {
  switch (ray_class) {
    case abi::kClassHit:
      return "hit";
    case abi::kClassHitAssumed:
      return "assumed";
    case abi::kClassHidden:
      return "hidden";
    default:
      return "outside";
  }
}

bool isHit(const abi::RayRecord& record) {
  return record.ray_class == abi::kClassHit || record.ray_class == abi::kClassHitAssumed;
}

void drawFacetRow(Slice& slice, const StructureImage& structure) {
  for (int layer = 0; layer < int(structure.layers.size()); ++layer) {
    for (int column = 0; column < structure.width; ++column) {
      const PlainFacet facet =
          readFacet(structure.layers[size_t(layer)].facets.at(column, kDrawnRow));
      if (!facet.exists) continue;
      const double half = 0.5 * double{facet.slope_x};
      slice.line(column, double{facet.inv_z} - half, column + 1, double{facet.inv_z} + half,
                 ofLayer("layer", layer));
    }
  }
}

// Draws the runs of a row, in two shades in turn.
void drawRuns(Slice& slice, const SurfaceRow& row) {
  for (uint32_t layer = 0; layer < row.layer_count; ++layer) {
    const Runs& runs = row.layers[layer].runs;
    for (uint32_t i = 0; i < runs.count; ++i) {
      slice.line(double{runs.begin_px[i]}, double{runs.begin_inv_z[i]}, double{runs.end_px[i]},
                 double{runs.end_inv_z[i]}, ofLayer(i % 2 == 0 ? "run" : "next", int(layer)));
    }
  }
}

void drawSteps(Slice& slice, const Steps& steps, std::string_view style) {
  for (uint32_t i = 0; i < steps.count; ++i) {
    const double edge_px = double{steps.edge_px[i]};
    slice.line(edge_px, double{steps.low_inv_z[i]}, edge_px, double{steps.high_inv_z[i]}, style);
  }
}

std::string colorOf(const LinearColor& srgb) {
  std::array<char, 8> text{};
  const auto code = [&](size_t channel) {
    return unsigned(std::lround(255 * std::clamp(srgb[channel], 0.0f, 1.0f)));
  };
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", code(0), code(1), code(2));
  return text.data();
}

// A px of the view for each column: a ray ends at inv_z = 0 above its px.
template <typename Draw>
void forEachPx(const Slice& slice, const TracedView& traced, const Draw& draw) {
  for (int px = 0; px < traced.width; ++px) {
    if (slice.shows(px) && slice.shows(px + 1)) draw(px, traced.records[traced.index(px, 0)]);
  }
}

}  // namespace

std::string drawWalk(const StructureImage& structure, const TracedView& traced) {
  Slice slice("Walk: rays of a view from the right, and how many cells each visited");
  drawFacetRow(slice, structure);
  for (int px = 0; px < traced.width; px += kEveryRay) {
    const abi::RayRecord& record = traced.records[traced.index(px, 0)];
    const double at_sky_px = px + 0.5;
    const double end = isHit(record) ? double{record.inv_z} : 0;
    const double from_px = at_sky_px + kNear * pxPerInvZ();
    slice.line(from_px, kNear, at_sky_px + end * pxPerInvZ(), end, styleOf(record.ray_class));
    if (isHit(record) && slice.shows(double{record.x_px})) {
      slice.svg().circle(slice.at(double{record.x_px}, end), kMeets_px, "meets");
    }
    if (slice.shows(from_px)) {
      slice.svg().text(slice.at(from_px, kNear), strCat(record.visits), "small middle");
    }
  }
  slice.note(
      "Grey: hit. Green: hit, assumed, as the ray had been behind something. Red: hidden, "
      "drawn on to 1/Z = 0.");
  return slice.svg().file();
}

std::string drawSweep(const SurfaceRow& row, const TracedView& traced) {
  Slice slice("Sweep: the row as runs, bridges and silhouettes, projected onto the px of a view",
              1);
  for (uint32_t layer = 0; layer < row.layer_count; ++layer) {
    const Runs& runs = row.layers[layer].runs;
    for (uint32_t i = 0; i < runs.count; ++i) {
      const double begin_px = double{runs.begin_px[i]};
      const double inv_z = double{runs.begin_inv_z[i]};
      slice.line(begin_px, inv_z, begin_px - inv_z * pxPerInvZ(), 0, "grid");
    }
  }
  for (uint32_t layer = 0; layer < row.layer_count; ++layer) {
    const LayerSurfaces& surfaces = row.layers[layer];
    drawSteps(slice, surfaces.silhouettes[size_t(Travel::kLeft)], "silhouette");
    drawSteps(slice, surfaces.bridges[size_t(Travel::kLeft)], "bridge");
  }
  drawRuns(slice, row);
  forEachPx(slice, traced, [&](int px, const abi::RayRecord& record) {
    const std::string style = isHit(record) ? ofLayer("sample", int(record.layer)) : "unknown";
    slice.svg().box(slice.stripAt(0, px), Slice::stripPx(), 20, style);
  });
  slice.nameStrip(0, "view");
  slice.note(
      "Runs in two shades. Green: bridges. Dashed: silhouettes. Below, the layer that each "
      "px of the view shows; hollow: hidden.");
  return slice.svg().file();
}

std::string drawFill(const SurfaceRow& row, const TracedView& traced) {
  Slice slice("Fill: what is hidden takes the colour of the far side, which goes on behind", 2);
  drawRuns(slice, row);
  for (uint32_t layer = 0; layer < row.layer_count; ++layer) {
    const Steps& steps = row.layers[layer].silhouettes[size_t(Travel::kLeft)];
    for (uint32_t i = 0; i < steps.count; ++i) {
      if (steps.behind_px[i] <= 0) continue;
      const double edge_px = double{steps.edge_px[i]};
      const double far = double{steps.low_inv_z[i]};
      slice.line(edge_px - double{steps.behind_px[i]}, far, edge_px, far, "far");
    }
  }
  forEachPx(slice, traced, [&](int px, const abi::RayRecord& record) {
    const std::string color = colorOf(traced.srgb[traced.index(px, 0)]);
    slice.svg().box(slice.stripAt(1, px), Slice::stripPx(), 20, "texel", color);
    if (isHit(record)) {
      slice.svg().box(slice.stripAt(0, px), Slice::stripPx(), 20, "texel", color);
    } else {
      slice.svg().box(slice.stripAt(0, px), Slice::stripPx(), 20, "unknown");
      slice.line(px + 0.5, 0, px + 0.5 + kNear * pxPerInvZ(), kNear, "hidden");
    }
  });
  slice.nameStrip(0, "known");
  slice.nameStrip(1, "shown");
  slice.note(
      "Red: hidden rays. Dashed: far sides where they go on. Below, the px of the view that "
      "are known, and as they are shown.");
  return slice.svg().file();
}

}  // namespace viewloom::pictures
