// SPDX-License-Identifier: Apache-2.0
// Views of a closed room from around a cube map in it, beside the true pictures; across edges and
// corners of its faces, which must not show.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>

#include "frame/cube_map.h"
#include "gpu/true_view.h"
#include "gpu/world_views.h"
#include "shared/fault.h"
#include "support/test_device.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"

namespace viewloom::cube_views_test {
namespace {

constexpr uint32_t kSide_px = 512;
constexpr SizePx kFace_px{kSide_px, kSide_px};
constexpr SizePx kView_px{320, 240};
constexpr double kFocal_px = 256;  // as fine as the middle of a face
constexpr size_t kFine = 3;        // views are traced so many times finer, and averaged
constexpr uint32_t kLayers = 2;
// How far a px may see from a seam to count as beside it, px of a face: as far as an apron is read.
constexpr double kBesideSeam_px = 2;
constexpr double kAroundSeam_px = 20;
// Edges of bodies decide: they are not blended between px. Seen: 43.3 dB, and gaps up to 1.5 dB.
constexpr double kCoveredMin_db = 43;
constexpr double kGapMax_db = 2;
// Px beside seams below those around: a bit more than chance leaves between bands, 0.5 dB.
constexpr double kSeamStepMax_db = 1;
const Pose kCube{.position_m = {0.1, 0.05, -0.1}, .orientation = {1, 0, 0, 0}};

struct NamedView {
  std::string name;
  Camera camera;
};

Camera cameraAt(const glm::dvec3& eye_m, const glm::dvec3& turn_rad) {
  return {.pose = {.position_m = eye_m, .orientation = glm::dquat(turn_rad)},
          .intrinsics = {glm::dvec2(kFocal_px), {160, 120}}};
}

// From the cube's own place, which sees nothing that it lacks, and from around it.
std::vector<NamedView> viewsOf(const glm::dvec3& cube_m) {
  const double quarter = std::numbers::pi / 4;
  const double corner = std::atan(std::sqrt(0.5));
  return {
      {"own place, an edge upright", cameraAt(cube_m, {0, quarter, 0})},
      {"own place, a corner above", cameraAt(cube_m, {corner, -quarter, 0.2})},
      {"beside, an edge upright",
       cameraAt(cube_m + glm::dvec3(0.06, 0.02, 0.03), {0, -quarter, 0})},
      {"beside, an edge above", cameraAt(cube_m + glm::dvec3(-0.05, 0.05, -0.04), {quarter, 0, 0})},
      {"beside, an edge below and behind",
       cameraAt(cube_m + glm::dvec3(0.03, 0.06, 0.05), {-quarter, 4 * quarter, 0.3})},
      {"beside, a corner below",
       cameraAt(cube_m + glm::dvec3(0.05, -0.04, 0.05), {-corner, quarter, 0})},
      {"beside, a corner above and behind",
       cameraAt(cube_m + glm::dvec3(-0.05, 0.06, -0.03), {corner, 3 * quarter, 0})}};
}

// Things across edges and corners of the faces, too.
truth::Scene roomAroundSeams(const glm::dvec3& cube_m) {
  truth::Scene scene = truth::clutteredRoom();
  const auto add = [&](const truth::Shape& shape, const glm::dvec3& from_cube_m,
                       const glm::vec3& light) {
    scene.add({shape, {cube_m + from_cube_m, {1, 0, 0, 0}}, {light, 0.35F * light, 0.08}});
  };
  add(truth::Sphere{0.25}, {1.1, 0, -1.1}, {0.8F, 0.4F, 0.3F});
  add(truth::Sphere{0.2}, {-0.7, 0.7, -0.7}, {0.4F, 0.8F, 0.3F});
  add(truth::Sphere{0.2}, {0.8, -0.8, 0.8}, {0.4F, 0.5F, 0.9F});
  add(truth::Cylinder{0.04, 1}, {-0.9, 0, -0.9}, {0.9F, 0.8F, 0.3F});
  add(truth::Box{{0.25, 0.15, 0.2}}, {0, -0.8, 0.95}, {0.5F, 0.8F, 0.8F});
  add(truth::Box{{0.4, 0.02, 0.1}}, {0.1, 0.8, -0.8}, {0.8F, 0.8F, 0.8F});
  return scene;
}

// How far from a seam a direction from the cube lies, px of the face.
double fromSeam_px(const glm::dvec3& direction) {
  double sizes[] = {std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
  std::sort(std::begin(sizes), std::end(sizes));
  return (1 - sizes[1] / sizes[2]) * 0.5 * kSide_px;
}

// Which px of a view see what lies between two distances from a seam, px of a face.
std::vector<uint8_t> seenFromSeam(const truth::Instant& instant, const Camera& view,
                                  const glm::dvec3& cube_m, double from_px, double to_px) {
  const truth::Picture picture = truth::takePicture(instant, view, {.size_px = kView_px});
  std::vector<uint8_t> selected;
  for (size_t px = 0; px < kView_px.area(); ++px) {
    const double x = double(px % kView_px.width), y = double(px / kView_px.width);
    const truth::Ray ray = truth::rayThrough(view, {x + 0.5, y + 0.5});
    const glm::dvec3 point = ray.origin_m + double{picture.layers[0].depth_m[px]} * ray.direction;
    const double distance_px = fromSeam_px(point - cube_m);
    selected.push_back(distance_px >= from_px && distance_px < to_px);
  }
  return selected;
}

struct SeamScore {
  TrueScore score;
  // PSNR of px away from the edges of bodies.
  double beside_db = 0;
  double around_db = 0;
};

// The room, as a cube map in it shows it.
class CubeViewsTest : public GpuTest {
 protected:
  CubeViewsTest() {
    for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
      cameras_.push_back(cubeFaceCamera(kCube, face, kSide_px));
      faces_.push_back(truth::takePicture(
          instant_, cameras_.back(),
          {.size_px = kFace_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}));
    }
  }

  RenderedAtlas render(OfflineRenderer& renderer, const std::vector<NamedView>& views,
                       double exposure_ev = 0) const {
    std::vector<Camera> eyes;
    for (const NamedView& view : views) eyes.push_back(view.camera);
    Frame frame = *truth::cubeFrameOf(faces_, kCube, kLayers);
    frame.format.exposure_ev = exposure_ev;
    return renderInWorld(renderer, frame, eyes, kView_px, kFine);
  }

  SeamScore scoreOf(const RenderedAtlas& atlas, uint32_t index, const NamedView& view) const {
    const TrueView truth(instant_, {.source = cameras_[0],
                                    .source_px = kFace_px,
                                    .view = view.camera,
                                    .view_px = kView_px,
                                    .more_sources = {cameras_.begin() + 1, cameras_.end()}});
    const ScoredImage mean = meanView(atlas, index, kView_px, kFine);
    const auto scoreFromSeam = [&](double from_px, double to_px) {
      const glm::dvec3& cube_m = kCube.position_m;
      return truth.scoreInside(mean, seenFromSeam(instant_, view.camera, cube_m, from_px, to_px))
          .full_db;
    };
    const SeamScore score{truth.score(mean), scoreFromSeam(0, kBesideSeam_px),
                          scoreFromSeam(kBesideSeam_px, kAroundSeam_px)};
    std::cout << view.name << ", dB covered / full frame / hidden: " << score.score
              << "; away from edges, beside seams " << score.beside_db << ", around them "
              << score.around_db << "\n";
    return score;
  }

  const truth::Instant instant_{roomAroundSeams(kCube.position_m), 0};
  std::vector<Camera> cameras_;
  std::vector<truth::Picture> faces_;
};

TEST_F(CubeViewsTest, aClosedRoomHasNoSeams) {
  const std::vector<NamedView> views = viewsOf(kCube.position_m);
  const RenderedAtlas atlas = render(shared<OfflineRenderer>(), views);
  EXPECT_EQ(atlas.coverage.outside, 0U) << "a cube map sees everything";
  EXPECT_EQ(atlas.coverage.empty, 0U) << "and the room is closed";
  for (uint32_t i = 0; i < views.size(); ++i) {
    const SeamScore seen = scoreOf(atlas, i, views[i]);
    EXPECT_GE(seen.score.covered_db, kCoveredMin_db) << views[i].name;
    EXPECT_LE(seen.score.gapDb(), kGapMax_db) << views[i].name;
    EXPECT_GE(seen.beside_db, seen.around_db - kSeamStepMax_db) << views[i].name;
  }
}

// Colour that is not as it came is held as roots of light, which have other texels.
TEST_F(CubeViewsTest, hasNoSeamsInRootsOfLightEither) {
  constexpr double kAsGoodAsNone_ev = 1e-9;
  const std::vector<NamedView> views = {viewsOf(kCube.position_m).front()};
  const RenderedAtlas atlas = render(shared<OfflineRenderer>(), views, kAsGoodAsNone_ev);
  const SeamScore seen = scoreOf(atlas, 0, views.front());
  EXPECT_GE(seen.beside_db, seen.around_db - kSeamStepMax_db);
}

TEST_F(CubeViewsTest, showsSeamsWithoutAprons) {
  const Device device({.planted_fault = abi::kFaultApronEmpty});
  OfflineRenderer renderer(device);
  const std::vector<NamedView> views = {viewsOf(kCube.position_m).front()};
  const SeamScore seen = scoreOf(render(renderer, views), 0, views.front());
  EXPECT_LT(seen.beside_db, seen.around_db - kSeamStepMax_db);
}

}  // namespace
}  // namespace viewloom::cube_views_test
