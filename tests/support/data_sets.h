// SPDX-License-Identifier: Apache-2.0
// Pictures with depth that others made, with true other views, as they lie beside the source tree.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/status.h"
#include "frame/camera.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::test {

// A view stands columns x baseline to the right of the source and rows x baseline below it, and
// looks the same way. What the source shows at x, y it shows at x - columns d, y - rows d, where d
// is the disparity there.
struct TrueView {
  std::string name;
  int columns = 0;
  int rows = 0;
  v1::PlaneFile color;
};

// One source of one layer and views of its size. 1/Z = disparity / (focal_px baseline_m) +
// inv_z_in_focus, in a unit of length that cancels in every picture.
struct DataSet {
  std::string name;
  SizePx size_px;
  double focal_px = 0;
  double baseline_m = 0;
  double inv_z_in_focus = 0;
  v1::PlaneFile color;
  v1::PlaneFile depth;
  std::vector<float> disparity_px;  // float[height][width]; larger is nearer
  std::vector<TrueView> views;
};

// The right eye, and the left one. Colour by the given channels: with "A" a soft limb, without a
// black background that blends into it.
absl::StatusOr<DataSet> loadBeachBall(const std::filesystem::path& data,
                                      const std::vector<std::string>& channels);
// The middle of 9 x 9 views, and those there are of the others: all of its row and its column, and
// the corners. Named by their number, row by row: 040 is the source.
absl::StatusOr<DataSet> loadAntinous(const std::filesystem::path& data);

// The same pictures of a set in which infinity lies elsewhere: `inv_z` is added to every 1/Z.
DataSet shifted(DataSet set, double inv_z);

Camera sourceCamera(const DataSet& set);
Camera cameraOf(const DataSet& set, const TrueView& view);
v1::FrameManifest frameManifest(const DataSet& set);

}  // namespace viewloom::test
