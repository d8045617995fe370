// SPDX-License-Identifier: Apache-2.0
#include "display/integral.h"

#include <algorithm>
#include <cmath>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/named_display.h"

namespace viewloom {
namespace {

constexpr double kMetresPerInch = 0.0254;

struct KnownPanel {
  KnownDevice device;
  double pixel_pitch_m;
  double lens_pitch_m;
  double focal_length_m;
};

constexpr KnownPanel kPanels[] = {
    {.device = {.name = "near_eye_2013",
                .device = "Near-eye display of Lanman and Luebke, 2013",
                .note = "a Sony ECX332A of 15.36 x 8.64 mm; the paper crops it to 15 x 8 lenses",
                .panel_px = {1280, 720},
                .panel_dpi = kMetresPerInch / (15.36e-3 / 1280)},
     .pixel_pitch_m = 15.36e-3 / 1280,
     .lens_pitch_m = 1e-3,
     .focal_length_m = 3.3e-3},
};

// Fills in as many whole lenses as fit on the panel; checks that they do not cover more than it
// has.
absl::Status completeLensCount(uint32_t& count, uint32_t side_px, double lens_px,
                               const std::string& field) {
  if (count == 0) count = std::max(1u, static_cast<uint32_t>(side_px / lens_px));
  return checkRange(count, {1, std::ceil(side_px / lens_px)}, field);
}

}  // namespace

absl::Status takePreset(IntegralSpec& integral) {
  if (integral.preset.empty()) return absl::OkStatus();
  const auto preset = std::find_if(std::begin(kPanels), std::end(kPanels), [&](const auto& known) {
    return integral.preset == known.device.name;
  });
  if (preset == std::end(kPanels)) {
    return unknownPreset(integral.preset, "integral.preset", {std::string(kPanels[0].device.name)});
  }
  const auto fill = [](double& given, double value) {
    if (given == 0) given = value;
  };
  if (integral.panel_px == SizePx{}) integral.panel_px = preset->device.panel_px;
  fill(integral.pixel_pitch_m, preset->pixel_pitch_m);
  fill(integral.lens_pitch_m, preset->lens_pitch_m);
  fill(integral.focal_length_m, preset->focal_length_m);
  return absl::OkStatus();
}

absl::Status settle(IntegralSpec& integral) {
  const double lens_px = integral.lens_pitch_m / integral.pixel_pitch_m;
  if (lens_px < kLensPxMin || lens_px > kLensPxMax) {
    return invalidField(
        "integral.lens_pitch_m",
        strCat("a lens covers ", lens_px, " px of the panel; accepted is ", kLensPxMin, "..",
               kLensPxMax, " px: change lens_pitch_m or pixel_pitch_m"));
  }
  if (integral.scale == 0) integral.scale = 1;
  VIEWLOOM_RETURN_IF_ERROR(completeLensCount(integral.lens_columns, integral.panel_px.width,
                                             lens_px, "integral.lens_columns"));
  return completeLensCount(integral.lens_rows, integral.panel_px.height, lens_px,
                           "integral.lens_rows");
}

double* focalPlane(IntegralSpec&) {
  return nullptr;  // its panel stands where it stands
}

std::optional<OpenFov> openFov(const IntegralSpec&) {
  return std::nullopt;  // its lenses give it
}

std::vector<KnownDevice> devicesOf(const IntegralSpec&) {
  std::vector<KnownDevice> devices;
  for (const KnownPanel& preset : kPanels) devices.push_back(preset.device);
  return devices;
}

TileGrid tileGrid(const IntegralSpec& integral) {
  return {.size_field = "integral.panel_size",
          .columns = 1,
          .rows = 1,
          .tile_size_px = integral.panel_px,
          .order = TileOrder::kTopLeft,
          .view_count = 1,
          .width_px = integral.panel_px.width,
          .height_px = integral.panel_px.height};
}

void describe(const IntegralSpec& integral, const StreamDefaults&, AtlasLayout& layout) {
  const double lens_px = integral.lens_pitch_m / integral.pixel_pitch_m;
  const double focal_px = integral.focal_length_m / integral.pixel_pitch_m;
  const glm::dvec2 middle_px = 0.5 * glm::dvec2(integral.panel_px.width, integral.panel_px.height);
  const glm::dvec2 lens_count(integral.lens_columns, integral.lens_rows);
  layout.rays =
      MicrolensRays{.lens_pitch_px = lens_px,
                    .first_px = middle_px + integral.offset_px - 0.5 * lens_px * lens_count,
                    .columns = integral.lens_columns,
                    .rows = integral.lens_rows,
                    .middle_px = middle_px,
                    .m_per_px = integral.pixel_pitch_m * integral.scale,
                    .distance_m = integral.distance_m,
                    .is_flipped = integral.is_flipped};
  // A lens shows the view of a pinhole in its middle, in pixels of the panel from there.
  layout.views = {{Camera{.intrinsics = {.focal_px = glm::dvec2(focal_px)}}}};
  // From an eye further away, a px of a lens is seen through the whole of it.
  layout.view_pitch_m = glm::dvec2(integral.lens_pitch_m * integral.scale);
}

}  // namespace viewloom
