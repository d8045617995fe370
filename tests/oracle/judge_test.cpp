// SPDX-License-Identifier: Apache-2.0
#include "oracle/judge.h"

#include <gtest/gtest.h>

#include <functional>

#include "oracle/analytic_scenes.h"

namespace viewloom::oracle::judge_test {
namespace {

constexpr double kTolerance_px = 0.25;

TestedAnswer testedFrom(const OracleAnswer& answer) {
  if (answer.hits.empty()) return {.ray_class = answer.ray_class};
  const OracleHit& hit = answer.hits.front();
  return {answer.ray_class, hit.facet.layer, hit.x_px, hit.y_px, hit.inv_z};
}

Scene layeredScene() {
  return stepScene({0, 0, 1.0}, {1.0 / 4096, 0, 0.25}, 32, true, 64, 16);
}

OutputView besideView(const Scene& scene, double x_m) {
  OutputView view = ownView(scene);
  view.position_m.x = x_m;
  return view;
}

using Distort = std::function<TestedAnswer(const OracleSource&, const ViewRay&)>;

// Judges every pixel of a view; `distort` makes the tested answer from the oracle's.
Verdict judgeView(const Scene& scene, const OutputView& view, const Distort& distort) {
  const OracleSource source(scene.planes, scene.pinhole, scene.kappa);
  Judge judge(source, toleranceOf(source, kTolerance_px));
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      const ViewRay ray = rayOf(view, column + 0.5, row + 0.5);
      judge.consider(ray, distort(source, ray), "pixel");
    }
  }
  return judge.verdict();
}

Verdict judgeBesideView(const Distort& distort) {
  const Scene scene = layeredScene();
  return judgeView(scene, besideView(scene, -0.1), distort);
}

TestedAnswer unchanged(const OracleSource& source, const ViewRay& ray) {
  return testedFrom(traceOracle(source, ray.ray));
}

Distort movedBy_px(double x_px) {
  return [x_px](const OracleSource& source, const ViewRay& ray) {
    return testedFrom(traceOracle(source, ray.movedBy(x_px, 0)));
  };
}

TEST(Judge, acceptsTheOracleItself) {
  const Verdict verdict = judgeBesideView(unchanged);
  EXPECT_EQ(verdict.exact, verdict.rays);
}

TEST(Judge, acceptsAPictureMovedWithinTheTolerance) {
  const Verdict verdict = judgeBesideView(movedBy_px(0.8 * kTolerance_px));
  EXPECT_EQ(verdict.differing, 0u) << verdict.summary();
  EXPECT_LT(verdict.excusedShare(), 0.05) << verdict.summary();
}

TEST(Judge, rejectsAPictureMovedByTwiceTheTolerance) {
  const Verdict verdict = judgeBesideView(movedBy_px(2 * kTolerance_px));
  EXPECT_GT(verdict.differing, verdict.rays / 2) << verdict.summary();
}

// A ray that enters just behind a near surface and hits a far one that is linked to it, as a tracer
// answers whose far surface is off by `off`, 1/m. All rays to its right hit the near one.
Verdict judgeBesideANearSurface(double off) {
  Scene scene = stepScene({0, 0, 2.0}, {0, 0, 2.0}, 0, true, 64, 4);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 64; ++column) {
      scene.planes.at(1, column, row) = column < 6 ? 0.8f : 0.3f;
    }
  }
  scene.kappa = {0.6f, 0};
  const OracleSource source(scene.planes, scene.pinhole, scene.kappa);
  const double eye_x_m = -0.5, parallax_px = scene.pinhole.focal_px.x * eye_x_m;
  const double start_inv_z = 0.798, x_px = -parallax_px * start_inv_z;
  const double inv_z = 0.3 + off;
  Judge judge(source, toleranceOf(source, kTolerance_px));
  judge.consider(rayOf(besideView(scene, eye_x_m), x_px, 2.5),
                 {RayClass::kHitAssumed, 1, x_px + parallax_px * inv_z, 2.5, inv_z}, "ray");
  return judge.verdict();
}

TEST(Judge, acceptsASurfaceWithinTheToleranceWhereAllRaysBesideHitElsewhere) {
  const double tolerance = kTolerance_px / 40;  // 1/m: the parallax is 40 px m
  EXPECT_EQ(judgeBesideANearSurface(0).exact, 1u);
  EXPECT_EQ(judgeBesideANearSurface(-0.2 * tolerance).within, 1u);
  EXPECT_EQ(judgeBesideANearSurface(-2 * tolerance).differing, 1u);
}

// A wide block on a floor, all of it linked: a ray that hits the block, and a tracer that lets it
// through to the floor beyond.
TEST(Judge, rejectsAHitOnTheSameSurfaceBehindWhatTheRayHits) {
  Scene scene = planeScene({0, 0, 0.3}, 64, 4);
  for (int row = 0; row < 4; ++row) {
    for (int column = 20; column < 31; ++column) scene.planes.at(0, column, row) = 0.6f;
  }
  scene.kappa = {0.6f, 0};
  const OracleSource source(scene.planes, scene.pinhole, scene.kappa);
  const double parallax_px = 40, eye_x_m = -parallax_px / scene.pinhole.focal_px.x;
  const double x_px = 25 + parallax_px * 0.6;
  const ViewRay ray = rayOf(besideView(scene, eye_x_m), x_px, 2.5);
  Judge judge(source, toleranceOf(source, kTolerance_px));
  judge.consider(ray, {RayClass::kHit, 0, 25, 2.5, 0.6f}, "block");
  EXPECT_EQ(judge.verdict().exact, 1u) << judge.verdict().summary();
  judge.consider(ray, {RayClass::kHit, 0, x_px - parallax_px * 0.3f, 2.5, 0.3f}, "floor");
  EXPECT_EQ(judge.verdict().differing, 1u) << judge.verdict().summary();
}

TEST(Judge, rejectsAForgottenLayer) {
  Scene scene = layeredScene();
  scene.planes.inv_z.resize(scene.planes.inv_z.size() / 2);
  scene.planes.layer_count = 1;
  const OracleSource one_layer(scene.planes, scene.pinhole, scene.kappa);
  const Verdict verdict = judgeBesideView(
      [&](const OracleSource&, const ViewRay& ray) { return unchanged(one_layer, ray); });
  EXPECT_GT(verdict.differing, 0u) << verdict.summary();
}

TEST(Judge, rejectsAClassThatNoMovedRayHas) {
  const Verdict verdict = judgeBesideView([](const OracleSource& source, const ViewRay& ray) {
    TestedAnswer tested = unchanged(source, ray);
    if (tested.ray_class == RayClass::kHitAssumed) tested.ray_class = RayClass::kHit;
    return tested;
  });
  EXPECT_GT(verdict.differing, 0u) << verdict.summary();
}

TEST(Judge, toleratesRoundingOnEveryKindOfScene) {
  Random random(3);
  const Distort rounded = [&](const OracleSource& source, const ViewRay& ray) {
    const JudgeTolerance rounding = toleranceOf(source, 0);
    const auto within = [&](double bound) { return random.uniform(-bound, bound); };
    const ProjectedRay exact = projectRay(source.pinhole(), ray.ray);
    const double x_px = within(rounding.source_px), y_px = within(rounding.source_px);
    return testedFrom(traceOracle(source, movedBy(exact, x_px, y_px, within(rounding.inv_z))));
  };
  Verdict sum;
  for (uint64_t seed = 0; seed < 28; ++seed) {
    Scene scene = randomScene(seed);
    scene.planes = canonicalPlanes(scene.planes);
    const OutputView view = randomView(random, int(seed) % kViewKindCount, 12, 12);
    sum.add(judgeView(scene, view, rounded));
  }
  EXPECT_EQ(sum.differing, 0u) << sum.summary();
}

}  // namespace
}  // namespace viewloom::oracle::judge_test
