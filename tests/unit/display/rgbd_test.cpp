// SPDX-License-Identifier: Apache-2.0
#include "display/rgbd.h"
#include "display/atlas_layout.h"

#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::rgbd_test {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

RgbdSpec small() {
  return {.view_size_px = {64, 48}};
}

// Sees from 1 m to 4 m.
StreamDefaults someStream() {
  return {.source_intrinsics = {.focal_px = {100, 100}, .principal_px = {32, 24}},
          .source_size_px = {64, 48},
          .focal_distance_m = 1.6,
          .inv_z_near = 1,
          .inv_z_far = 0.25};
}

absl::StatusOr<AtlasLayout> layoutOf(const RgbdSpec& rgbd, const StreamDefaults& stream) {
  const absl::StatusOr<DisplaySpec> spec = completeDisplaySpec({.kind = rgbd});
  if (!spec.ok()) return spec.status();
  return makeAtlasLayout(*spec, stream);
}

// Kind of each tile, row by row from the top: c colour, d depth; capitals for the layer behind.
std::string tilesOf(const AtlasLayout& layout) {
  std::string tiles;
  for (uint32_t row = 0; row < layout.rows; ++row) {
    for (uint32_t column = 0; column < layout.columns; ++column) {
      const View& view = layout.views[layout.viewAt(column, row)];
      tiles += view.is_behind ? (view.shows_depth ? 'D' : 'C') : (view.shows_depth ? 'd' : 'c');
    }
    tiles += '/';
  }
  return tiles;
}

uint32_t codeOf(double inv_z, const AtlasLayout& layout) {
  return abi::depthCode(float(inv_z), scaleOf(*layout.depth_codes));
}

TEST(Rgbd, placesDepthWhereItIsAskedFor) {
  const auto tilesAt = [](std::optional<DepthPlacement> placement) {
    RgbdSpec rgbd = small();
    rgbd.depth_placement = placement;
    return tilesOf(*layoutOf(rgbd, someStream()));
  };
  EXPECT_EQ(tilesAt(std::nullopt), "cd/");
  EXPECT_EQ(tilesAt(DepthPlacement::kRight), "cd/");
  EXPECT_EQ(tilesAt(DepthPlacement::kLeft), "dc/");
  EXPECT_EQ(tilesAt(DepthPlacement::kTop), "d/c/");
  EXPECT_EQ(tilesAt(DepthPlacement::kBottom), "c/d/");
}

TEST(Rgbd, putsWhatLiesBehindBelowBoth) {
  RgbdSpec rgbd = small();
  rgbd.form = RgbdForm::kTwoLayers;
  EXPECT_EQ(tilesOf(*layoutOf(rgbd, someStream())), "cd/CD/");
}

TEST(Rgbd, leavesColorAloneWhereDepthHas16Bits) {
  RgbdSpec rgbd = small();
  rgbd.depth_bits = 16;
  EXPECT_EQ(tilesOf(*layoutOf(rgbd, someStream())), "c/");
  EXPECT_TRUE(hasDepthPlane({.kind = rgbd}));
  EXPECT_FALSE(showsDepth({.kind = rgbd}));
  rgbd.form = RgbdForm::kTwoLayers;
  EXPECT_EQ(tilesOf(*layoutOf(rgbd, someStream())), "c/C/");
  EXPECT_FALSE(hasDepthPlane({.kind = small()}));
}

TEST(Rgbd, looksFromTheMiddleAsTheSourceDoes) {
  const AtlasLayout layout = *layoutOf(small(), someStream());
  for (const View& view : layout.views) {
    EXPECT_EQ(view.camera.pose.position_m, glm::dvec3(0.0));
    EXPECT_EQ(view.camera.intrinsics.focal_px, glm::dvec2(100, 100));
    EXPECT_EQ(view.camera.intrinsics.principal_px, glm::dvec2(32, 24));
  }
}

TEST(Rgbd, countsFromTheStreamsFarEndToItsNearOne) {
  const AtlasLayout layout = *layoutOf(small(), someStream());
  EXPECT_EQ(codeOf(1.0, layout), 255u);
  EXPECT_EQ(codeOf(0.25, layout), 0u);
  EXPECT_EQ(codeOf(0.25 + 0.75 * 100 / 255, layout), 100u);
  EXPECT_EQ(codeOf(0.25 + 0.75 * 100.4 / 255, layout), 100u);
  EXPECT_EQ(codeOf(0.25 + 0.75 * 100.6 / 255, layout), 101u);
  EXPECT_EQ(codeOf(7, layout), 255u);
  EXPECT_EQ(codeOf(0, layout), 0u);
}

TEST(Rgbd, countsFromBlackWhereThatIsNear) {
  RgbdSpec rgbd = small();
  rgbd.is_black_near = true;
  rgbd.depth_bits = 16;
  rgbd.near_m = 0.5;
  rgbd.far_m = kInf;
  const AtlasLayout layout = *layoutOf(rgbd, someStream());
  EXPECT_EQ(codeOf(2, layout), 0u);
  EXPECT_EQ(codeOf(0, layout), 65535u);
  EXPECT_EQ(codeOf(0.5, layout), 49151u);  // three quarters of 65535, rounded
}

TEST(Rgbd, givesTheScreenTheMiddleCodeAndKeepsAllInRange) {
  for (const bool is_black_near : {false, true}) {
    for (const uint32_t bits : {8u, 16u}) {
      for (const double screen_m : {0.2, 1.0, 1.6, 4.0, 50.0}) {
        RgbdSpec rgbd = small();
        rgbd.is_black_near = is_black_near;
        rgbd.depth_bits = bits;
        rgbd.screen_m = screen_m;
        const AtlasLayout layout = *layoutOf(rgbd, someStream());
        const DepthCodes& codes = *layout.depth_codes;
        EXPECT_EQ(codeOf(1 / screen_m, layout), bits == 8 ? 128u : 32768u) << screen_m;
        EXPECT_GE(codes.inv_z_near, 1.0 - 1e-12) << screen_m;
        EXPECT_LE(codes.inv_z_far, 0.25 + 1e-12) << screen_m;
        // Widened on one side alone.
        const double rest = std::min(codes.inv_z_near - 1, 0.25 - codes.inv_z_far);
        EXPECT_TRUE(rest < 1e-12 || screen_m == 0.2 || screen_m == 50) << screen_m;
        EXPECT_EQ(layout.focal_distance_m, screen_m);
      }
    }
  }
}

TEST(Rgbd, hasTheScreenOfAPresetHalfWayInItsRange) {
  RgbdSpec rgbd = small();
  rgbd.preset = "wowvx";
  const AtlasLayout layout = *layoutOf(rgbd, someStream());
  EXPECT_EQ(tilesOf(layout), "cd/");
  EXPECT_DOUBLE_EQ(layout.focal_distance_m, 1.6) << "the harmonic mean of 1 m and 4 m";
  EXPECT_EQ(codeOf(1 / 1.6, layout), 128u);
  EXPECT_EQ(codeOf(1, layout), 255u);
  EXPECT_EQ(codeOf(0.25, layout), 1u) << "as far from the middle, of which there is one code more";

  rgbd.far_m = kInf;
  EXPECT_DOUBLE_EQ(layoutOf(rgbd, someStream())->focal_distance_m, 2);
  rgbd.screen_m = 3;
  const AtlasLayout said = *layoutOf(rgbd, someStream());
  EXPECT_EQ(said.focal_distance_m, 3);
  EXPECT_EQ(codeOf(1.0 / 3, said), 128u);
}

TEST(Rgbd, takesWhatIsSaidBesideAPreset) {
  RgbdSpec rgbd = small();
  rgbd.preset = "wowvx_declipse";
  EXPECT_EQ(tilesOf(*layoutOf(rgbd, someStream())), "cd/CD/");
  rgbd.form = RgbdForm::kColorDepth;
  rgbd.depth_placement = DepthPlacement::kTop;
  rgbd.is_black_near = true;
  const AtlasLayout layout = *layoutOf(rgbd, someStream());
  EXPECT_EQ(tilesOf(layout), "d/c/");
  EXPECT_LE(codeOf(1, layout), 1u);
  EXPECT_EQ(codeOf(0.25, layout), 255u);
}

TEST(Rgbd, findsARangeInStreamsThatHaveNone) {
  StreamDefaults flat = someStream();
  flat.inv_z_near = flat.inv_z_far = 0.5;
  EXPECT_EQ(codeOf(0.5, *layoutOf(small(), flat)), 255u);
  StreamDefaults sky = someStream();
  sky.inv_z_near = sky.inv_z_far = 0;
  EXPECT_EQ(codeOf(0, *layoutOf(small(), sky)), 0u);
}

TEST(Rgbd, refusesARangeThatTheStreamLeavesEmpty) {
  RgbdSpec rgbd = small();
  rgbd.near_m = 5;
  const absl::Status status = layoutOf(rgbd, someStream()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(fieldOf(status), "rgbd.near_m");
  EXPECT_THAT(std::string(status.message()), HasSubstr("5 m"));
}

struct BadRgbd {
  std::string field;
  std::function<void(RgbdSpec&)> spoil;
};

TEST(Rgbd, refusesByFieldWhatCannotBe) {
  const std::vector<BadRgbd> cases = {
      {"rgbd.preset", [](auto& r) { r.preset = "portrait"; }},
      {"rgbd.view_size.width", [](auto& r) { r.view_size_px.width = 0; }},
      {"rgbd.view_size.height", [](auto& r) { r.view_size_px.height = 8193; }},
      {"rgbd.depth_bits", [](auto& r) { r.depth_bits = 7; }},
      {"rgbd.near_m", [](auto& r) { r.near_m = -1; }},
      {"rgbd.near_m", [](auto& r) { r.near_m = kNan; }},
      {"rgbd.near_m", [](auto& r) { r.near_m = kInf; }},
      {"rgbd.far_m", [](auto& r) { r.far_m = 1e10; }},
      {"rgbd.far_m", [](auto& r) { r.far_m = -kInf; }},
      {"rgbd.far_m",
       [](auto& r) {
         r.near_m = 2;
         r.far_m = 2;
       }},
      {"rgbd.screen_m", [](auto& r) { r.screen_m = 1e-9; }},
      {"rgbd.fov_y_rad", [](auto& r) { r.fov_y_rad = 3; }},
      {"rgbd.depth_placement",
       [](auto& r) {
         r.form = RgbdForm::kTwoLayers;
         r.depth_placement = DepthPlacement::kRight;
       }},
      {"rgbd.depth_placement",
       [](auto& r) {
         r.depth_bits = 16;
         r.depth_placement = DepthPlacement::kTop;
       }},
  };
  for (const BadRgbd& bad : cases) {
    RgbdSpec rgbd = small();
    bad.spoil(rgbd);
    EXPECT_EQ(fieldOf(completeDisplaySpec({.kind = rgbd}).status()), bad.field);
  }
}

TEST(Rgbd, isAnotherPictureWithAnyOtherRange) {
  const auto keyOf = [](const RgbdSpec& rgbd) {
    return displayKey(completeDisplaySpec({.kind = rgbd}).value());
  };
  const std::string key = keyOf(small());
  RgbdSpec other = small();
  other.depth_placement = DepthPlacement::kRight;
  other.depth_bits = 8;
  EXPECT_EQ(keyOf(other), key);
  for (double RgbdSpec::*field :
       {&RgbdSpec::near_m, &RgbdSpec::far_m, &RgbdSpec::screen_m, &RgbdSpec::fov_y_rad}) {
    RgbdSpec changed = small();
    changed.*field = 2;
    EXPECT_NE(keyOf(changed), key);
  }
  other.preset = "wowvx";
  EXPECT_NE(keyOf(other), key) << "its screen has the middle code";
  RgbdSpec said = small();
  said.screen_m = other.screen_m = 2;
  EXPECT_EQ(keyOf(other), keyOf(said));
  other.is_black_near = true;
  EXPECT_NE(keyOf(other), keyOf(said));
}

}  // namespace
}  // namespace viewloom::rgbd_test
