// SPDX-License-Identifier: Apache-2.0
// Colours of rays that end behind a surface: the far side of the silhouette they passed last.
#include <cmath>
#include <functional>

#include <glm/gtc/packing.hpp>

#include "gpu/sweep_under_test.h"
#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/srgb_transfer.h"
#include "support/test_device.h"

namespace viewloom::fill_test {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr double kFocal_px = 1.25 * kWidth;  // of the analytic scenes
constexpr double kTolerance_px = 0.05;
// sRGB-encoded; binary16 and the fits of the sRGB curve: half an 8-bit step.
constexpr float kColorTolerance = 0.5f / 255;
// Tolerance of a place between two samples: positions have 1/256 px.
constexpr double kShareTolerance = 1.0 / 256;
using ColorOf = std::function<LinearColor(int column, int row)>;  // premultiplied linear light

constexpr LinearColor kRed = {1, 0, 0, 1};
constexpr LinearColor kGreen = {0, 1, 0, 1};
constexpr LinearColor kBlue = {0, 0, 1, 1};

bool isAlike(const LinearColor& srgb, const LinearColor& linear,
             float tolerance = kColorTolerance) {
  for (size_t i = 0; i < 3; ++i) {
    if (std::abs(srgb[i] - srgbFrom(linear[i])) > tolerance) return false;
  }
  return true;
}

// Opaque: 8-bit samples, else binary16.
Frame painted(const oracle::Scene& scene, const ColorOf& color_of, bool is_opaque) {
  Frame frame = is_opaque ? *frameOf(scene) : *frameOf(scene, {LinearColor{}});
  auto bytes = std::make_shared<std::vector<uint8_t>>();
  for (int i = 0; i < kWidth * kHeight; ++i) {
    for (const float channel : color_of(i % kWidth, i / kWidth)) {
      const uint16_t half = glm::packHalf1x16(channel);
      if (is_opaque) {
        bytes->push_back(uint8_t(std::lround(255 * srgbFrom(channel))));
      } else {
        bytes->insert(bytes->end(), {uint8_t(half), uint8_t(half >> 8)});
      }
    }
  }
  frame.sources[0][0].color = bytes;
  return frame;
}

class FillTest : public GpuTest {
 protected:
  TracedView trace(const oracle::Scene& scene, const ColorOf& color_of, double eye_x_m,
                   bool is_opaque = true) {
    return walk_
        .trace(*walk_.build(painted(scene, color_of, is_opaque)), {viewFrom(scene, eye_x_m)},
               kTolerance_px)
        .front();
  }

  // The same, opaque, by the walk and by the sweep.
  std::array<TracedView, 2> traceBoth(const oracle::Scene& scene, const ColorOf& color_of,
                                      double eye_x_m) {
    SweepUnderTest sweep;
    sweep.prepare(std::make_shared<Frame>(painted(scene, color_of, true)));
    return {trace(scene, color_of, eye_x_m),
            sweep.trace({viewFrom(scene, eye_x_m)}, kTolerance_px).front()};
  }

  static oracle::OutputView viewFrom(const oracle::Scene& scene, double eye_x_m) {
    oracle::OutputView view = oracle::ownView(scene);
    view.position_m.x = eye_x_m;
    return view;
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
};

// Visits the hidden px of a view.
void forEachHidden(const TracedView& view,
                   const std::function<void(int column, const LinearColor& srgb)>& visit) {
  int hidden_count = 0;
  for (size_t i = 0; i < view.records.size(); ++i) {
    if (view.records[i].ray_class != abi::kClassHidden) continue;
    visit(int(i % kWidth), view.srgb[i]);
    ++hidden_count;
  }
  EXPECT_GE(hidden_count, kHeight);
}

// A wall of three colours that change behind the middles of two poles.
constexpr double kWall = 0.25;
constexpr int kFirstPole = 27;
constexpr int kSecondPole = 34;
constexpr int kPoleWidth = 3;

bool isPole(int column) {
  return (column >= kFirstPole && column < kFirstPole + kPoleWidth) ||
         (column >= kSecondPole && column < kSecondPole + kPoleWidth);
}

oracle::Scene polesBeforeWall() {
  oracle::Scene scene = oracle::planeScene({0, 0, kWall}, kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      if (isPole(column)) scene.planes.at(0, column, row) = 1;
    }
  }
  return scene;
}

LinearColor colorOfPolesAndWall(int column, int) {
  if (isPole(column)) return {1, 1, 1, 1};
  return column < kFirstPole ? kRed : column < kSecondPole ? kGreen : kBlue;
}

TEST_F(FillTest, behindEachPoleTheWallGoesOnFromTheSideTheRayCameFrom) {
  // Far enough that rays pass behind one pole and come out again before they end behind the other.
  for (const double eye_x_m : {0.3, -0.3}) {
    const TracedView view = trace(polesBeforeWall(), colorOfPolesAndWall, eye_x_m);
    forEachHidden(view, [&](int column, const LinearColor& srgb) {
      const double wall_x_px = column + 0.5 + kFocal_px * eye_x_m * kWall;
      const bool is_first = wall_x_px < kFirstPole + kPoleWidth;
      const LinearColor& from_left = is_first ? kRed : kGreen;
      const LinearColor& from_right = is_first ? kGreen : kBlue;
      EXPECT_TRUE(isAlike(srgb, eye_x_m > 0 ? from_right : from_left))
          << "eye " << eye_x_m << " m, column " << column << ", behind "
          << (is_first ? "the first" : "the second");
    });
  }
}

// Samples of the wall beside the poles hold half of the poles' white.
LinearColor mixedBesidePoles(int column, int) {
  const bool is_beside = isPole(column - 1) || isPole(column + 1);
  return isPole(column) ? LinearColor{1, 1, 1, 1} : is_beside ? LinearColor{1, 1, 0, 1} : kGreen;
}

TEST_F(FillTest, aMixedSampleBesideADeepSilhouetteGivesWayToTheNextOne) {
  constexpr double kEye_x_m = 0.1;
  const TracedView view = trace(polesBeforeWall(), mixedBesidePoles, kEye_x_m);
  int wall_count = 0;
  for (size_t i = 0; i < view.records.size(); ++i) {
    const bool is_pole = view.records[i].inv_z > 0.5f;
    const bool is_wall = view.records[i].ray_class <= abi::kClassHitAssumed && !is_pole;
    const bool is_hidden = view.records[i].ray_class == abi::kClassHidden;
    if (!is_wall && !is_hidden) continue;
    EXPECT_TRUE(isAlike(view.srgb[i], kGreen))
        << "column " << i % kWidth << ", red " << view.srgb[i][0];
    wall_count += is_wall;
  }
  EXPECT_GT(wall_count, kWidth * kHeight / 2);
}

TEST_F(FillTest, fromItsOwnPlaceTheSourceKeepsItsMixedSamples) {
  const TracedView view = trace(polesBeforeWall(), mixedBesidePoles, 0);
  for (size_t i = 0; i < view.records.size(); ++i) {
    const LinearColor own = mixedBesidePoles(int(i % kWidth), 0);
    EXPECT_TRUE(isAlike(view.srgb[i], own)) << "column " << i % kWidth;
  }
}

// A step of a tenth is one thing that is steep: what shows between its sides is between their
// colours. A strip far behind shows that the step is a small one.
TEST_F(FillTest, behindAShallowStepColorGoesFromSideToSide) {
  constexpr int kEdge = 8;
  constexpr double kNear = 0.5;
  constexpr double kFar = 0.45;
  oracle::Scene scene =
      oracle::stepScene({0, 0, kNear}, {0, 0, kFar}, kEdge, false, kWidth, kHeight);
  constexpr int kStrip_px = 4;
  for (int i = 0; i < kStrip_px * kWidth; ++i) {
    scene.planes.at(0, i % kWidth, kHeight - 1 - i / kWidth) = 0.1F * float(kFar);
  }
  constexpr double kEye_x_m = -1;  // the step is 4 px wide
  const TracedView view = trace(
      scene, [](int column, int) { return column < kEdge ? kRed : kBlue; }, kEye_x_m);
  int between_count = 0;
  forEachHidden(view, [&](int column, const LinearColor& srgb) {
    const double inv_z_at_edge = (kEdge - (column + 0.5)) / (kFocal_px * kEye_x_m);
    if (inv_z_at_edge > kNear || inv_z_at_edge < kFar) return;  // came in behind the near side
    ++between_count;
    const double near_share = (inv_z_at_edge - kFar) / (kNear - kFar);
    EXPECT_NEAR(srgb[0], 1 - near_share, kShareTolerance) << "column " << column;
    EXPECT_NEAR(srgb[2], near_share, kShareTolerance) << "column " << column;
  });
  EXPECT_GE(between_count, 4 * (kHeight - kStrip_px));
}

TEST_F(FillTest, whoEntersTheImageBehindTheGroundSeesTheGroundAtItsBorder) {
  const oracle::Scene ground = oracle::planeScene({0, 1.0 / 128, 0.125}, kWidth, kHeight);
  constexpr int kBorder_px = 2;
  const TracedView view = trace(
      ground, [](int column, int) { return column < kWidth - kBorder_px ? kRed : kBlue; }, 0.5);
  forEachHidden(view, [&](int column, const LinearColor& srgb) {
    EXPECT_TRUE(isAlike(srgb, kBlue)) << "column " << column;
  });
}

// The first pole alone, with nothing around it as far as `hole_px`; then the wall.
oracle::Scene poleInAHole(int hole_px) {
  oracle::Scene scene = oracle::planeScene({0, 0, kWall}, kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const bool is_pole = column >= kFirstPole && column < kSecondPole;
      const bool is_hole = column >= kFirstPole - hole_px && column < kSecondPole + hole_px;
      if (is_hole) scene.planes.at(0, column, row) = is_pole ? 1 : -1;
    }
  }
  return scene;
}

LinearColor colorAroundAHole(int column, int) {
  if (column >= kFirstPole && column < kSecondPole) return {1, 1, 1, 1};
  return column < kFirstPole ? kRed : kBlue;
}

TEST_F(FillTest, behindWhatStandsInNothingIsTheBackground) {
  for (const double eye_x_m : {0.3, -0.3}) {
    for (const TracedView& view : traceBoth(poleInAHole(kWidth), colorAroundAHole, eye_x_m)) {
      forEachHidden(view, [&](int column, const LinearColor& srgb) {
        EXPECT_TRUE(isAlike(srgb, {0, 0, 0, 1})) << "eye " << eye_x_m << " m, column " << column;
      });
    }
  }
}

// Rays end behind the pole, which they came to over the hole before it, and behind the wall, which
// they came to over the hole beyond it.
TEST_F(FillTest, besideHolesTheWallGoesOn) {
  for (const double eye_x_m : {0.3, -0.3}) {
    for (const TracedView& view : traceBoth(poleInAHole(6), colorAroundAHole, eye_x_m)) {
      int behind_pole_count = 0;
      forEachHidden(view, [&](int column, const LinearColor& srgb) {
        const bool is_behind_pole = column >= kFirstPole && column < kSecondPole;
        behind_pole_count += is_behind_pole ? 1 : 0;
        const bool is_right = is_behind_pole ? eye_x_m > 0 : column >= kSecondPole;
        EXPECT_TRUE(isAlike(srgb, is_right ? kBlue : kRed))
            << "eye " << eye_x_m << " m, column " << column;
      });
      EXPECT_GT(behind_pole_count, 0);
    }
  }
}

TEST_F(FillTest, throughWhatStandsInNothingIsTheBackground) {
  const LinearColor glass = {0.25f, 0.125f, 0.5f, 0.5f};
  const TracedView view = trace(
      poleInAHole(kWidth), [&](int, int) { return glass; }, 0, false);
  for (int column = kFirstPole; column < kSecondPole; ++column) {
    EXPECT_TRUE(isAlike(view.srgb[view.index(column, kHeight / 2)], glass)) << "column " << column;
  }
}

TEST_F(FillTest, behindASoftEdgeIsTheFarSideAndNotTheSurfaceItself) {
  constexpr int kEdge = 20;
  constexpr int kSoft_px = 32;
  const oracle::Scene scene =
      oracle::stepScene({0, 0, 1.0}, {0, 0, 0}, kEdge, false, kWidth, kHeight);
  const auto light_at = [](double x_px) {
    return float(std::clamp((x_px - kEdge) / kSoft_px, 0.0, 1.0));
  };
  const auto soft = [&](int column, int) -> LinearColor {
    const float light = light_at(column + 0.5);
    return {light, light, light, column < kEdge ? 1 : light};
  };
  const TracedView view = trace(scene, soft, -0.1, false);
  int compared_count = 0;
  for (size_t i = 0; i < view.records.size(); ++i) {
    const abi::RayRecord& record = view.records[i];
    if (record.ray_class != abi::kClassHit || record.inv_z < 0.5f) continue;
    if (record.x_px < kEdge + 1 || record.x_px > kEdge + kSoft_px - 1) continue;
    const float light = light_at(double{record.x_px});
    EXPECT_TRUE(isAlike(view.srgb[i], {light, light, light, 1})) << record.x_px << " px";
    ++compared_count;
  }
  EXPECT_GE(compared_count, kHeight);
}

}  // namespace
}  // namespace viewloom::fill_test
