// SPDX-License-Identifier: Apache-2.0
// Depth of surfaces that move in every direction, beside rays through the triangles between their
// samples in space; and whether threads change anything.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <optional>
#include <random>

#include <glm/geometric.hpp>

#include "retime/frame_retimer.h"
#include "unit/retime/moved_frames.h"

namespace viewloom::test::retimed_depth_test {
namespace {

using glm::dvec3;

constexpr double kTime_s = 0.1;
// Positions may be off by a few binary32 ulps at 32 px. The steepest surface here changes by
// 0.05 1/m a pixel, so its depth is off by that much of the error.
constexpr double kInvZError = 1e-5;
// Tolerance at a triangle's edge, in shares: rounding may put a pixel on either side.
constexpr double kEdge = 1e-4;

dvec3 rayThrough(double x_px, double y_px) {
  return {(x_px - 0.5 * kMovedPx.width) / kMovedFocal_px,
          (0.5 * kMovedPx.height - y_px) / kMovedFocal_px, -1};
}

// Waves that turn, grow and sway; no two samples move alike.
MovingPx waveAt(uint32_t x, uint32_t y) {
  MovingPx px;
  px.inv_z = float(0.5 + 0.03 * std::sin(0.5 * x) + 0.04 * std::cos(0.4 * y + 0.2 * x));
  px.color = colorOfPx(x, y, 77);
  const dvec3 point = rayThrough(x + 0.5, y + 0.5) / double{px.inv_z};
  px.motion_mps =
      glm::vec3(dvec3(0.8, -0.5, 1.5) + glm::cross(dvec3(0.4, 0.8, -1.5), point - dvec3(0, 0, -2)));
  // Rounded to values that the wire's encoding holds exactly.
  for (int i = 0; i < 3; ++i) px.motion_mps[i] = std::round(px.motion_mps[i] * 64) / 64;
  return px;
}

dvec3 movedPoint(uint32_t x, uint32_t y) {
  const MovingPx px = waveAt(x, y);
  return rayThrough(x + 0.5, y + 0.5) / double{px.inv_z} + kTime_s * dvec3(px.motion_mps);
}

struct Met {
  double inv_z = 0;
  double least_share = 0;  // how far inside
};

// Meets a ray from the origin with a triangle, after Moeller and Trumbore. Empty if the point on
// the triangle's plane lies outside by more than kEdge.
std::optional<Met> meet(const dvec3& ray, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 along_b = b - a, along_c = c - a;
  const dvec3 p = glm::cross(ray, along_c);
  const double determinant = glm::dot(along_b, p);
  if (std::abs(determinant) < 1e-14) return std::nullopt;
  const double u = glm::dot(-a, p) / determinant;
  const dvec3 q = glm::cross(-a, along_b);
  const double v = glm::dot(ray, q) / determinant;
  const double depth = glm::dot(along_c, q) / determinant;
  const double least = std::min({u, v, 1 - u - v});
  if (depth <= 0 || least < -kEdge) return std::nullopt;
  return Met{1 / depth, least};
}

TEST(RetimedDepth, isThatOfTheTrianglesBetweenMovedSamples) {
  WorkerPool workers(3);
  const FramePtr later = FrameRetimer(workers).retime(movingFrame({waveAt}, 10), kTime_s);
  int compared = 0;
  // Border pixels are skipped: quarters of footprints are flat there, and may turn before the
  // triangles do.
  for (uint32_t y = 2; y < kMovedPx.height - 2; ++y) {
    for (uint32_t x = 2; x < kMovedPx.width - 2; ++x) {
      const dvec3 ray = rayThrough(x + 0.5, y + 0.5);
      Met nearest;
      for (uint32_t j = 0; j + 1 < kMovedPx.height; ++j) {
        for (uint32_t i = 0; i + 1 < kMovedPx.width; ++i) {
          const dvec3 right = movedPoint(i + 1, j), below = movedPoint(i, j + 1);
          for (const auto& met : {meet(ray, movedPoint(i, j), right, below),
                                  meet(ray, right, movedPoint(i + 1, j + 1), below)}) {
            if (met && met->inv_z > nearest.inv_z) nearest = *met;
          }
        }
      }
      if (nearest.inv_z == 0) continue;  // beyond its edge
      ++compared;
      EXPECT_NEAR(invZAt(*later, 0, x, y), nearest.inv_z, kInvZError) << x << ", " << y;
    }
  }
  EXPECT_GT(compared, int(kMovedPx.area()) / 2);
}

// Three layers, with holes, of which hardly a quad is whole.
FramePtr noisyFrame(SizePx size_px = kMovedPx) {
  std::mt19937 random(5);
  const auto uniform = [&] { return float(random() >> 8) / float(1 << 24); };
  const auto noise = [&](uint32_t x, uint32_t y) {
    return MovingPx{.inv_z = uniform() < 0.1F ? -1 : 0.2F + 0.3F * uniform(),
                    .color = colorOfPx(x, y, 1),
                    .motion_mps = 20.0F * glm::vec3(uniform(), uniform(), uniform()) - 10.0F};
  };
  return movingFrame({noise, noise, noise}, 0.02, {}, size_px);
}

void expectSamePlanes(const Frame& one, const Frame& other) {
  for (size_t layer = 0; layer < one.sources[0].size(); ++layer) {
    EXPECT_EQ(*one.sources[0][layer].depth, *other.sources[0][layer].depth);
    EXPECT_EQ(*one.sources[0][layer].color, *other.sources[0][layer].color);
  }
}

TEST(RetimedDepth, isTheSameHoweverManyThreadsDrawIt) {
  const FramePtr frame = noisyFrame();
  WorkerPool alone(1), several(5);
  FrameRetimer one(alone), other(several);
  for (const double seconds : {0.02, -0.1, 0.05}) {
    const FramePtr first = one.retime(frame, seconds);
    for (int again = 0; again < 3; ++again) {
      expectSamePlanes(*first, *other.retime(frame, seconds));
    }
  }
}

TEST(RetimedDepth, isTheSameOnEveryKindOfCpu) {
  WorkerPool workers(2);
  // Wider than the widest vector of bytes, and than what is drawn at a time; then less than one.
  for (const FramePtr& frame :
       {noisyFrame(), movingFrame({waveAt}, 10), movingFrame({waveAt, waveAt}, 10, {}, {150, 20}),
        noisyFrame({150, 20}), noisyFrame({1, 5})}) {
    const FramePtr first = FrameRetimer(workers).retime(frame, kTime_s);
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      SCOPED_TRACE(hwy::TargetName(target));
      hwy::SetSupportedTargetsForTest(target);
      expectSamePlanes(*first, *FrameRetimer(workers).retime(frame, kTime_s));
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

// Motion in the previous frame leaves no trace in the next one.
TEST(RetimedDepth, isThatOfTheFrameAlone) {
  WorkerPool workers(2);
  const auto standsAt = [](uint32_t x, uint32_t y) {
    MovingPx px = waveAt(x, y);
    if (x < 12 || x >= 20 || y < 8 || y >= 14) px.motion_mps = {};
    return px;
  };
  const FramePtr frame = movingFrame({standsAt, waveAt, standsAt}, 0.02);
  const FramePtr wanted = FrameRetimer(workers).retime(frame, kTime_s);
  FrameRetimer used(workers);
  for (const SizePx size_px : {kMovedPx, SizePx{150, 20}}) {
    used.retime(noisyFrame(size_px), -kTime_s);
  }
  expectSamePlanes(*wanted, *used.retime(frame, kTime_s));
}

TEST(RetimedDepth, isTheSameAfterAnotherFrameWasGivenUp) {
  WorkerPool workers(2);
  const FramePtr frame = noisyFrame(), other = movingFrame({waveAt, waveAt}, 10);
  const FramePtr wanted = FrameRetimer(workers).retime(frame, kTime_s);
  struct GivenUp {};
  int step_count = 0;
  for (bool is_given_up = true; is_given_up; ++step_count) {
    FrameRetimer used(workers);
    used.retime(frame, -kTime_s);
    int left = step_count;
    try {
      used.retime(other, kTime_s, Guesses::kStand, [&left] {
        if (left-- == 0) throw GivenUp();
      });
      is_given_up = false;
    } catch (const GivenUp&) {
    }
    expectSamePlanes(*wanted, *used.retime(frame, kTime_s));
  }
  EXPECT_GT(step_count, 6) << "a large frame is given up soon";
}

}  // namespace
}  // namespace viewloom::test::retimed_depth_test
