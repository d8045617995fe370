// SPDX-License-Identifier: Apache-2.0
// The rays of a lenticular panel as a sweep takes them. Every few px of a row, lenses send px to
// nearly the same place: such px, so far apart, are a view whose eye moves evenly and little, or
// jumps once from that of a nearest view to the next one's.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "picture/trace_job.h"
#include "sweep/swept_row.h"

namespace viewloom {

// Px first_px, first_px + stride_px, ... of a row of the panel, as px 0, 1, ... of a view.
struct LensPiece {
  uint32_t first_px = 0;
  uint32_t stride_px = 1;
  uint32_t count = 0;
  SweepView view;
};

// Immutable. Thread-safety: all methods may be called from any thread.
class LensPieces {
 public:
  // Eyes are where they ought to be to within what moves the picture by this share of the display's
  // tolerance, 1/32 px of the panel by default.
  static constexpr double kEyeErrorShare = 1.0 / 8;

  // For panels of one ray a channel whose eyes lie beside the source along its rows. nullopt for
  // other displays, and if lenses repeat so badly that eyes would jump between pixels. `inv_z_max`:
  // largest 1/Z of the source, 1/m.
  static std::optional<LensPieces> make(const TraceJob& job, double inv_z_max);

  // Every px of a row of the panel once; `sample`: which of the job's, and so which channel.
  void appendRow(uint32_t row, uint32_t sample, std::vector<LensPiece>& pieces) const;

  // The byte that a sample fills in each pixel: its channel in R, G, B.
  uint32_t channelOf(uint32_t sample) const { return channels_[sample].eyes.channel; }
  // By which rays move, the most of any px: px of the source for an inv_z of 1/m.
  float pxPerInvZ() const { return px_per_inv_z_; }

 private:
  // Places of one channel: place = start + x step + (eye + eye_m right) w + eye_m back, source px.
  struct Channel {
    abi::LenticularEyes eyes;
    double start_px = 0;
    double step_px = 0;  // from px to px of the panel
    double eye_px_m = 0;
  };

  struct View {
    int64_t first_phase = 0;  // of its subpixels
    double eye_m = 0;
  };

  double eyeOf(const Channel& channel, double place) const;
  void placeViews(uint32_t view_count);
  const View& viewAt(int64_t phase) const;
  bool settleStride(double inv_z_max, double tolerance_px);
  LensPiece pieceOf(const Channel& channel, uint32_t x, int64_t phase, uint32_t count) const;
  void goOnInNextView(const Channel& channel, int64_t phase, uint32_t count_max,
                      LensPiece& piece) const;
  uint32_t countAlike(const Channel& channel, int64_t phase, uint32_t count_max) const;
  double eyeAt(const Channel& channel, int64_t phase) const;
  double stretchFrom(double angle_rad, double half_cone_rad) const;

  std::vector<Channel> channels_;  // [sample]
  // Nearest views of the subpixels, and one behind the last; empty: every pixel has its own.
  std::vector<View> views_;
  SizePx panel_px_;
  double right_px_m_ = 0;     // how far the source's place moves with the eye, at an inv_z of 1/m
  double back_px_m_ = 0;      // the same at inv_z 0
  uint32_t stride_px_ = 1;    // of pieces
  double moved_px_m_ = 0;     // how far the picture moves for a metre of the eye, at most
  int64_t phase_step_ = 0;    // from px to px of a piece, 2^-32 of a lens
  double bend_max_rad2_ = 0;  // of a stretch of angles: its square times its bend, as tangentBend
  float px_per_inv_z_ = 0;
};

}  // namespace viewloom
