// SPDX-License-Identifier: Apache-2.0
#include "display/quilt.h"

#include <cmath>
#include <numbers>

#include "absl/strings/str_format.h"
#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/focal_window.h"
#include "display/presets.h"

namespace viewloom {
namespace {

constexpr double kDefaultViewCone_rad = 0.69813170079773183;  // 40 deg

SizePx quiltTileSize(const QuiltSpec& quilt) {
  return {quilt.size_px.width / quilt.columns, quilt.size_px.height / quilt.rows};
}

// Fields that a preset would give.
absl::Status requireShape(const QuiltSpec& quilt) {
  const auto missing = [](const char* field, const std::string& accepted) {
    return invalidField(field, strCat("missing; accepted is ", accepted,
                                      ". A quilt needs columns, rows and size, or a preset"));
  };
  const std::string sides = strCat("1..", kQuiltGridMax);
  if (quilt.columns == 0) return missing("quilt.columns", sides);
  if (quilt.rows == 0) return missing("quilt.rows", sides);
  if (quilt.size_px != SizePx{}) return absl::OkStatus();
  return missing("quilt.size",
                 strCat("the width and the height of the whole quilt, 1..", kQuiltSidePxMax,
                        " px each, for example {\"width\": 3360, \"height\": 3360}"));
}

absl::Status completeDepthiness(QuiltSpec& quilt) {
  if (quilt.depthiness == 0) quilt.depthiness = 1;
  // Each formula takes the tangent of one angle, which has to stay in front of the eyes.
  const bool takes_half = quilt.convention != CameraConvention::kBridge;
  const double widest_rad =
      takes_half ? quilt.depthiness * quilt.view_cone_rad : 2 * quilt.view_cone_rad;
  if (widest_rad <= kViewAngleMax_rad) return absl::OkStatus();
  return invalidField("quilt.depthiness",
                      strCat("depthiness widens the cone of ", quilt.view_cone_rad, " rad to ",
                             widest_rad, " rad; accepted is up to ", kViewAngleMax_rad,
                             " rad: give a smaller depthiness or cone"));
}

// On the line of eyes, m; `place` is 0 at the cone's left end and 1 at its right end.
double placeOfEye(const QuiltSpec& quilt, double place, double distance_m) {
  const double share = place - 0.5;
  return quilt.convention == CameraConvention::kBridge
             ? distance_m * quilt.depthiness * std::tan(quilt.view_cone_rad) * share
             : distance_m * std::tan(quilt.depthiness * quilt.view_cone_rad * share);
}

}  // namespace

absl::Status takePreset(QuiltSpec& quilt) {
  if (quilt.preset.empty()) return requireShape(quilt);
  VIEWLOOM_RETURN_IF_ERROR(checkPreset(quilt.preset, "quilt.preset"));
  const Preset* preset = findPreset(quilt.preset);
  const auto fill = [](auto& given, auto value) {
    if (given == 0) given = value;
  };
  fill(quilt.columns, preset->columns);
  fill(quilt.rows, preset->rows);
  if (quilt.size_px == SizePx{}) quilt.size_px = preset->size_px;
  fill(quilt.aspect, preset->aspect);
  fill(quilt.view_cone_rad, preset->view_cone_deg * std::numbers::pi / 180);
  return absl::OkStatus();
}

absl::Status settle(QuiltSpec& quilt) {
  if (quilt.size_px.width < quilt.columns) {
    return invalidField("quilt.size.width",
                        strCat("the quilt is ", quilt.size_px.width, " px wide and has ",
                               quilt.columns, " columns; accepted is at least 1 px a column"));
  }
  if (quilt.size_px.height < quilt.rows) {
    return invalidField("quilt.size.height",
                        strCat("the quilt is ", quilt.size_px.height, " px high and has ",
                               quilt.rows, " rows; accepted is at least 1 px a row"));
  }
  if (quilt.view_cone_rad == 0) quilt.view_cone_rad = kDefaultViewCone_rad;
  const double tile_count = quilt.columns * quilt.rows;
  if (quilt.view_count == 0) quilt.view_count = quilt.columns * quilt.rows;
  VIEWLOOM_RETURN_IF_ERROR(checkRange(quilt.view_count, {1, tile_count}, "quilt.view_count"));
  if (quilt.cone_end == 0) quilt.cone_end = 1;
  VIEWLOOM_RETURN_IF_ERROR(checkRange(quilt.cone_end, {quilt.cone_begin, 1}, "quilt.cone_end"));
  return completeDepthiness(quilt);
}

TileGrid tileGrid(const QuiltSpec& quilt) {
  return {.size_field = "quilt.size",
          .columns = quilt.columns,
          .rows = quilt.rows,
          .tile_size_px = quiltTileSize(quilt),
          .order = quilt.order,
          .view_count = quilt.view_count,
          .width_px = quilt.size_px.width,
          .height_px = quilt.size_px.height};
}

double* focalPlane(QuiltSpec& quilt) {
  return &quilt.focal_distance_m;
}

std::optional<OpenFov> openFov(const QuiltSpec& quilt) {
  return OpenFov{"quilt.fov_y_rad", quilt.fov_y_rad};
}

std::vector<KnownDevice> devicesOf(const QuiltSpec&) {
  std::vector<KnownDevice> devices;
  for (const Preset& preset : allPresets()) {
    devices.push_back({.name = preset.name, .device = preset.device, .note = preset.note});
  }
  return devices;
}

double quiltAspect(const QuiltSpec& quilt) {
  if (quilt.aspect > 0) return quilt.aspect;
  const SizePx tile = quiltTileSize(quilt);
  return double{1} * tile.width / tile.height;
}

double quiltEye(const QuiltSpec& quilt, uint32_t view, double distance_m) {
  const double count = quilt.view_count;
  const double alone = 0.5;
  const double share = quilt.convention == CameraConvention::kWebxr ? (view + 0.5) / count
                       : count > 1                                  ? view / (count - 1)
                                                                    : alone;
  const double place = quilt.cone_begin + share * (quilt.cone_end - quilt.cone_begin);
  return placeOfEye(quilt, place, distance_m);
}

void describe(const QuiltSpec& quilt, const StreamDefaults& defaults, AtlasLayout& layout) {
  layout.aspect = quiltAspect(quilt);
  layout.view_cone_rad = quilt.view_cone_rad;
  layout.cone_begin = quilt.cone_begin;
  layout.cone_end = quilt.cone_end;
  layout.focal_distance_m = focalDistance(quilt.focal_distance_m, defaults);
  layout.suffix = absl::StrFormat("_qs%ux%ua%g", quilt.columns, quilt.rows, layout.aspect);
  const FocalWindow window =
      focalWindow(layout.focal_distance_m, quilt.fov_y_rad, layout.aspect, defaults);
  const auto eye = [&](uint32_t view) { return quiltEye(quilt, view, layout.focal_distance_m); };
  for (uint32_t view = 0; view < quilt.view_count; ++view) {
    layout.views.push_back({cameraThroughWindow(window, {eye(view), 0, 0}, layout.tile_size_px)});
  }
  layout.eye_focus_m = layout.focal_distance_m;
  const uint32_t last = quilt.view_count - 1;
  if (last > 0) {
    layout.view_pitch_m.x = (eye(last) - eye(0)) / last;
  } else if (quilt.cone_end - quilt.cone_begin < 1) {
    // One view of many: its neighbours stand a part away.
    layout.view_pitch_m.x = placeOfEye(quilt, quilt.cone_end, layout.focal_distance_m) -
                            placeOfEye(quilt, quilt.cone_begin, layout.focal_distance_m);
  }
}

}  // namespace viewloom
