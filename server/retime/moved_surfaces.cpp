// SPDX-License-Identifier: Apache-2.0
#include "retime/moved_surfaces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "sweep/link_bytes.h"
#include "sweep/link_kernels.h"

namespace viewloom {
namespace {

// Neighbours that move apart, or into each other, by more than this are two things that only
// touched: what is left between them is not theirs.
constexpr float kTorn_px = 1;

uint32_t linkedLayer(uint8_t link) {
  return link - 1U;
}

glm::dvec3 motionAt(const uint8_t* halves) {
  uint16_t bits[3];
  std::memcpy(bits, halves, sizeof bits);
  if (((bits[0] | bits[1] | bits[2]) & 0x7fff) == 0) return glm::dvec3(0);
  return {glm::unpackHalf1x16(bits[0]), glm::unpackHalf1x16(bits[1]), glm::unpackHalf1x16(bits[2])};
}

}  // namespace

// Rows that kernels write, a vector beyond their width.
struct MovedSurfaces::LinkScratch {
  LinkScratch(uint32_t width, uint32_t layer_count) {
    for (uint32_t i = 0; i < layer_count; ++i) {
      for (auto* values : {&slope_x, &slope_y, &slope_y_below}) {
        (*values)[i].reserve(width + kRowSlack);
      }
      for (auto* values : {&to_right, &to_left, &to_below, &to_above}) {
        (*values)[i].reserve(width + kRowSlack);
      }
    }
  }

  template <typename T>
  static ByLayer<T*> rows(ByLayer<AlignedArray<T>>& arrays) {
    ByLayer<T*> rows{};
    for (size_t i = 0; i < arrays.size(); ++i) rows[i] = arrays[i].data();
    return rows;
  }

  ByLayer<AlignedArray<float>> slope_x, slope_y, slope_y_below;
  ByLayer<AlignedArray<uint8_t>> to_right, to_left, to_below, to_above;
};

void MovedSurfaces::prepare(FramePtr frame, WorkerPool& workers) {
  frame_ = std::move(frame);
  columns_.prepare(frame_, workers);
  size_px_ = columns_.sizePx();
  held_inv_z_ = columns_.rowSource().columns;
  layer_count_ = held_inv_z_->layerCount();
  kappa_ = columns_.measured().kappa;
  const size_t sample_count = size_px_.area() * layer_count_;
  to_right_.resize(sample_count);
  to_below_.resize(sample_count);
  moved_.resize(sample_count);
  in_quads_.resize(sample_count);
  moving_columns_.resize(size_px_.height);
  std::vector<LinkScratch> scratch;
  for (uint32_t worker = 0; worker < workers.workerCount(); ++worker) {
    scratch.emplace_back(size_px_.width, layer_count_);
  }
  workers.forEach(retimedPieceCount(size_px_), [&](uint32_t piece, uint32_t worker) {
    const uint32_t first = piece * kRetimedRowsPerPiece;
    const uint32_t end = std::min(first + kRetimedRowsPerPiece, size_px_.height);
    for (uint32_t y = first; y < end; ++y) {
      linkRow(int(y), scratch[worker]);
      standRow(y);
    }
  });
}

// Where the row's samples are before anything moves, and which of them will.
void MovedSurfaces::standRow(uint32_t y) {
  Columns& columns = moving_columns_[y];
  columns = {.first = size_px_.width, .end = 0};
  for (uint32_t layer = 0; layer < layer_count_; ++layer) {
    const float* const inv_z = heldRow(layer, y);
    const uint32_t row = sampleAt(layer, 0, y);
    for (uint32_t x = 0; x < size_px_.width; ++x) moved_[row + x] = {.inv_z = inv_z[x]};
    const SharedBytes& motion = frame_->sources.front()[layer].motion;
    if (motion == nullptr) continue;
    const uint8_t* const halves = motion->data() + size_t{6} * size_px_.width * y;
    for (uint32_t x = 0; x < size_px_.width; ++x) {
      if (motionAt(halves + size_t{6} * x) == glm::dvec3(0)) continue;
      columns.first = std::min(columns.first, x);
      columns.end = std::max(columns.end, x + 1);
    }
  }
  if (columns.end == 0) columns.first = 0;
}

void MovedSurfaces::linkRow(int y, LinkScratch& scratch) {
  const DepthColumns& columns = *columns_.rowSource().columns;
  const uint32_t width = size_px_.width;
  const auto facets = [&](const FiveRows& rows, ByLayer<AlignedArray<float>>& slopes) {
    FacetRow row{.inv_z = rows.inv_z[2], .slope = {}, .layer_count = layer_count_, .width = width};
    for (uint32_t i = 0; i < layer_count_; ++i) row.slope[i] = slopes[i].data();
    return row;
  };
  const FiveRows here = rowsAround(columns, y);
  findSlopesX(here, LinkScratch::rows(scratch.slope_x));
  linkColumns(facets(here, scratch.slope_x), kappa_, LinkScratch::rows(scratch.to_right),
              LinkScratch::rows(scratch.to_left));
  const bool has_below = y + 1 < int(size_px_.height);
  if (has_below) {
    const FiveRows below = rowsAround(columns, y + 1);
    findSlopesY(here, LinkScratch::rows(scratch.slope_y));
    findSlopesY(below, LinkScratch::rows(scratch.slope_y_below));
    linkRows(facets(here, scratch.slope_y), facets(below, scratch.slope_y_below), kappa_,
             LinkScratch::rows(scratch.to_below), LinkScratch::rows(scratch.to_above));
  }
  for (uint32_t i = 0; i < layer_count_; ++i) {
    const uint32_t first = sampleAt(i, 0, uint32_t(y));
    std::copy_n(scratch.to_right[i].data(), width, &to_right_[first]);
    if (has_below) std::copy_n(scratch.to_below[i].data(), width, &to_below_[first]);
  }
}

void MovedSurfaces::move(double seconds, WorkerPool& workers) {
  // Rows of the turn from the world into the camera, times the time.
  const glm::dquat camera_from_world =
      glm::conjugate(frame_->format.sources.front().camera.pose.orientation);
  glm::dvec3 axes[3];
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 axis(0.0);
    axis[i] = seconds;
    axes[i] = glm::conjugate(camera_from_world) * axis;
  }
  const auto overRows = [&](const auto& work) {
    workers.forEach(retimedPieceCount(size_px_), [&](uint32_t piece, uint32_t) {
      const uint32_t first = piece * kRetimedRowsPerPiece;
      const uint32_t end = std::min(first + kRetimedRowsPerPiece, size_px_.height);
      for (uint32_t y = first; y < end; ++y) {
        for (uint32_t layer = 0; layer < layer_count_; ++layer) work(layer, y);
      }
    });
  };
  overRows([&](uint32_t layer, uint32_t y) {
    const Columns columns = moving_columns_[y];
    const auto in_quads = in_quads_.begin() + sampleAt(layer, 0, y);
    std::fill(in_quads + columns.first, in_quads + columns.end, uint8_t{0});
    moveRow(layer, y, axes[0], axes[1], axes[2]);
  });
  overRows([&](uint32_t layer, uint32_t y) { noteQuads(layer, y); });
}

// With X and Y in px from the principal point (Y down), w = 1/Z and m the way in the camera's
// space: the point (X / fx, -Y / fy, -1) / w goes by m. Times w, its distance from the camera
// becomes q = 1 - w m.z, so w' = w / q and X' = (X + fx w m.x) / q, Y' = (Y - fy w m.y) / q.
// Written as what is added to X and Y, nothing is added where m = 0.
void MovedSurfaces::moveRow(uint32_t layer, uint32_t y, const glm::dvec3& to_camera_x,
                            const glm::dvec3& to_camera_y, const glm::dvec3& to_camera_z) {
  const Intrinsics& lens = frame_->format.sources.front().camera.intrinsics;
  const float* const inv_z = heldRow(layer, y);
  const SharedBytes& motion = frame_->sources.front()[layer].motion;
  const double down_px = y + 0.5 - lens.principal_px.y;
  if (motion == nullptr) return;
  for (uint32_t x = moving_columns_[y].first; x < moving_columns_[y].end; ++x) {
    Moved& moved = moved_[sampleAt(layer, x, y)];
    if (!(inv_z[x] > 0)) continue;
    const glm::dvec3 speed = motionAt(motion->data() + 6 * (size_t{y} * size_px_.width + x));
    if (speed == glm::dvec3(0)) continue;
    const glm::dvec3 way(glm::dot(to_camera_x, speed), glm::dot(to_camera_y, speed),
                         glm::dot(to_camera_z, speed));
    const double w = inv_z[x];
    const double right_px = x + 0.5 - lens.principal_px.x;
    const double nearness = 1 - w * way.z;
    const bool is_gone = !(nearness > 0) || w / nearness > double{kInvZMax};
    const double scale = is_gone ? 0 : w / nearness;
    moved = {.dx_px = float(scale * (lens.focal_px.x * way.x + right_px * way.z)),
             .dy_px = float(scale * (down_px * way.z - lens.focal_px.y * way.y)),
             .inv_z = is_gone ? abi::kNoSurface : float(scale),
             .is_still = false};
  }
}

glm::dvec2 MovedSurfaces::place(uint32_t sample) const {
  const uint32_t px = pxOf(sample);
  const Moved& moved = moved_[sample];
  return {px % size_px_.width + 0.5 + double{moved.dx_px},
          px / size_px_.width + 0.5 + double{moved.dy_px}};
}

bool MovedSurfaces::isTorn(uint32_t a, uint32_t b) const {
  const Moved& one = moved_[a];
  const Moved& other = moved_[b];
  return !(other.inv_z >= 0 && std::abs(one.dx_px - other.dx_px) <= kTorn_px &&
           std::abs(one.dy_px - other.dy_px) <= kTorn_px);
}

std::optional<std::array<uint32_t, 4>> MovedSurfaces::quadFrom(uint32_t sample) const {
  const uint32_t px = pxOf(sample);
  const uint32_t x = px % size_px_.width, y = px / size_px_.width;
  if (!exists(sample) || x + 1 >= size_px_.width || y + 1 >= size_px_.height) return std::nullopt;
  const uint8_t right = to_right_[sample], below = to_below_[sample];
  if (isSilhouette(right) || isSilhouette(below)) return std::nullopt;
  const uint32_t top_right = sampleAt(linkedLayer(right), x + 1, y);
  const uint32_t bottom_left = sampleAt(linkedLayer(below), x, y + 1);
  const uint8_t last = to_below_[top_right];
  if (isSilhouette(last) || to_right_[bottom_left] != last) return std::nullopt;
  const uint32_t bottom_right = sampleAt(linkedLayer(last), x + 1, y + 1);
  if (isTorn(sample, top_right) || isTorn(sample, bottom_left) || isTorn(top_right, bottom_right) ||
      isTorn(bottom_left, bottom_right)) {
    return std::nullopt;
  }
  return std::array{sample, top_right, bottom_right, bottom_left};
}

std::optional<uint32_t> MovedSurfaces::joinedBehind(uint32_t px, uint32_t other) const {
  const uint32_t first = std::min(px, other), second = std::max(px, other);
  const bool are_in_row = size_px_.width > 1 && second - first == 1;
  const std::vector<uint8_t>& links = are_in_row ? to_right_ : to_below_;
  const auto px_count = uint32_t(size_px_.area());
  for (uint32_t layer = 1; layer < layer_count_; ++layer) {
    const uint32_t sample = layer * px_count + px;
    const bool is_joined =
        px == second ? links[other] == layer + 1 : links[sample] == 1 && links[px] != 1;
    if (is_joined && heldRow(layer, px / size_px_.width)[px % size_px_.width] >= 0) return sample;
  }
  return std::nullopt;
}

MovedSurfaces::Columns MovedSurfaces::quadColumns(uint32_t y) const {
  Columns columns = moving_columns_[y];
  if (y + 1 < size_px_.height) {
    const Columns below = moving_columns_[y + 1];
    if (columns.end == 0) columns = below;
    if (below.end > 0) columns.first = std::min(columns.first, below.first);
    columns.end = std::max(columns.end, below.end);
  }
  if (columns.first > 0) --columns.first;
  return columns;
}

void MovedSurfaces::noteQuads(uint32_t layer, uint32_t y) {
  // The corner of the quad that a sample is, is the other side of the sample's own footprint.
  constexpr std::array<uint8_t, 4> kSides{kBottomRight, kBottomLeft, kTopLeft, kTopRight};
  const Columns columns = quadColumns(y);
  for (uint32_t x = columns.first; x < columns.end; ++x) {
    const auto quad = quadFrom(sampleAt(layer, x, y));
    if (!quad) continue;
    for (size_t i = 0; i < 4; ++i) {
      if (isStill((*quad)[i])) continue;
      std::atomic_ref(in_quads_[(*quad)[i]]).fetch_or(kSides[i], std::memory_order_relaxed);
    }
  }
}

}  // namespace viewloom
