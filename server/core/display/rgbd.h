// SPDX-License-Identifier: Apache-2.0
// Displays that compute their own views: one view and its depth as grey, or two layers of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "display/kind.h"

namespace viewloom {

struct DepthCodes;
struct DisplaySpec;

enum class RgbdForm : uint8_t { kColorDepth, kTwoLayers };
inline constexpr Word<RgbdForm> kRgbdForms[] = {{"COLOR_DEPTH", RgbdForm::kColorDepth},
                                                {"TWO_LAYERS", RgbdForm::kTwoLayers}};
// Place of the depth, seen from colour.
enum class DepthPlacement : uint8_t { kRight, kLeft, kTop, kBottom };
inline constexpr Word<DepthPlacement> kDepthPlacements[] = {{"RIGHT", DepthPlacement::kRight},
                                                            {"LEFT", DepthPlacement::kLeft},
                                                            {"TOP", DepthPlacement::kTop},
                                                            {"BOTTOM", DepthPlacement::kBottom}};

// One view with its depth as grey (proto RgbdDisplay).
struct RgbdSpec {
  static constexpr const char* kName = "rgbd";

  std::string preset;
  SizePx view_size_px;
  std::optional<RgbdForm> form;                   // never empty after completion
  std::optional<DepthPlacement> depth_placement;  // set by completion if depth lies in the colour
  bool is_black_near = false;
  double near_m = 0;        // 0 = from the stream
  double far_m = 0;         // may be infinite; 0 = from the stream
  double screen_m = 0;      // has the middle code; 0 = the preset's, or range not widened
  double fov_y_rad = 0;     // 0 = what the source sees
  uint32_t depth_bits = 0;  // 8 or 16; 0 = 8

  // Whether the preset puts the screen half way in 1/Z between the ends of the range.
  bool hasMiddleScreen() const { return !preset.empty() && screen_m == 0; }
};

template <SpecOf<RgbdSpec> Rgbd, typename Visitor>
void visitFields(Rgbd& rgbd, Visitor& visit) {
  visit.label("preset", rgbd.preset);
  visit.made([&] { return rgbd.hasMiddleScreen() ? "middle" : "given"; });
  visit("view_size", rgbd.view_size_px, Range{1, kEyeSidePxMax});
  visit.word("form", rgbd.form, kRgbdForms);
  visit.word("depth_placement", rgbd.depth_placement, kDepthPlacements);
  visit("black_near", rgbd.is_black_near);
  visit("near_m", rgbd.near_m, kOptionalDistance);
  visit("far_m", rgbd.far_m, Range{kFocalDistanceMin_m, kFocalDistanceMax_m, true, true});
  visit("screen_m", rgbd.screen_m, kOptionalDistance);
  visit("fov_y_rad", rgbd.fov_y_rad, kOptionalAngle);
  visit("depth_bits", rgbd.depth_bits, Range{8, 16, true});
}

absl::Status takePreset(RgbdSpec& rgbd);
absl::Status settle(RgbdSpec& rgbd);
TileGrid tileGrid(const RgbdSpec& rgbd);
// Lays out all tiles, seen from one eye in the middle of the display. The range of the codes can be
// empty if one end of it comes from the stream: see validateDepthCodes.
void describe(const RgbdSpec& rgbd, const StreamDefaults& defaults, AtlasLayout& layout);
double* focalPlane(RgbdSpec& rgbd);
std::optional<OpenFov> openFov(const RgbdSpec& rgbd);
// Known inputs. None is verified on hardware; the resolution of none is published.
std::vector<KnownDevice> devicesOf(const RgbdSpec& any);

// Checks the codes that describe() made. FAILED_PRECONDITION if the values of the stream and the
// display leave no range of depths.
absl::Status validateDepthCodes(const DepthCodes& codes);

// Whether the colour contains depth codes.
bool showsDepth(const DisplaySpec& spec);
// Whether the atlas has a plane of 16-bit codes.
bool hasDepthPlane(const DisplaySpec& spec);
// Whether the display shows the hidden surface behind the first one.
bool hasLayerBehind(const DisplaySpec& spec);

}  // namespace viewloom
