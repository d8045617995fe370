// SPDX-License-Identifier: Apache-2.0
#include "sweep/surface_row_builder.h"

#include <algorithm>
#include <cmath>

#include "sweep/link_kernels.h"
#include "sweep/surface_row_silhouettes.h"

namespace viewloom {

void SurfaceRowBuilder::reserve(const DepthColumns& columns) {
  const uint32_t width = columns.sizePx().width;
  if (width == row_.width && columns.layerCount() == row_.layer_count) return;
  row_.width = width;
  row_.layer_count = columns.layerCount();
  const uint32_t size = width + kRowSlack;
  inverse_.reserve(size);
  for (uint32_t n = 1; n < size; ++n) inverse_[n] = 1.0F / float(n);
  for (uint32_t i = 0; i < row_.layer_count; ++i) row_.layers[i].reserve(size);
  chain_.reserve(size_t{row_.width} * row_.layer_count + 2 * kRowSlack);
  made_.reserve(row_.width, row_.layer_count);
}

void SurfaceRowBuilder::begin(const RowSource& source, const ColorReach& reach) {
  averaged_.begin(source, reach.y_px);
  reach_x_px_ = reach.x_px;
}

SurfaceRow& SurfaceRowBuilder::build(const RowSource& source, double y_px, float tolerance,
                                     float px_per_inv_z) {
  const SizePx size_px = source.columns->sizePx();
  reserve(*source.columns);
  row_.steps = source.steps;
  row_.planted_fault = source.planted_fault;
  tolerance_ = tolerance;
  made_.is_outside = !(y_px >= 0 && y_px < size_px.height);
  const int y = int(std::clamp(std::floor(y_px), 0.0, size_px.height - 1.0));
  // Without a sample above or below, its colour goes on.
  const double dy = made_.is_outside ? 0 : y_px - (y + 0.5);
  findFacets(source, y, row_.hasFault(SweepFault::kRowOff) ? 0 : float(dy));
  blendTexels(source, y, float(dy));
  made_.clear();
  for (uint32_t i = 0; i < row_.layer_count; ++i) {
    const uint8_t* const to_left = row_.layers[i].to_left.data();
    for (uint32_t x = 0; x < row_.width; ++x) {
      x = findOther(to_left, x, row_.width, uint8_t(i + 1));
      if (x < row_.width && isSilhouette(to_left[x])) followSurface(i, x);
    }
  }
  SurfaceRowSilhouettes silhouettes(row_, tolerance, px_per_inv_z, made_);
  for (uint32_t i = 0; i < row_.layer_count; ++i) silhouettes.add(i);
  made_.left_inv_z = row_.layers[0].left[0];
  made_.right_inv_z = row_.layers[0].right[row_.width - 1];
  return made_;
}

void SurfaceRowBuilder::findFacets(const RowSource& source, int y, float dy) {
  const FiveRows rows = rowsAround(*source.columns, y);
  row_.inv_z = rows.inv_z[2];
  made_.inv_z = row_.inv_z;
  made_.deep = row_.steps.deep;
  FacetRow facets{
      .inv_z = row_.inv_z, .slope = {}, .layer_count = row_.layer_count, .width = row_.width};
  ByLayer<float*> slope_x{};
  ByLayer<float*> slope_y{};
  ByLayer<uint8_t*> to_right{};
  ByLayer<uint8_t*> to_left{};
  EdgeRow edges{};
  for (uint32_t i = 0; i < row_.layer_count; ++i) {
    LayerFacets& layer = row_.layers[i];
    facets.slope[i] = slope_x[i] = layer.slope_x.data();
    slope_y[i] = layer.slope_y.data();
    slope_y_[i] = layer.slope_y.data();
    to_right[i] = layer.to_right.data();
    to_left[i] = layer.to_left.data();
    edges.left[i] = layer.left.data();
    edges.right[i] = layer.right.data();
  }
  if (averaged_.isNeeded()) {
    slope_y_ = averaged_.slopesAlongY(y);
    const RowColumns columns = averaged_.columnsOf(y);
    for (uint32_t i = 0; i < row_.layer_count; ++i) {
      std::copy_n(columns.slope_x[i], row_.width, slope_x[i]);
      std::copy_n(columns.to_right[i], row_.width, to_right[i]);
      std::copy_n(columns.to_left[i], row_.width, to_left[i]);
    }
  } else {
    findSlopesX(rows, slope_x);
    findSlopesY(rows, slope_y);
    linkColumns(facets, source.steps, to_right, to_left);
  }
  for (uint32_t i = 0; row_.hasFault(SweepFault::kCrossLinks) && i < row_.layer_count; ++i) {
    for (uint8_t* links : {to_right[i], to_left[i]}) {
      std::replace_if(
          links, links + row_.width, [&](uint8_t link) { return link != i + 1; }, 0);
    }
  }
  some_fall_ = findEdges(facets, slope_y_, dy, edges);
}

void SurfaceRowBuilder::blendTexels(const RowSource& source, int y, float dy) {
  const int steps = int(std::lround(std::abs(dy) * kSubtexelSteps));
  const bool is_below = dy > 0;
  const int y_there = y + (is_below ? 1 : -1);
  const bool has_there = y_there >= 0 && y_there < int(source.columns->sizePx().height);
  const float share = has_there ? float(steps) / kSubtexelSteps : 0;
  ByLayer<uint32_t*> texels{};
  for (uint32_t i = 0; i < row_.layer_count; ++i) texels[i] = row_.layers[i].texels.data();
  if (averaged_.isNeeded()) {
    averaged_.blend({.y = y, .is_below = is_below, .share = share}, texels);
    return;
  }
  const FiveRows rows_there = rowsAround(*source.columns, has_there ? y_there : y);
  TexelRow row{.share = share, .is_below = is_below, .texels = texels};
  row.here = {
      .inv_z = row_.inv_z, .slope = slope_y_, .layer_count = row_.layer_count, .width = row_.width};
  row.there = {.inv_z = rows_there.inv_z[2],
               .slope = {},
               .layer_count = row_.layer_count,
               .width = row_.width};
  ByLayer<float*> slope_there{};
  for (uint32_t i = 0; i < row_.layer_count; ++i) {
    LayerFacets& layer = row_.layers[i];
    slope_there[i] = layer.slope_y_there.data();
    row.there.slope[i] = slope_there[i];
    row.color_here[i] = readableColorRow(source, i, y, layer.color_here.data());
    row.color_there[i] =
        readableColorRow(source, i, has_there ? y_there : y, layer.color_there.data());
  }
  if (row.share > 0) findSlopesY(rows_there, slope_there);
  blendRows(row, source.steps.kappa);
}

// From its first facet on, through links to any layer, as far as it is connected.
void SurfaceRowBuilder::followSurface(uint32_t layer, uint32_t column) {
  const uint32_t base = made_.texel_count;
  uint32_t texel = base + 1;
  Surface surface = {
      .texel_offset = (int32_t(texel) - int32_t(column)) * kSubtexelSteps - kSubtexelSteps / 2,
      .before_inv_z = abi::kNoSurface,
      .before_layer = layer};
  uint32_t* const texels = made_.texels.data();
  uint8_t* const texel_layer = made_.texel_layer.data();
  const bool begins_deep = row_.layers[layer].to_left[column] == abi::kDeepEdge;
  bool ends_deep = false;
  for (;;) {
    LayerFacets& own = row_.layers[layer];
    const uint32_t last =
        findOther(own.to_right.data(), column, row_.width - 1, uint8_t(layer + 1));
    const uint32_t count = last + 1 - column;
    std::copy_n(own.texels.data() + column, count, texels + texel);
    std::fill_n(texel_layer + texel, count, uint8_t(layer));
    int32_t* const places = (layer == 0 ? made_.nearest_texel : own.texel).data() + column;
    for (uint32_t i = 0; i < count; ++i) places[i] = int32_t(texel + i) * kSubtexelSteps;
    texel += count;
    followPiece(surface, layer, column, last);
    ends_deep = own.to_right[last] == abi::kDeepEdge;
    if (last + 1 == row_.width || isSilhouette(own.to_right[last])) break;
    layer = own.to_right[last] - 1U;
    column = last + 1;
  }
  if (reach_x_px_ > 0) averageAlong(base + 1, texel, begins_deep, ends_deep);
  texels[base] = texels[base + 1];
  texel_layer[base] = texel_layer[base + 1];
  texels[texel] = texels[texel - 1];
  texel_layer[texel] = texel_layer[texel - 1];
  made_.texel_count = texel + 1;
  noteMixed(base, begins_deep, ends_deep);
}

// Averages the surface that has just been followed, from texel `first` to the last.
void SurfaceRowBuilder::averageAlong(uint32_t first, uint32_t end, bool begins_deep,
                                     bool ends_deep) {
  uint32_t* const chain = chain_.data() + kRowSlack;
  std::copy(&made_.texels[first], &made_.texels[0] + end, chain);
  averageChain({.texels = chain,
                .count = end - first,
                .is_first_mixed = begins_deep,
                .is_last_mixed = ends_deep,
                .reach_px = reach_x_px_},
               &made_.texels[first]);
}

// The texels of the surface that begins at `base`, and of its copies at both ends. Of a surface of
// two px between two silhouettes, both are what there is.
void SurfaceRowBuilder::noteMixed(uint32_t base, bool begins_deep, bool ends_deep) {
  const uint32_t first = base + 1;
  const uint32_t last = made_.texel_count - 2;
  const uint32_t count = last + 1 - first;
  if (count < 2 || (count == 2 && begins_deep && ends_deep)) return;
  const uint32_t* const texels = made_.texels.data();
  for (const uint32_t at : {base, first}) {
    if (begins_deep) made_.mixed.add(at, texels[first], texels[first + 1]);
  }
  for (const uint32_t at : {last, last + 1}) {
    if (ends_deep) made_.mixed.add(at, texels[last], texels[last - 1]);
  }
}

// The fewest straight runs that stay within the tolerance of every facet, one after the other. As
// the planes of a structure they stray by no more than half the connection tolerance.
void SurfaceRowBuilder::followPiece(Surface& surface, uint32_t layer, uint32_t first,
                                    uint32_t last) {
  RunSearch search = {.left = row_.layers[layer].left.data(),
                      .right = row_.layers[layer].right.data(),
                      .inverse = inverse_.data()};
  uint32_t falling = findFalling(layer, first, last);
  for (uint32_t begin = first; begin <= last;) {
    if (begin == falling) {
      followFallingFacet(surface, layer, begin++);
      falling = findFalling(layer, begin, last);
      continue;
    }
    search.last = falling - 1;
    search.tolerance = std::min(tolerance_, 0.5F * row_.steps.kappa.at(search.left[begin]));
    if (row_.hasFault(SweepFault::kTolerance)) search.tolerance *= 8;
    float end_inv_z = 0;
    const uint32_t end = findRunEnd(search, begin, &end_inv_z);
    addRun(surface, layer, float(begin), float(end), search.left[begin], end_inv_z);
    // A ray that passes by the end of a surface passes by its last run.
    row_.layers[layer].right[end - 1] = end_inv_z;
    begin = end;
  }
}

// The first facet of which an edge is at the sky only because nothing is below it; last + 1.
uint32_t SurfaceRowBuilder::findFalling(uint32_t layer, uint32_t first, uint32_t last) const {
  const bool is_sought = some_fall_ && !row_.hasFault(SweepFault::kFallsBelowSky);
  for (uint32_t x = first; is_sought && x <= last; ++x) {
    const float left = row_.layers[layer].left[x];
    const float right = row_.layers[layer].right[x];
    const float rise = row_.layers[layer].slope_x[x];
    if (right == 0 && left > 0 && left + rise < 0) return x;
    if (left == 0 && right > 0 && right < rise) return x;
  }
  return last + 1;
}

// Down to the sky, and along it; or the other way round.
void SurfaceRowBuilder::followFallingFacet(Surface& surface, uint32_t layer, uint32_t column) {
  const float left = row_.layers[layer].left[column];
  const float right = row_.layers[layer].right[column];
  const float above_px = (left + right) / std::abs(row_.layers[layer].slope_x[column]);
  const float begin_px = float(column);
  const float meets_px = left > 0 ? begin_px + above_px : begin_px + 1 - above_px;
  addRun(surface, layer, begin_px, meets_px, left, 0);
  addRun(surface, layer, meets_px, begin_px + 1, 0, right);
}

void SurfaceRowBuilder::addRun(Surface& surface, uint32_t layer, float begin_px, float end_px,
                               float begin_inv_z, float end_inv_z) {
  Runs& runs = made_.layers[layer].runs;
  const uint32_t at = runs.count++;
  runs.begin_px[at] = begin_px;
  runs.end_px[at] = end_px;
  runs.begin_inv_z[at] = begin_inv_z;
  runs.end_inv_z[at] = end_inv_z;
  runs.texel_offset[at] = surface.texel_offset;
  const float before = surface.before_inv_z;
  if (row_.hasFault(SweepFault::kRunsOff)) runs.begin_px[at] += 1;
  if (row_.hasFault(SweepFault::kRunsOff)) runs.end_px[at] += 1;
  if (before >= 0 && !row_.hasFault(SweepFault::kBridges)) {
    // Whoever comes over the lower side meets the higher one at the edge.
    const Travel travel = before > begin_inv_z ? Travel::kLeft : Travel::kRight;
    const Step bridge = {.edge_px = begin_px,
                         .low_inv_z = std::min(before, begin_inv_z),
                         .high_inv_z = std::max(before, begin_inv_z),
                         .texel = int32_t(begin_px) * kSubtexelSteps + surface.texel_offset};
    const uint32_t hit_layer = travel == Travel::kLeft ? surface.before_layer : layer;
    bridge.addTo(made_.layers[hit_layer].bridges[size_t(travel)]);
  }
  surface.before_layer = layer;
  surface.before_inv_z = end_inv_z;
}

}  // namespace viewloom
