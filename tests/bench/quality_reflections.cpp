// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_reflections.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "frame/cube_map.h"
#include "gpu/world_views.h"
#include "scoring/image_score.h"
#include "support/srgb_transfer.h"
#include "support/truth/mirror_scenes.h"
#include "support/truth/mirrored.h"
#include "support/truth/picture_frame.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr SizePx kSource_px{640, 480};
constexpr SizePx kView_px{400, 300};  // as fine as the source
constexpr double kFocal_px = 480;
constexpr uint32_t kLayers = 2;
constexpr uint32_t kEnvironment_rgb = 0x808080;

constexpr uint32_t kCubeSide_px = 512;  // of a face
const Pose kCube{.position_m = {0, 0.1, -0.3}, .orientation = {1, 0, 0, 0}};

struct NamedView {
  const char* name;
  glm::dvec3 eye_m;
  glm::dvec3 turn_rad;
};

constexpr NamedView kViews[] = {{"of the source", {0, 0, 0}, {0, 0, 0}},
                                {"beside it", {0.15, 0.08, 0}, {0, 0.03, 0}}};

Camera cameraOf(const NamedView& view, SizePx size_px) {
  return {.pose = {.position_m = view.eye_m, .orientation = glm::dquat(view.turn_rad)},
          .intrinsics = {glm::dvec2(kFocal_px), {0.5 * size_px.width, 0.5 * size_px.height}}};
}

// What a frame is made of: pictures from these places; the last six may be those of a cube map.
struct Stand {
  const char* name;
  std::vector<truth::SourceCamera> cameras;
  bool has_cube = false;
};

struct MirrorScene {
  const char* name;
  truth::Scene scene;
  uint32_t bounce_count;
  uint32_t sample_count;  // of the truth, where surfaces are rough
  std::vector<Stand> stands;
};

std::vector<truth::SourceCamera> withCube(std::vector<truth::SourceCamera> cameras) {
  for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
    cameras.push_back({cubeFaceCamera(kCube, face, kCubeSide_px), {kCubeSide_px, kCubeSide_px}});
  }
  return cameras;
}

FramePtr frameOf(const truth::Instant& instant, const Stand& stand) {
  std::vector<truth::Picture> pictures;
  for (const auto& [camera, size_px] : stand.cameras) {
    pictures.push_back(truth::takePicture(
        instant, camera,
        {.size_px = size_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}));
  }
  if (!stand.has_cube) return truth::frameOf(pictures, kLayers);
  const auto first_face = pictures.end() - kCubeFaceCount;
  const FramePtr cube = truth::cubeFrameOf({first_face, pictures.end()}, kCube, kLayers);
  if (first_face == pictures.begin()) return cube;
  auto both = std::make_shared<Frame>(*truth::frameOf({pictures.begin(), first_face}, kLayers));
  both->format.sources.push_back(cube->format.sources.front());
  both->sources.push_back(cube->sources.front());
  return both;
}

// Which source holds what the px of mirrors mirror.
struct HeldBy {
  std::vector<uint8_t> first;  // truth::mirroredKnownFrom
  std::vector<uint8_t> any;

  bool isMirror(size_t px) const { return first[px] != truth::kNoMirror; }
  bool isKnown(size_t px) const { return first[px] < kLayers; }
  bool isElsewhere(size_t px) const { return !isKnown(px) && any[px] < kLayers; }
};

HeldBy heldBy(const truth::Instant& instant, const Stand& stand, const Camera& view) {
  std::vector<truth::SourceCamera> cameras = stand.cameras;
  // Of a cube map, the face that looks at what views look at is the first.
  if (stand.has_cube && cameras.size() == kCubeFaceCount) {
    std::swap(cameras.front(), cameras[kCubeFrontFace]);
  }
  return {truth::mirroredKnownFrom(instant, {cameras.front()}, view, kView_px),
          truth::mirroredKnownFrom(instant, cameras, view, kView_px)};
}

double linearOf(uint32_t code) {
  return linearFrom((code & 0xff) / 255.0);
}

truth::MirrorOptions truthOptions(const MirrorScene& scene) {
  return {.bounce_count = scene.bounce_count,
          .sample_count = scene.sample_count,
          .environment = glm::vec3(float(linearOf(kEnvironment_rgb)))};
}

class Psnr {
 public:
  void add(const float* got, const glm::vec3& truth) {
    for (int c = 0; c < 3; ++c) {
      const double clipped = std::min(double{truth[c]}, 1.0);
      const double difference = double{got[c]} - srgbFrom(clipped);
      sum_ += difference * difference;
    }
    count_ += 3;
  }
  double db() const { return -10 * std::log10(sum_ / double(count_)); }

 private:
  double sum_ = 0;
  size_t count_ = 0;
};

MirrorPsnr score(const RenderedAtlas& atlas, const std::vector<glm::vec3>& truth,
                 const HeldBy& held) {
  const TileOrigin origin = atlas.layout->tileOrigin(0);
  Psnr of_known, of_elsewhere, of_unknown, of_all;
  for (size_t i = 0; i < truth.size(); ++i) {
    if (!held.isMirror(i)) continue;
    const size_t x_px = origin.x_px + i % kView_px.width;
    const size_t y_px = origin.y_px + i / kView_px.width;
    const float* const got = &atlas.linear[4 * (y_px * atlas.layout->size_px.width + x_px)];
    of_all.add(got, truth[i]);
    Psnr& own = held.isKnown(i) ? of_known : held.isElsewhere(i) ? of_elsewhere : of_unknown;
    own.add(got, truth[i]);
  }
  return {of_known.db(), of_elsewhere.db(), of_unknown.db(), of_all.db()};
}

ReflectionScore sharesOf(const HeldBy& held) {
  size_t mirrors = 0, known = 0, elsewhere = 0;
  for (size_t i = 0; i < held.first.size(); ++i) {
    mirrors += held.isMirror(i);
    known += held.isMirror(i) && held.isKnown(i);
    elsewhere += held.isMirror(i) && held.isElsewhere(i);
  }
  ReflectionScore score;
  score.known_share = double(known) / double(mirrors);
  score.elsewhere_share = double(elsewhere) / double(mirrors);
  return score;
}

void addScores(const Device& device, const MirrorScene& mirrors,
               std::vector<ReflectionScore>& scores) {
  const truth::Instant instant(mirrors.scene, 0);
  const ReflectionSpec effect{.bounce_count = mirrors.bounce_count,
                              .environment_rgb = kEnvironment_rgb};
  const Stand one{"one", {{cameraOf(kViews[0], kSource_px), kSource_px}}};
  const FramePtr first = frameOf(instant, one);
  std::vector<FramePtr> frames;
  for (const Stand& stand : mirrors.stands) frames.push_back(frameOf(instant, stand));
  for (const NamedView& view : kViews) {
    const Camera camera = cameraOf(view, kView_px);
    const auto truth = truth::takeMirrored(instant, camera, kView_px, truthOptions(mirrors));
    const auto render = [&](const Frame& frame, const std::optional<ReflectionSpec>& reflection) {
      return renderInWorld(device, frame, {camera}, kView_px, 1, reflection);
    };
    const RenderedAtlas alone = render(*first, effect);
    for (size_t i = 0; i < frames.size(); ++i) {
      const HeldBy held = heldBy(instant, mirrors.stands[i], camera);
      const RenderedAtlas got = render(*frames[i], effect);
      ReflectionScore of_stand = sharesOf(held);
      of_stand.scene = mirrors.name;
      of_stand.sources = mirrors.stands[i].name;
      of_stand.view = view.name;
      of_stand.without = score(render(*frames[i], std::nullopt), truth, held);
      of_stand.alone = score(alone, truth, held);
      of_stand.got = score(got, truth, held);
      of_stand.counts = got.reflections;
      scores.push_back(of_stand);
    }
  }
}

// What others stand in beside the first: what it cannot see, as it lies behind it, or is hidden.
std::vector<MirrorScene> mirrorScenes() {
  const truth::SourceCamera own{cameraOf(kViews[0], kSource_px), kSource_px};
  const auto beside = [&](const glm::dvec3& eye_m, const glm::dvec3& turn_rad) {
    const NamedView other{"", eye_m, turn_rad};
    return std::vector<truth::SourceCamera>{own, {cameraOf(other, kSource_px), kSource_px}};
  };
  const Stand one{"one", {own}};
  const Stand looks_back{"two", beside({0, 0.1, -1.9}, {0, std::numbers::pi, 0})};
  const Stand looks_up{"two", beside({-0.2, -0.6, -0.8}, {0.35, 0, 0})};
  const Stand has_cube{"one, a cube map", withCube({own}), true};
  const Stand is_cube{"a cube map", withCube({}), true};
  return {{"mirror floor", truth::mirrorFloor(0), 1, 1, {one, looks_up}},
          {"mirror sphere", truth::mirrorSphere(), 1, 1, {one, looks_back, has_cube, is_cube}},
          {"facing mirrors", truth::facingMirrors(), 4, 1, {one, has_cube}},
          {"rough floor", truth::mirrorFloor(0.4), 1, 128, {one, looks_up}}};
}

}  // namespace

std::vector<ReflectionScore> reflectionScores(const Device& device) {
  std::vector<ReflectionScore> scores;
  for (const MirrorScene& scene : mirrorScenes()) addScores(device, scene, scores);
  return scores;
}

Json qualityOfReflections(const Device& device) {
  Json json = Json::array();
  for (const ReflectionScore& score : reflectionScores(device)) {
    const auto shareOf = [&](uint64_t count) {
      return double(count) / double(score.counts.rayCount());
    };
    json.push_back({{"scene", score.scene},
                    {"sources", score.sources},
                    {"view", score.view},
                    {"known_share", score.known_share},
                    {"elsewhere_share", score.elsewhere_share},
                    {"without_known_db", score.without.known_db},
                    {"without_all_db", score.without.all_db},
                    {"alone_known_db", score.alone.known_db},
                    {"alone_elsewhere_db", score.alone.elsewhere_db},
                    {"alone_all_db", score.alone.all_db},
                    {"known_db", score.got.known_db},
                    {"elsewhere_db", score.got.elsewhere_db},
                    {"unknown_db", score.got.unknown_db},
                    {"all_db", score.got.all_db},
                    {"hit", shareOf(score.counts.hit)},
                    {"assumed", shareOf(score.counts.assumed)},
                    {"back", shareOf(score.counts.back)},
                    {"cube", shareOf(score.counts.cube)},
                    {"environment", shareOf(score.counts.environment)},
                    {"bent", shareOf(score.counts.bent)}});
  }
  return json;
}

}  // namespace viewloom::bench
