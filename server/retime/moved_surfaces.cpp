// SPDX-License-Identifier: Apache-2.0
#include "retime/moved_surfaces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "retime/quad_kernels.h"

namespace viewloom {
namespace {

// Rows from one in which something moves to those whose links are asked: at an edge beside it, px
// look two further for what their surface looks like.
constexpr uint32_t kLinkedAround = 3;

// px from the place of a sample that moves to px which are no longer as they were: corners of its
// quad lie up to three away, each a px, and a px torn, from the next; its edges' light falls up to
// two from a px beside it. And one for rounding.
constexpr double kFreshAround_px = 4;

// Bytes of motion of a row, eight from `i` on, without the signs of zeros.
uint64_t motionWord(const uint8_t* row, size_t size, size_t i) {
  uint64_t word = 0;
  std::memcpy(&word, row + i, std::min(sizeof word, size - i));
  return word & 0x7fff7fff7fff7fffU;
}

Columns movingIn(const uint8_t* row, uint32_t width) {
  constexpr size_t kPxBytes = 6;
  const size_t size = kPxBytes * width;
  size_t first = 0;
  while (first < size && motionWord(row, size, first) == 0) first += 8;
  if (first >= size) return {};
  size_t last = (size - 1) / 8 * 8;
  while (motionWord(row, size, last) == 0) last -= 8;
  first += size_t(std::countr_zero(motionWord(row, size, first))) / 8;
  last += 7 - size_t(std::countl_zero(motionWord(row, size, last))) / 8;
  return {uint32_t(first / kPxBytes), uint32_t(last / kPxBytes) + 1};
}

// Columns, or rows, that lie so far away from some.
Columns awayFrom(const Columns& from, double least_px, double most_px, uint32_t count) {
  const double first = std::floor(from.first + least_px - kFreshAround_px);
  const double end = std::ceil(from.end + most_px + kFreshAround_px);
  return {uint32_t(std::clamp(first, 0.0, double(count))),
          uint32_t(std::clamp(end, 0.0, double(count)))};
}

}  // namespace

void MovedSurfaces::prepare(FramePtr frame, WorkerPool& workers) {
  frame_ = std::move(frame);
  columns_.prepare(frame_, workers);
  held_inv_z_ = columns_.rowSource().columns;
  steps_ = columns_.measured().steps;
  beginFrame(workers);
  forEachRow(size_px_, workers, [&](uint32_t y, uint32_t) { standRow(y); });
  links_.find(
      *held_inv_z_, steps_, workers, [&](uint32_t y) { return isNearMoving(y); },
      [&](uint32_t y) { return quadColumns(y); });
}

void MovedSurfaces::beginFrame(WorkerPool& workers) {
  if (size_px_ == columns_.sizePx() && layer_count_ == held_inv_z_->layerCount()) {
    forEachRow(size_px_, workers, [&](uint32_t y, uint32_t) { clearRow(y); });
    return;
  }
  size_px_ = columns_.sizePx();
  layer_count_ = held_inv_z_->layerCount();
  const size_t count = size_px_.area() * layer_count_ + 1 + kRowSlack;
  for (auto* values : {&dx_px_, &dy_px_, &inv_z_}) {
    values->reserve(count);
    std::fill_n(values->data(), count, 0.0F);
  }
  for (auto* values : {&moves_, &covered_, &drawn_quads_}) {
    values->reserve(count);
    std::fill_n(values->data(), count, uint8_t{0});
  }
  moving_columns_.assign(size_px_.height, {});
  ways_.assign(size_px_.height, {});
  samples_ = {.size_px = size_px_,
              .layer_count = layer_count_,
              .dx_px = dx_px_.data(),
              .dy_px = dy_px_.data(),
              .inv_z = inv_z_.data(),
              .moves = moves_.data(),
              .quads = drawn_quads_.data() + 1,
              .covered = covered_.data()};
}

// Where the frame before had something that moves, nothing does any more.
void MovedSurfaces::clearRow(uint32_t y) {
  const Columns moving = movingColumns(y), quads = quadColumns(y);
  for (uint32_t layer = 0; layer < layer_count_; ++layer) {
    const uint32_t row = sampleAt(layer, 0, y);
    std::fill_n(dx_px_.data() + row + moving.first, moving.count(), 0.0F);
    std::fill_n(dy_px_.data() + row + moving.first, moving.count(), 0.0F);
    std::fill_n(moves_.data() + row + moving.first, moving.count(), uint8_t{0});
    std::fill_n(drawn_quads_.data() + 1 + row + quads.first, quads.count(), QuadLayers{0});
  }
}

// Where the row's samples are before anything moves, and which of them will.
void MovedSurfaces::standRow(uint32_t y) {
  const uint32_t width = size_px_.width;
  Columns columns;
  for (uint32_t layer = 0; layer < layer_count_; ++layer) {
    std::copy_n(heldRow(layer, y), width, inv_z_.data() + sampleAt(layer, 0, y));
    const SharedBytes& motion = frame_->sources.front()[layer].motion;
    if (motion == nullptr) continue;
    columns = columns.with(movingIn(motion->data() + size_t{6} * width * y, width));
  }
  moving_columns_[y] = columns;
}

bool MovedSurfaces::isNearMoving(uint32_t y) const {
  const uint32_t end = std::min(y + kLinkedAround + 1, size_px_.height);
  for (uint32_t row = y - std::min(y, kLinkedAround); row < end; ++row) {
    if (!moving_columns_[row].isEmpty()) return true;
  }
  return false;
}

void MovedSurfaces::move(double seconds, WorkerPool& workers) {
  // Rows of the turn from the world into the camera, times the time.
  const glm::dquat camera_from_world =
      glm::conjugate(frame_->format.sources.front().camera.pose.orientation);
  std::array<glm::dvec3, 3> axes_s;
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 axis(0.0);
    axis[i] = seconds;
    axes_s[size_t(i)] = glm::conjugate(camera_from_world) * axis;
  }
  forEachRow(size_px_, workers, [&](uint32_t y, uint32_t) { moveRows(y, axes_s); });
  forEachRow(size_px_, workers, [&](uint32_t y, uint32_t) {
    const Columns columns = quadColumns(y);
    if (columns.isEmpty()) return;
    for (uint32_t layer = 0; layer < layer_count_; ++layer) {
      const uint32_t first = sampleAt(layer, columns.first, y);
      keepDrawnQuads(samples_, first, columns.count(), links_.quads() + first,
                     drawn_quads_.data() + 1 + first);
    }
  });
  forEachRow(size_px_, workers, [&](uint32_t y, uint32_t) {
    const Columns columns = movingColumns(y);
    if (!columns.isEmpty()) {
      coverQuadrants(samples_, y, columns.first, columns.end, covered_.data());
    }
  });
  findFreshColumns();
}

void MovedSurfaces::moveRows(uint32_t y, const std::array<glm::dvec3, 3>& axes_s) {
  const Columns columns = movingColumns(y);
  ways_[y] = {};
  if (columns.isEmpty()) return;
  const Intrinsics& lens = frame_->format.sources.front().camera.intrinsics;
  for (uint32_t layer = 0; layer < layer_count_; ++layer) {
    const SharedBytes& motion = frame_->sources.front()[layer].motion;
    if (motion == nullptr) continue;
    const uint32_t row = sampleAt(layer, 0, y);
    const WayRange ways = moveRow({.first = columns.first,
                                   .end = columns.end,
                                   .motion = motion->data() + size_t{6} * size_px_.width * y,
                                   .inv_z = heldRow(layer, y),
                                   .principal_x_px = lens.principal_px.x,
                                   .down_px = y + 0.5 - lens.principal_px.y,
                                   .focal_px = lens.focal_px,
                                   .axes_s = axes_s},
                                  {.dx_px = dx_px_.data() + row,
                                   .dy_px = dy_px_.data() + row,
                                   .inv_z = inv_z_.data() + row,
                                   .moves = moves_.data() + row});
    ways_[y].least_px = glm::min(ways_[y].least_px, ways.least_px);
    ways_[y].most_px = glm::max(ways_[y].most_px, ways.most_px);
  }
}

void MovedSurfaces::findFreshColumns() {
  fresh_columns_.assign(size_px_.height, {});
  for (uint32_t y = 0; y < size_px_.height; ++y) {
    if (moving_columns_[y].isEmpty()) continue;
    const WayRange& ways = ways_[y];
    const Columns columns =
        awayFrom(moving_columns_[y], ways.least_px.x, ways.most_px.x, size_px_.width);
    const Columns rows = awayFrom({y, y + 1}, ways.least_px.y, ways.most_px.y, size_px_.height);
    for (uint32_t row = rows.first; row < rows.end; ++row) {
      fresh_columns_[row] = fresh_columns_[row].with(columns);
    }
  }
}

glm::dvec2 MovedSurfaces::place(uint32_t sample) const {
  const uint32_t px = pxOf(sample);
  return {px % size_px_.width + 0.5 + double{dx_px_[sample]},
          px / size_px_.width + 0.5 + double{dy_px_[sample]}};
}

// None begins in the last row or column.
Columns MovedSurfaces::quadColumns(uint32_t y) const {
  if (y + 1 >= size_px_.height) return {};
  Columns columns = moving_columns_[y].with(moving_columns_[y + 1]);
  if (columns.first > 0) --columns.first;
  columns.end = std::min(columns.end, size_px_.width - 1);
  return columns.isEmpty() ? Columns{} : columns;
}

Columns MovedSurfaces::rimColumns(uint32_t y) const {
  Columns columns = moving_columns_[y];
  if (y > 0) columns = columns.with(moving_columns_[y - 1]);
  if (y + 1 < size_px_.height) columns = columns.with(moving_columns_[y + 1]);
  return columns.wider(1, size_px_.width);
}

}  // namespace viewloom
