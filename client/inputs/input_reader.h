// SPDX-License-Identifier: Apache-2.0
// Frames of input files, as any tool of InputKind writes them.
#pragma once

#include <optional>

#include "base/status.h"
#include "files/frame_manifest.h"
#include "inputs/depth_format.h"
#include "inputs/interpretation.h"
#include "inputs/nuke_depth.h"

namespace viewloom::inputs {

struct ReadInput {
  Interpretation how;
  files::LoadedFrame frame;  // with its camera; not numbered
};

// Keeps what has to be the same from frame to frame. Thread-safety: none; one owner.
class InputReader {
 public:
  explicit InputReader(InputSettings settings) : settings_(std::move(settings)) {}

  const InputSettings& settings() const { return settings_; }

  // Errors name the file or the option.
  absl::StatusOr<ReadInput> read(const InputFiles& files);

 private:
  absl::Status settleFormat(Interpretation& how, files::LoadedFrame& frame);
  absl::Status settlePixels(const Interpretation& how, files::LoadedFrame& frame) const;
  absl::StatusOr<files::LoadedFrame> load(const InputFiles& files, const Interpretation& how) const;
  absl::StatusOr<files::LoadedFrame> loadOfNuke(const InputFiles& files, Interpretation& how);
  void settleZeros(Interpretation& how, files::LoadedFrame& frame);

  InputSettings settings_;
  NukeConvention nuke_;
  // Range of floats without a scale: that of the first frame, so that later ones do not pulse.
  std::optional<SampleRange> float_range_;
  // Whether 0 lies scattered over the first frame's inverse depth, and so is no surface.
  std::optional<bool> has_scattered_zeros_;
};

// The camera of a depth plane of this size: what the settings say, else what files state, else a
// vertical field of view of 40 degrees around the middle.
v1::Camera settleCamera(const InputSettings& settings, const Interpretation& how,
                        const v1::SizePx& depth_size);

}  // namespace viewloom::inputs
