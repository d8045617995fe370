// SPDX-License-Identifier: Apache-2.0
// Depth that Nuke wrote as depth.Z. It is 1/Z if Nuke made it (ScanlineRender, DepthGenerator), and
// anything, mostly Z, if Nuke passed on what a renderer had written. The header is the same.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/status.h"

namespace viewloom::inputs {

enum class NukeDepth { kDistance, kInverse };

// Verdict on the samples of one frame, with what a refusal says of them.
struct NukeVerdict {
  std::optional<NukeDepth> depth;  // none = both are likely
  double least = 0;                // of the surfaces, without what is farther than 1e9
  double largest = 0;
  std::string reason;  // "half of it is below 0.1"; empty if both are likely
};

// Distance if surfaces lie beyond 10, or nothing is marked by 1e9 and more, by infinity or by a
// negative sign: as 1/Z, they would be nearer than 0.1, where Nuke's cameras begin to see. 1/Z if
// all lies below 1, and half of it below 0.1. In between, both are likely.
NukeVerdict judgeNukeDepth(const std::vector<float>& samples);

// The same convention for all frames of a publisher. Thread-safety: none; one owner.
class NukeConvention {
 public:
  // The convention of the frames before; none before the first.
  std::optional<NukeDepth> known() const { return known_; }

  // The convention of this frame: the verdict, or what is known where there is none. `file` and
  // `channel` are for messages. INVALID_ARGUMENT where neither says it, and where both differ.
  absl::StatusOr<NukeDepth> settle(const NukeVerdict& verdict, const std::string& file,
                                   const std::string& channel);

 private:
  std::optional<NukeDepth> known_;
};

// "nuke: depth.Z is read as 1/Z, because half of it is below 0.1 (--input plain reads it as Z)"
std::string noteOf(NukeDepth depth, const NukeVerdict& verdict, const std::string& channel);

}  // namespace viewloom::inputs
