// SPDX-License-Identifier: Apache-2.0
// Times each stage on its own, one after the other: what the overlapped pipeline is made of.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "display/display_spec.h"
#include "frame/frame.h"
#include "gpu/device.h"
#include "picture/trace_job.h"

namespace viewloom {

// Medians over the repetitions.
struct StageReport {
  uint64_t source_px = 0;  // of all layers
  uint64_t ray_count = 0;
  double disparity_span_px = 0;  // see disparitySpanPx
  double upload_ms = 0;
  double build_ms = 0;                          // submitted until done
  std::map<std::string, double> build_pass_ms;  // on the device, by pass; empty without timestamps
  // Times for a display that the server sweeps: from planes to columns, and the sweep, on all
  // cores.
  std::optional<double> sweep_source_ms;
  std::optional<double> sweep_ms;
  uint64_t swept_frame_bytes = 0;  // its planes and columns
  uint64_t swept_atlas_bytes = 0;
  double trace_ms = 0;     // on the device; all of the submissions without timestamps
  double readback_ms = 0;  // the rest of the trace's submissions: clearing, copying, waiting
  double encode_ms = 0;    // one thread; of the sweep, where there is one
  uint64_t encoded_bytes = 0;
  double stored_nodes_per_px = 0;     // above the facets, of one layer
  double effective_nodes_per_px = 0;  // what a walk has a use for, of the nearest layer
  double structure_bytes_per_px = 0;  // of one layer: facets, nodes, entries, links
  uint64_t structure_bytes = 0;       // one slot, host and device
  uint64_t build_bytes = 0;           // what builds take beside it, shared by a stream's slots
  uint64_t trace_slot_bytes = 0;
};

// How far apart, px of the source, the outermost view sees the nearest surface and the sky behind
// it, compared with the source's own camera. For eyes in the source's plane.
double disparitySpanPx(const TraceJob& job, double inv_z_max);

// The first repetition warms up and does not count.
StageReport measureStages(const Device& device, const FramePtr& frame, const DisplaySpec& spec,
                          const EncodingSpec& encoding, uint32_t repetition_count);

}  // namespace viewloom
