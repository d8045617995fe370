// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle_trace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oracle/analytic_scenes.h"
#include "oracle/brute_force.h"
#include "oracle/view_generator.h"

namespace viewloom::oracle::oracle_trace_test {
namespace {

// Double precision over at most a few hundred px and 1/m.
constexpr double kPosition_px = 1e-7;

OracleSource sourceOf(const Scene& scene) {
  return OracleSource(canonicalPlanes(scene.planes), scene.pinhole, scene.kappa);
}

constexpr ImagePlane kSlanted{3.0 / 4096, -2.0 / 4096, 0.5};
constexpr ImagePlane kNear{0, 0, 1.0};
constexpr ImagePlane kFar{1.0 / 4096, 0, 0.25};

TEST(OracleTrace, meetsASlantedPlaneWhereGeometrySays) {
  const Scene scene = planeScene(kSlanted, 64, 48);
  const OracleSource source = sourceOf(scene);
  Random random(1);
  int met_count = 0;
  for (int count = 0; count < 4000; ++count) {
    const OutputView view = randomView(random, count % kViewKindCount, 16, 16);
    const Ray ray = rayOf(view, random.uniform(0, 16), random.uniform(0, 16)).ray;
    const OracleAnswer answer = traceOracle(source, ray);
    if (answer.hits.empty()) continue;
    const auto point_m = meet(kSlanted, scene.pinhole, ray);
    ASSERT_TRUE(point_m);
    const glm::dvec3 image = imageOf(scene.pinhole, *point_m);
    EXPECT_NEAR(answer.hits[0].x_px, image.x, kPosition_px) << view.name;
    EXPECT_NEAR(answer.hits[0].y_px, image.y, kPosition_px) << view.name;
    EXPECT_NEAR(answer.hits[0].inv_z, image.z, kPosition_px) << view.name;
    ++met_count;
  }
  EXPECT_GT(met_count, 1000);
}

// Looking from `eye_x_m` to the right of the camera at its image position x, on the middle row.
Ray lateralRay(const Scene& scene, double eye_x_m, double x_px) {
  OutputView view = ownView(scene);
  view.position_m.x = eye_x_m;
  return rayOf(view, x_px, 0.5 * scene.planes.height).ray;
}

// The point at depth 1 m of an image position on the middle row.
glm::dvec3 onRow(const Scene& scene, double x_px) {
  return {(x_px - scene.pinhole.principal_px.x) / scene.pinhole.focal_px.x, 0, -1};
}

TEST(OracleTrace, followsTheEpipolarLineOverAStep) {
  const Scene scene = stepScene(kNear, {0, 0, 0.25}, 32, false, 64, 4);
  const OracleSource source = sourceOf(scene);
  const double parallax_px = scene.pinhole.focal_px.x * 0.1;  // per 1/m
  for (double x_px = 0.25; x_px < 64; x_px += 0.5) {
    const OracleAnswer right = traceOracle(source, lateralRay(scene, 0.1, x_px));
    const double x_near = x_px + parallax_px * 1.0, x_far = x_px + parallax_px * 0.25;
    if (x_near >= 64) {
      // It enters from the side below the near plane.
      EXPECT_EQ(right.ray_class, RayClass::kHidden) << x_px;
    } else if (x_near >= 32) {
      ASSERT_EQ(right.ray_class, RayClass::kHit) << x_px;
      EXPECT_NEAR(right.hits[0].x_px, x_near, kPosition_px);
    } else if (x_far < 32) {
      // It came down to the far plane beside the near one, without ever being behind that.
      ASSERT_EQ(right.ray_class, RayClass::kHit) << x_px;
      EXPECT_NEAR(right.hits[0].x_px, x_far, kPosition_px);
    }
  }
}

TEST(OracleTrace, whatASilhouetteHidesIsHiddenUnlessALayerShowsIt) {
  const Scene open = stepScene(kNear, {0, 0, 0.25}, 32, false, 64, 4);
  const Scene layered = stepScene(kNear, {0, 0, 0.25}, 32, true, 64, 4);
  // From the left, falling 1/Z carries the ray to the right, below the near plane's border.
  const double eye_x_m = -0.1, parallax_px = open.pinhole.focal_px.x * eye_x_m;
  const double x_px = 32 - 0.5 * parallax_px;  // passes x = 32 at 1/Z = 0.5, behind the near plane
  const OracleAnswer hidden = traceOracle(sourceOf(open), lateralRay(open, eye_x_m, x_px));
  EXPECT_EQ(hidden.ray_class, RayClass::kHidden);
  const OracleAnswer shown = traceOracle(sourceOf(layered), lateralRay(layered, eye_x_m, x_px));
  ASSERT_EQ(shown.ray_class, RayClass::kHitAssumed);
  EXPECT_EQ(shown.hits[0].facet.layer, 1);
  EXPECT_NEAR(shown.hits[0].x_px, x_px + 0.25 * parallax_px, kPosition_px);
}

TEST(OracleTrace, comesOutFromBehindAPole) {
  Scene scene = planeScene({0, 0, 0.25}, 64, 1);
  scene.planes.at(0, 40, 0) = 1.0f;
  const double eye_x_m = -0.1, parallax_px = scene.pinhole.focal_px.x * eye_x_m;
  const double x_px = 40 - 0.5 * parallax_px;
  const OracleAnswer answer = traceOracle(sourceOf(scene), lateralRay(scene, eye_x_m, x_px));
  ASSERT_EQ(answer.ray_class, RayClass::kHitAssumed);
  EXPECT_NEAR(answer.hits[0].x_px, x_px + 0.25 * parallax_px, kPosition_px);
}

// A board before a wall on the left, behind which the wall ends: far hills on the right.
Scene boardBeforeAWall(int board_px) {
  Scene scene = planeScene({0, 0, 0.25}, 64, 1);
  for (int column = 32; column < 64; ++column) {
    scene.planes.at(0, column, 0) = column < 32 + board_px ? 1.0f : 0.05f;
  }
  return scene;
}

TEST(OracleTrace, theFarSideOfASilhouetteGoesOnBehindIt) {
  const double eye_x_m = -0.1;
  const Scene scene = boardBeforeAWall(8);
  const double parallax_px = scene.pinhole.focal_px.x * eye_x_m;
  ASSERT_LT(-parallax_px * 0.25,
            8);  // who passes at the wall's own depth meets it behind the board
  // From just behind the board's edge to just in front of where the wall is met at its other end.
  const double x_px = 32 - 0.5 * parallax_px;
  const Ray ray = lateralRay(scene, eye_x_m, x_px);
  EXPECT_EQ(traceOracle(sourceOf(scene), ray).ray_class, RayClass::kHidden);
  // Out again before that: what is seen beyond is assumed.
  const Scene pole = boardBeforeAWall(1);
  const OracleAnswer beyond = traceOracle(sourceOf(pole), lateralRay(pole, eye_x_m, x_px));
  ASSERT_EQ(beyond.ray_class, RayClass::kHitAssumed);
  EXPECT_NEAR(beyond.hits[0].inv_z, 0.05, kPosition_px);
}

TEST(OracleTrace, aFarSideGoesOnNoFurtherThanItReachesOnItsOwnSide) {
  const double eye_x_m = -0.2;
  const Scene wall = boardBeforeAWall(12);
  const double parallax_px = wall.pinhole.focal_px.x * eye_x_m;
  // Passes the board's edge just behind it, and is as far back as the wall 10 px further on.
  const double x_px = 32 - 0.9 * parallax_px;
  EXPECT_EQ(traceOracle(sourceOf(wall), lateralRay(wall, eye_x_m, x_px)).ray_class,
            RayClass::kHidden);
  Scene pillar = wall;
  for (int column = 0; column < 28; ++column) pillar.planes.at(0, column, 0) = 0.05f;
  const Ray ray = lateralRay(pillar, eye_x_m, x_px);
  const OracleAnswer beyond = traceOracle(sourceOf(pillar), ray);
  ASSERT_EQ(beyond.ray_class, RayClass::kHitAssumed);
  EXPECT_NEAR(beyond.hits[0].inv_z, 0.05, kPosition_px);
  EXPECT_EQ(traceAllFacets(sourceOf(pillar), ray).ray_class, RayClass::kHitAssumed);
}

TEST(OracleTrace, whatIsKnownBehindASilhouetteIsNotTakenToGoOn) {
  const double eye_x_m = -0.1;
  Scene scene = boardBeforeAWall(8);
  InvZPlanes planes = makePlanes(64, 1, 2);
  for (int column = 0; column < 64; ++column) {
    planes.at(0, column, 0) = scene.planes.at(0, column, 0);
    if (column >= 32 && column < 40) planes.at(1, column, 0) = 0.05f;
  }
  scene.planes = planes;
  const double parallax_px = scene.pinhole.focal_px.x * eye_x_m;
  const Ray ray = lateralRay(scene, eye_x_m, 32 - 0.5 * parallax_px);
  const OracleAnswer hills = traceOracle(sourceOf(scene), ray);
  ASSERT_EQ(hills.ray_class, RayClass::kHitAssumed);
  EXPECT_NEAR(hills.hits[0].inv_z, 0.05, kPosition_px);
}

TEST(OracleTrace, endsAtTheSkyOrInNothing) {
  Scene scene = planeScene({0, 0, 0}, 8, 8);
  for (int row = 0; row < 8; ++row) {
    for (int column = 4; column < 8; ++column) scene.planes.at(0, column, row) = kNoSurface;
  }
  const OracleSource source = sourceOf(scene);
  const OracleAnswer sky = traceOracle(source, lateralRay(scene, 0.3, 2.25));
  ASSERT_EQ(sky.ray_class, RayClass::kHit);
  EXPECT_EQ(sky.hits[0].inv_z, 0);
  EXPECT_NEAR(sky.hits[0].x_px, 2.25, kPosition_px);
  EXPECT_EQ(traceOracle(source, lateralRay(scene, 0.3, 6.25)).ray_class, RayClass::kEmpty);
  EXPECT_EQ(traceOracle(source, lateralRay(scene, 0.3, 9)).ray_class, RayClass::kOutside);
}

TEST(OracleTrace, comesOutOfAFacetThatFallsBelowTheSkyAndHitsItThere) {
  // One column behind whose facet the ray starts; at its right end the facet's plane is below 0.
  Scene scene = planeScene({0, 0, 0}, 3, 1);
  const float inv_z[] = {0.9f, 0.5f, 0.1f};
  for (int column = 0; column < 3; ++column) scene.planes.at(0, column, 0) = inv_z[column];
  const OracleSource source = sourceOf(scene);
  // From x = 2 at 1/Z = 0.2, 0.1 behind the facet, to x = 2.875 at the sky: its plane is at -0.05.
  const Ray ray{onRow(scene, 2.0) / 0.2, onRow(scene, 2.875)};
  for (const OracleAnswer& answer : {traceOracle(source, ray), traceAllFacets(source, ray)}) {
    ASSERT_EQ(answer.ray_class, RayClass::kHitAssumed);
    EXPECT_EQ(answer.hits[0].inv_z, 0);
    EXPECT_NEAR(answer.hits[0].x_px, 2.875, kPosition_px);
  }
}

TEST(OracleTrace, hitsNoLayerBeforeTheOneInFrontOfIt) {
  // The slope of layer 1 carries its middle facet from 0.48 to 0.57, before layer 0 at 0.5.
  Scene scene = stepScene({0, 0, 0.5}, {0, 0, 0.48}, 0, true, 3, 1);
  const float inv_z[2][3] = {{0.69f, 0.5f, 0.7f}, {0.3f, 0.48f, 0.66f}};
  for (int column = 0; column < 3; ++column) {
    for (int layer : {0, 1}) scene.planes.at(layer, column, 0) = inv_z[layer][column];
  }
  const OracleSource source = sourceOf(scene);
  ASSERT_GT(source.planeInvZ({1, 1, 0}, 1.9, 0.5), source.planeInvZ({0, 1, 0}, 1.9, 0.5));
  // From x = 1.88 at 1/Z = 0.7 to x = 1.92 at the sky.
  const Ray ray{onRow(scene, 1.88) / 0.7, onRow(scene, 1.92)};
  for (const OracleAnswer& answer : {traceOracle(source, ray), traceAllFacets(source, ray)}) {
    ASSERT_EQ(answer.ray_class, RayClass::kHit);
    EXPECT_EQ(answer.hits[0].facet.layer, 0);
    EXPECT_NEAR(answer.hits[0].inv_z, 0.5, kPosition_px);
  }
}

TEST(OracleTrace, startsInTheStateOfItsEntryColumn) {
  const Scene scene = planeScene({0, 0, 0.5}, 8, 8);
  const OracleSource source = sourceOf(scene);
  // Behind the plane, along the image plane.
  const Ray behind{{-10, 0, -4}, {1, 0, 0}};
  EXPECT_EQ(traceOracle(source, behind).ray_class, RayClass::kHidden);
  // Before the plane.
  const Ray before{{-10, 0, -1}, {1, 0, 0}};
  EXPECT_EQ(traceOracle(source, before).ray_class, RayClass::kOutside);
  // From behind towards the camera: a back crossing is no event.
  const Ray towards{{0.01, 0.01, -4}, {0, 0, 1}};
  EXPECT_EQ(traceOracle(source, towards).ray_class, RayClass::kOutside);
}

TEST(OracleTrace, connectedSurfacesHaveNoCracks) {
  // A staircase whose steps are within kappa: every ray of a view from the side must hit.
  Scene scene = planeScene({0, 0, 0.5}, 64, 1);
  for (int column = 0; column < 64; ++column) {
    scene.planes.at(0, column, 0) = 0.5f + (column % 2 == 0 ? 0.0f : 0.004f);
  }
  scene.kappa = {0.005f, 0};
  const OracleSource source = sourceOf(scene);
  int edge_count = 0;
  for (double x_px = 8; x_px < 48; x_px += 0.03) {
    const OracleAnswer answer = traceOracle(source, lateralRay(scene, -2, x_px + 80));
    ASSERT_EQ(answer.ray_class, RayClass::kHit) << x_px;
    edge_count += answer.hits[0].linked_facet.layer >= 0;
  }
  EXPECT_GT(edge_count, 0);
}

TEST(OracleTrace, collectsSurfacesFrontToBack) {
  const Scene scene = stepScene(kNear, kFar, 0, true, 64, 4);
  const OracleAnswer answer = traceOracle(sourceOf(scene), lateralRay(scene, 0.05, 20), 4);
  ASSERT_EQ(answer.hits.size(), 2u);
  EXPECT_EQ(answer.hits[0].facet.layer, 0);
  EXPECT_EQ(answer.hits[1].facet.layer, 1);
  EXPECT_FALSE(answer.hits[1].assumed);  // it passed through the first, not behind it
  EXPECT_GT(answer.hits[0].inv_z, answer.hits[1].inv_z);
}

TEST(OracleTrace, fromItsOwnPoseASourceSeesItself) {
  for (uint64_t seed = 0; seed < 56; ++seed) {
    const Scene scene = randomScene(seed);
    const OracleSource source = sourceOf(scene);
    const OutputView view = ownView(scene);
    for (int row = 0; row < source.height(); ++row) {
      for (int column = 0; column < source.width(); ++column) {
        const OracleAnswer answer = traceOracle(source, rayOf(view, column + 0.5, row + 0.5).ray);
        const float inv_z = source.planes().at(0, column, row);
        if (inv_z < 0) {
          EXPECT_EQ(answer.ray_class, RayClass::kEmpty);
          continue;
        }
        ASSERT_EQ(answer.ray_class, RayClass::kHit);
        EXPECT_EQ(answer.hits[0].facet, (FacetAt{0, column, row}));
        EXPECT_NEAR(answer.hits[0].inv_z, double(inv_z), kPosition_px);
      }
    }
  }
}

TEST(OracleTrace, itsWalkFindsWhatASearchOfAllFacetsFinds) {
  Random random(7);
  int compared_count = 0;
  for (uint64_t seed = 0; seed < 112; ++seed) {
    const Scene scene = randomScene(seed);
    if (scene.planes.inv_z.size() > 4096) continue;
    const OracleSource source = sourceOf(scene);
    for (int kind = 0; kind < kViewKindCount; ++kind) {
      const OutputView view = randomView(random, kind, 16, 16);
      for (int count = 0; count < 4; ++count) {
        const Ray ray = rayOf(view, random.uniform(0, 16), random.uniform(0, 16)).ray;
        const OracleAnswer walked = traceOracle(source, ray);
        const OracleAnswer searched = traceAllFacets(source, ray);
        ASSERT_EQ(walked.ray_class, searched.ray_class)
            << "seed " << seed << " " << scene.name << view.name;
        ++compared_count;
        if (walked.hits.empty()) continue;
        EXPECT_EQ(walked.hits[0].facet, searched.hits[0].facet);
        EXPECT_NEAR(walked.hits[0].x_px, searched.hits[0].x_px, 1e-5);
        EXPECT_NEAR(walked.hits[0].inv_z, searched.hits[0].inv_z, 1e-5);
      }
    }
  }
  EXPECT_GT(compared_count, 2000);
}

}  // namespace
}  // namespace viewloom::oracle::oracle_trace_test
