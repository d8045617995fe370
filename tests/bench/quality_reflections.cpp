// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_reflections.h"

#include <nlohmann/json.hpp>

#include "gpu/world_views.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

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

void addScores(OfflineRenderer& renderer, const MirrorScene& mirrors,
               std::vector<ReflectionScore>& scores) {
  const truth::Instant instant(mirrors.scene, 0);
  const ReflectionSpec effect = mirrors.effect();
  const FramePtr first = frameOf(instant, mirrors.stands.front());
  std::vector<FramePtr> frames;
  for (const Stand& stand : mirrors.stands) frames.push_back(frameOf(instant, stand));
  for (const MirrorView& view : mirrorViews()) {
    const Camera& camera = view.camera;
    const std::vector<glm::vec3> truth = mirrors.truthOf(instant, camera);
    const auto render = [&](const Frame& frame, const std::optional<ReflectionSpec>& reflection) {
      return renderInWorld(renderer, frame, {camera}, kMirrorView_px, 1, reflection);
    };
    const auto score = [&](const RenderedAtlas& atlas, const HeldBy& held) {
      return mirrorPsnr(*atlas.layout, atlas.linear, truth, held);
    };
    const RenderedAtlas alone = render(*first, effect);
    for (size_t i = 0; i < frames.size(); ++i) {
      const HeldBy held = heldBy(instant, mirrors.stands[i], camera);
      const RenderedAtlas got = render(*frames[i], effect);
      ReflectionScore of_stand = sharesOf(held);
      of_stand.scene = mirrors.name;
      of_stand.sources = mirrors.stands[i].name;
      of_stand.view = view.name;
      of_stand.without = score(render(*frames[i], std::nullopt), held);
      of_stand.alone = score(alone, held);
      of_stand.got = score(got, held);
      of_stand.counts = got.reflections;
      scores.push_back(of_stand);
    }
  }
}

}  // namespace

std::vector<ReflectionScore> reflectionScores(const Device& device) {
  std::vector<ReflectionScore> scores;
  OfflineRenderer renderer(device);
  for (const MirrorScene& scene : mirrorScenes()) addScores(renderer, scene, scores);
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
