// SPDX-License-Identifier: Apache-2.0
#include "display/rgbd.h"

#include <algorithm>
#include <cmath>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/focal_window.h"
#include "display/named_display.h"

namespace viewloom {
namespace {

constexpr uint32_t kDefaultDepthBits = 8;
// Share of the nearest 1/Z: the smallest range of a stream that lies at one depth.
constexpr double kRangeShareMin = 0.01;

// Default size of a view: half of a full-HD frame each way. No panel's own size is published.
constexpr SizePx kPresetViewSize_px{960, 540};
constexpr const char* kPresetNote =
    "a view has 960x540 pixels unless you give its size: the panel's size is not published, nor is "
    "the header that it reads inside the picture, which is not written";

// The 3D Interface White Paper of Philips; Dimenco's displays take the same. Both have white near,
// 8 bits, and the screen at code 128, an offset that their header could change.
struct KnownInput {
  KnownDevice device;
  RgbdForm form;
};

constexpr KnownInput kPresets[] = {
    {.device = {.name = "wowvx",
                .device = "Philips WOWvx, Dimenco: 2D-plus-Depth",
                .note = kPresetNote,
                .has_size = false},
     .form = RgbdForm::kColorDepth},
    {.device = {.name = "wowvx_declipse",
                .device = "Philips WOWvx: Declipse, four quadrants",
                .note = kPresetNote,
                .has_size = false},
     .form = RgbdForm::kTwoLayers},
};

// Distance of the screen, m; 0 = the range stays unchanged.
double screenDistance(const RgbdSpec& rgbd, const DepthCodes& range) {
  return rgbd.hasMiddleScreen() ? 2 / (range.inv_z_near + range.inv_z_far) : rgbd.screen_m;
}

bool isBeside(const RgbdSpec& rgbd) {
  return rgbd.depth_bits == 8 &&
         (rgbd.form == RgbdForm::kTwoLayers || rgbd.depth_placement == DepthPlacement::kRight ||
          rgbd.depth_placement == DepthPlacement::kLeft);
}

bool isBelow(const RgbdSpec& rgbd) {
  return rgbd.form == RgbdForm::kTwoLayers || (rgbd.depth_bits == 8 && !isBeside(rgbd));
}

absl::Status completePlacement(RgbdSpec& rgbd) {
  const bool has_place = rgbd.form == RgbdForm::kColorDepth && rgbd.depth_bits == 8;
  if (!has_place && rgbd.depth_placement) {
    return invalidField("rgbd.depth_placement",
                        rgbd.form == RgbdForm::kTwoLayers
                            ? "the four quadrants of TWO_LAYERS have fixed places; leave the "
                              "placement out"
                            : "depth of 16 bits comes beside the color, not in it; leave the "
                              "placement out, or use 8 bits");
  }
  if (has_place && !rgbd.depth_placement) rgbd.depth_placement = DepthPlacement::kRight;
  return absl::OkStatus();
}

// So that the middle code, half of all counted from black, is that of the screen.
void widenAround(double screen_inv_z, DepthCodes& codes) {
  const double middle = double{1} * (codes.codeMax() / 2 + 1);
  const double beyond = codes.is_black_near ? codes.codeMax() - middle : middle;  // in codes
  const double before = codes.codeMax() - beyond;
  const double inv_z_per_code = std::max((codes.inv_z_near - screen_inv_z) / before,
                                         (screen_inv_z - codes.inv_z_far) / beyond);
  codes.inv_z_near = screen_inv_z + before * inv_z_per_code;
  codes.inv_z_far = screen_inv_z - beyond * inv_z_per_code;
}

DepthCodes rangeOf(const RgbdSpec& rgbd, const StreamDefaults& defaults) {
  DepthCodes codes{.bits = rgbd.depth_bits,
                   .inv_z_near = rgbd.near_m > 0 ? 1 / rgbd.near_m : defaults.inv_z_near,
                   .inv_z_far = rgbd.far_m > 0 ? 1 / rgbd.far_m : defaults.inv_z_far,
                   .is_black_near = rgbd.is_black_near};
  if (rgbd.near_m == 0 && rgbd.far_m == 0) {
    // A stream of sky alone has no depth at all.
    if (!(codes.inv_z_near > 0)) codes.inv_z_near = StreamDefaults{}.inv_z_near;
    codes.inv_z_far = std::min(codes.inv_z_far, (1 - kRangeShareMin) * codes.inv_z_near);
  }
  return codes;
}

}  // namespace

absl::Status takePreset(RgbdSpec& rgbd) {
  if (rgbd.preset.empty()) {
    if (!rgbd.form) rgbd.form = RgbdForm::kColorDepth;
    return absl::OkStatus();
  }
  const auto preset = std::ranges::find_if(
      kPresets, [&](const KnownInput& known) { return known.device.name == rgbd.preset; });
  if (preset == std::end(kPresets)) {
    return unknownPreset(
        rgbd.preset, "rgbd.preset",
        {std::string(kPresets[0].device.name), std::string(kPresets[1].device.name)});
  }
  if (!rgbd.form) rgbd.form = preset->form;
  if (rgbd.view_size_px == SizePx{}) rgbd.view_size_px = kPresetViewSize_px;
  return absl::OkStatus();
}

absl::Status settle(RgbdSpec& rgbd) {
  if (rgbd.depth_bits == 0) rgbd.depth_bits = kDefaultDepthBits;
  if (rgbd.depth_bits != 8 && rgbd.depth_bits != 16) {
    return invalidField("rgbd.depth_bits",
                        strCat("got ", rgbd.depth_bits, "; accepted is 8 or 16"));
  }
  if (rgbd.near_m > 0 && rgbd.far_m > 0 && rgbd.far_m <= rgbd.near_m) {
    return invalidField(
        "rgbd.far_m",
        strCat("got ", rgbd.far_m, " m; accepted is more than near_m (", rgbd.near_m, " m)"));
  }
  return completePlacement(rgbd);
}

double* focalPlane(RgbdSpec&) {
  return nullptr;  // one view frames nothing that others do
}

std::optional<OpenFov> openFov(const RgbdSpec& rgbd) {
  return OpenFov{"rgbd.fov_y_rad", rgbd.fov_y_rad};
}

std::vector<KnownDevice> devicesOf(const RgbdSpec&) {
  std::vector<KnownDevice> devices;
  for (const KnownInput& preset : kPresets) devices.push_back(preset.device);
  return devices;
}

TileGrid tileGrid(const RgbdSpec& rgbd) {
  const uint32_t columns = isBeside(rgbd) ? 2 : 1;
  const uint32_t rows = isBelow(rgbd) ? 2 : 1;
  return {.size_field = "rgbd.view_size",
          .columns = columns,
          .rows = rows,
          .tile_size_px = rgbd.view_size_px,
          .order = TileOrder::kTopLeft,
          .view_count = columns * rows,
          .width_px = uint64_t{columns} * rgbd.view_size_px.width,
          .height_px = uint64_t{rows} * rgbd.view_size_px.height};
}

void describe(const RgbdSpec& rgbd, const StreamDefaults& defaults, AtlasLayout& layout) {
  DepthCodes codes = rangeOf(rgbd, defaults);
  const double screen_m = screenDistance(rgbd, codes);
  if (screen_m > 0 && codes.inv_z_near > codes.inv_z_far) widenAround(1 / screen_m, codes);
  layout.depth_codes = codes;
  layout.focal_distance_m = screen_m;
  // A view from the middle sees the same through a window at any distance.
  const FocalWindow window =
      focalWindow(focalDistance(screen_m, defaults), rgbd.fov_y_rad, layout.aspect, defaults);
  const Camera camera = cameraThroughWindow(window, glm::dvec3(0.0), rgbd.view_size_px);
  const bool depth_is_first =
      rgbd.depth_placement == DepthPlacement::kLeft || rgbd.depth_placement == DepthPlacement::kTop;
  const uint32_t count = layout.columns * layout.rows;
  for (uint32_t view = 0; view < count; ++view) {
    const bool is_two_layers = rgbd.form == RgbdForm::kTwoLayers;
    const bool is_second = is_two_layers ? view % layout.columns == 1 : view == 1;
    layout.views.push_back({.camera = camera,
                            .shows_depth = rgbd.depth_bits == 8 && is_second != depth_is_first,
                            .is_behind = is_two_layers && view / layout.columns == 1});
  }
}

absl::Status validateDepthCodes(const DepthCodes& codes) {
  if (codes.inv_z_near > codes.inv_z_far) return absl::OkStatus();
  return fieldError(
      absl::StatusCode::kFailedPrecondition, "rgbd.near_m",
      strCat("the range of depth is empty: its near end is at ", 1 / codes.inv_z_near,
             " m and its far end at ", 1 / codes.inv_z_far,
             " m, and one of them comes from the stream; give both near_m and far_m"));
}

bool showsDepth(const DisplaySpec& spec) {
  const auto* rgbd = std::get_if<RgbdSpec>(&spec.kind);
  return rgbd != nullptr && rgbd->depth_bits == 8;
}

bool hasDepthPlane(const DisplaySpec& spec) {
  const auto* rgbd = std::get_if<RgbdSpec>(&spec.kind);
  return rgbd != nullptr && rgbd->depth_bits == 16;
}

bool hasLayerBehind(const DisplaySpec& spec) {
  const auto* rgbd = std::get_if<RgbdSpec>(&spec.kind);
  return rgbd != nullptr && rgbd->form == RgbdForm::kTwoLayers;
}

}  // namespace viewloom
