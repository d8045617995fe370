// SPDX-License-Identifier: Apache-2.0
// One atlas to be traced: where its views lie and what each sees of the source.
#pragma once

#include <memory>
#include <vector>

#include "display/atlas_layout.h"
#include "display/color_form.h"
#include "display/display_spec.h"
#include "shared/trace_abi.h"

namespace viewloom {

// Rows of an atlas, full width.
struct BandRows {
  uint32_t first_row = 0;
  uint32_t row_count = 0;
};

// The form of a band's 8-bit colour, and which planes are wanted beside it.
struct TraceOutputs {
  ColorForm color = ColorForm::kRgba;
  bool depth = false;    // 1/Z of the view
  bool mask = false;     // ray classes
  bool linear = false;   // colour before it is rounded to 8 bits
  bool records = false;  // abi::RayRecord per px: for tests, statistics and the heat map

  bool wantsOnlyColor() const { return !(depth || mask || linear || records); }
  bool operator==(const TraceOutputs&) const = default;
};

struct TraceJob {
  std::shared_ptr<const AtlasLayout> layout;
  double tolerance_px = 0;
  // Row-major from the top left; is_used = 0 where no view stands
  std::vector<abi::ViewParams> tiles;
  OutsideFill outside_fill = OutsideFill::kBorder;
  uint32_t background_rgb = 0;
};

TraceJob makeTraceJob(std::shared_ptr<const AtlasLayout> layout, const DisplaySpec& spec,
                      const Pose& display_pose, const Camera& source_camera, SizePx source_px);
// Sees a source from elsewhere, in the memory that the job has. `display_pose`: where the display
// stands in the world; the views' poses are relative to it.
void aimTraceJob(TraceJob& job, const Pose& display_pose, const Camera& source_camera,
                 SizePx source_px);

// Whether all rays of a job are plain (shaders/shared/trace_abi.h) for a source whose largest inv_z
// is this, 1/m: then a cheaper kernel serves them.
bool raysArePlain(const TraceJob& job, double inv_z_max);
// Whether all its eyes are in the source's plane, as are those of a display that stands in the
// place of its source's camera: then a cheaper kernel serves them.
bool eyesAreInPlane(const TraceJob& job, double inv_z_max);

// Where the display of a spec stands: its own world pose, else the source's.
Pose displayPose(const DisplaySpec& spec, const Camera& source_camera);

// One view as a kernel takes it. The tolerance: an error dw in inv_z, seen from an eye at b (source
// camera space, m) along r = (x/f, y/f, 1), moves the picture by f_out |r x b| dw / |r - w b|^2 px.
// Here |r x b| is its largest value over the image, and |r - w b| >= |1 - w b_z|, which the kernel
// applies.
abi::ViewParams makeViewParams(const View& view, const Pose& display_pose,
                               const Camera& source_camera, SizePx source_px, double tolerance_px);

}  // namespace viewloom
