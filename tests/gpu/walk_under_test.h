// SPDX-License-Identifier: Apache-2.0
// Build and walk as the server runs them, on scenes and views of the oracle; with a planted fault
// if asked.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "frame/frame.h"
#include "gpu/structure_image.h"
#include "gpu/submission.h"
#include "oracle/scene_generator.h"
#include "oracle/view_generator.h"
#include "structure/structure_builder.h"
#include "trace/view_tracer.h"

namespace viewloom {

// Linear light, premultiplied by alpha.
using LinearColor = std::array<float, 4>;

// The frame of a scene: inv_z as binary32 disparity, opaque white.
FramePtr frameOf(const oracle::Scene& scene);
// Each layer of one colour, which may be semitransparent.
FramePtr frameOf(const oracle::Scene& scene, const std::vector<LinearColor>& layer_colors);

// Views of one size, side by side.
TraceJob jobOf(const std::vector<oracle::OutputView>& views, double tolerance_px,
               const Camera& source_camera, SizePx source_px);
TraceJob jobOf(const std::vector<oracle::OutputView>& views, double tolerance_px,
               std::span<const SeenSource> sources);

// The oracle's source of a built scene: with the connection tolerance that the build settled on.
oracle::OracleSource sourceOf(const oracle::Scene& scene, const StructureSlot& slot);

// The connection tolerance that a build settled on.
oracle::ConnectionTolerance kappaOf(const oracle::Scene& scene, const SourceStats& stats);

// The same with what was measured otherwise.
oracle::OracleSource sourceOf(const oracle::Scene& scene, const SourceStats& stats);

// One view as it was traced, [row][column].
struct TracedView {
  int width = 0;
  std::vector<abi::RayRecord> records;
  std::vector<LinearColor> srgb;  // sRGB-encoded, not rounded to 8 bits

  size_t index(int column, int row) const { return size_t(row) * size_t(width) + size_t(column); }
};

// Planes of an atlas that jobOf() made, [row][column].
std::vector<TracedView> splitByView(const AtlasLayout& layout,
                                    std::span<const abi::RayRecord> records,
                                    std::span<const float> linear);

// Thread-safety: none.
class WalkUnderTest {
 public:
  explicit WalkUnderTest(const Device& device);

  // Uploads and builds, and waits for it; over memory that held this word everywhere, if one is
  // given.
  std::unique_ptr<StructureSlot> build(const Frame& frame, std::optional<uint32_t> old_word = {});
  // The same in memory that others are built in, too.
  std::unique_ptr<StructureSlot> buildIn(BuildMemoryPtr build_memory, const Frame& frame,
                                         std::optional<uint32_t> old_word = {});
  StructureImage readBack(const StructureSlot& slot);
  // Cells of one layer, as stored.
  std::vector<abi::uvec2> cells(const StructureSlot& slot, uint32_t layer);
  // Views of one size.
  std::vector<TracedView> trace(const StructureSlot& slot,
                                const std::vector<oracle::OutputView>& views, double tolerance_px);
  std::vector<TracedView> trace(const StructureSlot& slot, const TraceJob& job);

 private:
  template <typename Element>
  std::vector<Element> read(const LayeredBuffer& arrays, uint32_t layer);

  const Device& device_;
  StructureBuilder builder_;
  ViewTracer tracer_;
  CommandRecorder recorder_;
  Timeline timeline_;
};

}  // namespace viewloom
