// SPDX-License-Identifier: Apache-2.0
#include "sweep/lens_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <variant>

#include "picture/ray_sources.h"

namespace viewloom {
namespace {

constexpr int64_t kLens = int64_t{1} << 32;  // a lens in units of phases
constexpr uint32_t kStrideMax_px = 1024;
// Cells repeat after two px along a row, or do not.
constexpr uint32_t kCellPeriod_px = 2;
// How far back a jump between views may take a px, of its way from the one before: the rest is more
// than what rounds.
constexpr double kJumpMax = 0.75;
// Offset of an eye at the source's place: just enough to decide the direction of its rays.
constexpr double kBeside = 1e-6;

// The same as abi::viewCoordinate().
float placeOf(int64_t phase) {
  return float(uint32_t(phase) >> 8U) * 0x1p-24F;
}

// Shortest way around.
int64_t signedPhase(uint64_t phase) {
  const int64_t around = int64_t(phase % uint64_t(kLens));
  return around >= kLens / 2 ? around - kLens : around;
}

// The largest second derivative of tan up to an angle.
double tangentBend(double angle_rad) {
  const double tangent = std::tan(angle_rad);
  return 2 * tangent * (1 + tangent * tangent);
}

uint32_t dividedUp(uint32_t count, uint32_t by) {
  return (count + by - 1) / by;
}

}  // namespace

std::optional<LensPieces> LensPieces::make(const TraceJob& job, double inv_z_max) {
  const AtlasLayout& layout = *job.layout;
  const auto* rays = std::get_if<LenticularRays>(&layout.rays);
  if (rays == nullptr || job.walk_count != 1 || job.sample_count != 3) return std::nullopt;
  LensPieces pieces;
  pieces.panel_px_ = layout.tile_size_px;
  const abi::EyeAxes& axes = job.bounds.front().eye_axes;
  const double z = double{job.tiles.front().direction.z};
  pieces.right_px_m_ = double{axes.right.x};
  pieces.back_px_m_ = -double{axes.right.x} * double{axes.inv_focus} / z;
  for (uint32_t sample = 0; sample < job.sample_count; ++sample) {
    const abi::ViewParams& tile = job.tilesOf(0, sample).front();
    const double step_px = double{tile.direction_dx.x} / z;
    pieces.channels_.push_back({.eyes = lenticularEyesOf(layout, sample),
                                .start_px = double{tile.direction.x} / z + 0.5 * step_px,
                                .step_px = step_px,
                                .eye_px_m = double{tile.eye.x}});
  }
  pieces.placeViews(pieces.channels_.front().eyes.view_count);
  if (!pieces.settleStride(inv_z_max, job.tolerance_px)) return std::nullopt;
  return pieces;
}

double LensPieces::eyeOf(const Channel& channel, double place) const {
  const double angle_rad = double{channel.eyes.view_cone_rad} * (place - 0.5);
  return double{channel.eyes.distance_m} * std::tan(angle_rad);
}

void LensPieces::placeViews(uint32_t view_count) {
  const auto phases = std::views::iota(int64_t{0}, kLens);
  for (uint32_t view = 0; view < view_count; ++view) {
    const auto first = std::ranges::partition_point(
        phases, [&](int64_t phase) { return abi::nearestView(placeOf(phase), view_count) < view; });
    views_.push_back({*first, eyeOf(channels_.front(), (view + 0.5) / view_count)});
  }
  if (view_count > 0) views_.push_back({.first_phase = kLens});
}

// Takes the stride of pixels after which lenses nearly repeat that needs the fewest pieces.
bool LensPieces::settleStride(double inv_z_max, double tolerance_px) {
  const Channel& channel = channels_.front();
  const double half_cone_rad = 0.5 * double{channel.eyes.view_cone_rad};
  const double reach_m = std::abs(eyeOf(channel, 0));
  px_per_inv_z_ = float(std::abs(channel.eye_px_m) + std::abs(right_px_m_) * reach_m);
  moved_px_m_ = std::max(std::abs(back_px_m_), std::abs(right_px_m_ * inv_z_max + back_px_m_));
  const double error_m =
      kEyeErrorShare * tolerance_px * channel.step_px / std::max(moved_px_m_, 1e-300);
  // Between the ends of a stretch of L rad a line misses D tan() by D tan''() L^2 / 8, by half of
  // that to either side.
  bend_max_rad2_ = 16 * error_m / double{channel.eyes.distance_m};
  // Upper bound of a piece, in lenses. Eyes on a line may be an average distance from the middle;
  // nearest views may take a whole share, none of which continues in the next.
  const uint32_t view_count = channel.eyes.view_count;
  const double stretch_rad = stretchFrom(0.5 * half_cone_rad, half_cone_rad);
  const double run_max =
      view_count > 0 ? 1.0 / view_count : std::min(stretch_rad / (2 * half_cone_rad), 1.0);
  // The picture has to move on from px to px, at every depth.
  const double slope = 1 + std::pow(std::tan(half_cone_rad), 2);
  const double eye_m_per_lens = double{channel.eyes.distance_m} * 2 * half_cone_rad * slope;
  double pieces_min = std::numeric_limits<double>::infinity();
  const uint32_t unit = channel.eyes.lens.cell_mode == abi::kCellsAlike ? 1 : kCellPeriod_px;
  for (uint32_t stride = unit; stride <= std::min(kStrideMax_px, panel_px_.width); stride += unit) {
    const int64_t step = signedPhase(uint64_t{channel.eyes.lens.phase_per_column} * stride);
    const double step_share = double(std::abs(step)) / double(kLens);
    if (2 * moved_px_m_ * eye_m_per_lens * step_share > stride * channel.step_px) continue;
    const double run_share = step_share * dividedUp(panel_px_.width, stride);
    const double pieces = stride * (1 + run_share + run_share / run_max);
    if (pieces >= pieces_min) continue;
    pieces_min = pieces;
    stride_px_ = stride;
    phase_step_ = channel.eyes.lens.is_inverted != 0 ? -step : step;
  }
  return std::isfinite(pieces_min);
}

// How far eyes are on one line, from an angle to either side, rad. Tangents bend the more the
// further out: first as if all the stretch were as far out as the cone goes, then as far as that.
double LensPieces::stretchFrom(double angle_rad, double half_cone_rad) const {
  double stretch_rad = 0;
  double end_rad = half_cone_rad;
  for (int i = 0; i < 3; ++i) {
    stretch_rad = std::sqrt(bend_max_rad2_ / std::max(tangentBend(end_rad), 1e-300));
    end_rad = std::min(std::abs(angle_rad) + stretch_rad, half_cone_rad);
  }
  return stretch_rad;
}

const LensPieces::View& LensPieces::viewAt(int64_t phase) const {
  return views_[abi::nearestView(placeOf(phase), uint32_t(views_.size() - 1))];
}

double LensPieces::eyeAt(const Channel& channel, int64_t phase) const {
  return views_.empty() ? eyeOf(channel, double{placeOf(phase)}) : viewAt(phase).eye_m;
}

// Counts the pixels from one with this phase on that one line of eyes serves: within a lens, within
// one nearest view, or while eyes stay on the line.
uint32_t LensPieces::countAlike(const Channel& channel, int64_t phase, uint32_t count_max) const {
  if (phase_step_ == 0) return count_max;
  const int64_t step = std::abs(phase_step_);
  const bool rises = phase_step_ > 0;
  int64_t room = rises ? kLens - 1 - phase : phase;
  if (!views_.empty()) {
    const View& view = viewAt(phase);
    room = rises ? (&view)[1].first_phase - 1 - phase : phase - view.first_phase;
  } else {
    const double cone_rad = double{channel.eyes.view_cone_rad};
    const double angle_rad = cone_rad * (double{placeOf(phase)} - 0.5);
    const double share = stretchFrom(angle_rad, 0.5 * cone_rad) / cone_rad;
    room = std::min(room, int64_t(std::min(share, 1.0) * double(kLens)));
  }
  return uint32_t(std::min<int64_t>(room / step + 1, count_max));
}

LensPiece LensPieces::pieceOf(const Channel& channel, uint32_t x, int64_t phase,
                              uint32_t count) const {
  double eye_m = eyeAt(channel, phase);
  double eye_step_m = 0;
  if (count > 1 && views_.empty()) {
    const double span = count - 1;
    const int64_t last = phase + int64_t(count - 1) * phase_step_;
    eye_step_m = (eyeAt(channel, last) - eye_m) / span;
    // Half of what the line misses in the middle.
    const double middle = 0.5 * (double(phase) + double(last)) / double(kLens);
    eye_m += 0.5 * (eyeOf(channel, middle) - (eye_m + 0.5 * span * eye_step_m));
  }
  LensPiece piece{.first_px = x, .stride_px = stride_px_, .count = count};
  const double step_px = stride_px_ * channel.step_px;
  double eye_px_m = channel.eye_px_m + right_px_m_ * eye_m;
  const double eye_step_px_m = right_px_m_ * eye_step_m;
  // Rays of a piece all go one way.
  const double crosses_after = -eye_px_m / eye_step_px_m;
  if (crosses_after > 0 && crosses_after < count - 1) {
    piece.count = uint32_t(std::ceil(crosses_after));
  }
  if (crosses_after == 0) eye_px_m = kBeside * eye_step_px_m;
  piece.view = {.start_px = float(channel.start_px + x * channel.step_px + back_px_m_ * eye_m),
                .step_px = float(step_px + back_px_m_ * eye_step_m),
                .eye_px_m = float(eye_px_m),
                .eye_step_px_m = float(eye_step_px_m)};
  return piece;
}

// Adds the px after it that show the next view, as far as they go on from px to px at every depth.
void LensPieces::goOnInNextView(const Channel& channel, int64_t phase, uint32_t count_max,
                                LensPiece& piece) const {
  const int64_t next = phase + int64_t(piece.count) * phase_step_;
  if (piece.count == count_max || next < 0 || next >= kLens) return;
  const double jump_m = eyeAt(channel, next) - eyeAt(channel, phase);
  const double jump_eye_px_m = right_px_m_ * jump_m;
  const bool stays_on_side =
      double{piece.view.eye_px_m} * (double{piece.view.eye_px_m} + jump_eye_px_m) > 0;
  const double step_px = stride_px_ * channel.step_px;
  if (!stays_on_side || moved_px_m_ * std::abs(jump_m) > kJumpMax * step_px) return;
  piece.view.jump_px = float(piece.count);
  piece.view.jump_start_px = float(back_px_m_ * jump_m);
  piece.view.jump_eye_px_m = float(jump_eye_px_m);
  piece.count += countAlike(channel, next, count_max - piece.count);
}

void LensPieces::appendRow(uint32_t row, uint32_t sample, std::vector<LensPiece>& pieces) const {
  const Channel& channel = channels_[sample];
  const abi::Lenticular& lens = channel.eyes.lens;
  const uint32_t y = lens.height_px - 1 - row;
  for (uint32_t first = 0; first < std::min(stride_px_, panel_px_.width); ++first) {
    const uint32_t cell = abi::lensCell(lens, first, y);
    uint32_t x = first;
    while (x < panel_px_.width) {
      uint32_t phase = x * lens.phase_per_column + y * lens.phase_per_row +
                       lens.cell_phase[abi::kCellChannels * cell + channel.eyes.channel];
      if (lens.is_inverted != 0) phase = ~phase;
      const uint32_t count_max = dividedUp(panel_px_.width - x, stride_px_);
      const uint32_t count = countAlike(channel, phase, count_max);
      LensPiece& piece = pieces.emplace_back(pieceOf(channel, x, phase, count));
      if (!views_.empty()) goOnInNextView(channel, phase, count_max, piece);
      x += piece.count * stride_px_;
    }
  }
}

}  // namespace viewloom
