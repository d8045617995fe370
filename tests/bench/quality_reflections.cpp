// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_reflections.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

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

struct MirrorScene {
  const char* name;
  truth::Scene scene;
  uint32_t bounce_count;
  uint32_t sample_count;  // of the truth, where surfaces are rough
};

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

MirrorPsnr score(const RenderedAtlas& atlas, uint32_t view, const std::vector<glm::vec3>& truth,
                 const std::vector<uint8_t>& known) {
  const TileOrigin origin = atlas.layout->tileOrigin(view);
  Psnr of_known, of_all;
  for (size_t i = 0; i < known.size(); ++i) {
    if (known[i] == truth::kNoMirror) continue;
    const size_t x_px = origin.x_px + i % kView_px.width;
    const size_t y_px = origin.y_px + i / kView_px.width;
    const float* const got = &atlas.linear[4 * (y_px * atlas.layout->size_px.width + x_px)];
    of_all.add(got, truth[i]);
    if (known[i] < kLayers) of_known.add(got, truth[i]);
  }
  return {of_known.db(), of_all.db()};
}

double knownShare(const std::vector<uint8_t>& known) {
  size_t mirrors = 0, held = 0;
  for (const uint8_t value : known) {
    mirrors += value != truth::kNoMirror;
    held += value < kLayers;
  }
  return double(held) / double(mirrors);
}

void addScores(const Device& device, const MirrorScene& mirrors,
               std::vector<ReflectionScore>& scores) {
  const truth::Instant instant(mirrors.scene, 0);
  const Camera source = cameraOf(kViews[0], kSource_px);
  const FramePtr frame = truth::frameOf(
      truth::takePicture(
          instant, source,
          {.size_px = kSource_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}),
      kLayers);
  for (const NamedView& view : kViews) {
    const Camera camera = cameraOf(view, kView_px);
    const auto truth = truth::takeMirrored(instant, camera, kView_px, truthOptions(mirrors));
    const auto known = truth::mirroredKnownFrom(instant, source, kSource_px, camera, kView_px);
    const RenderedAtlas plain = renderInWorld(device, *frame, {camera}, kView_px, 1);
    const RenderedAtlas mirrored = renderInWorld(
        device, *frame, {camera}, kView_px, 1,
        ReflectionSpec{.bounce_count = mirrors.bounce_count, .environment_rgb = kEnvironment_rgb});
    scores.push_back({.scene = mirrors.name,
                      .view = view.name,
                      .known_share = knownShare(known),
                      .without = score(plain, 0, truth, known),
                      .got = score(mirrored, 0, truth, known),
                      .counts = mirrored.reflections});
  }
}

}  // namespace

std::vector<ReflectionScore> reflectionScores(const Device& device) {
  const MirrorScene scenes[] = {{"mirror floor", truth::mirrorFloor(0), 1, 1},
                                {"mirror sphere", truth::mirrorSphere(), 1, 1},
                                {"facing mirrors", truth::facingMirrors(), 4, 1},
                                {"rough floor", truth::mirrorFloor(0.4), 1, 128}};
  std::vector<ReflectionScore> scores;
  for (const MirrorScene& scene : scenes) addScores(device, scene, scores);
  return scores;
}

Json qualityOfReflections(const Device& device) {
  Json json = Json::array();
  for (const ReflectionScore& score : reflectionScores(device)) {
    const auto shareOf = [&](uint64_t count) {
      return double(count) / double(score.counts.rayCount());
    };
    json.push_back({{"scene", score.scene},
                    {"view", score.view},
                    {"known_share", score.known_share},
                    {"without_known_db", score.without.known_db},
                    {"without_all_db", score.without.all_db},
                    {"known_db", score.got.known_db},
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
