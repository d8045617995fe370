// SPDX-License-Identifier: Apache-2.0
#include "gpu/sources_under_test.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>

#include "gpu/cube_scenes.h"
#include "oracle/scene_generator.h"

namespace viewloom {
namespace {

oracle::MergedAnswer answerOf(uint8_t mask, float view_inv_z, const float* srgb, size_t sources) {
  constexpr oracle::RayClass kClasses[] = {oracle::RayClass::kHit, oracle::RayClass::kHitAssumed,
                                           oracle::RayClass::kHidden, oracle::RayClass::kOutside,
                                           oracle::RayClass::kEmpty};
  oracle::MergedAnswer answer{.ray_class = kClasses[mask - abi::kClassHit],
                              .view_inv_z = double{view_inv_z}};
  for (size_t i = 0; i < sources; ++i) answer.shares.push_back(double{srgb[i]});
  return answer;
}

// Two to three scenes: another one each, or the first one again from beside it, or as it is but for
// noise below the connection tolerance.
std::vector<PosedScene> randomSources(uint64_t seed, oracle::Random& random) {
  std::vector<PosedScene> scenes;
  const int count = random.integer(2, 3);
  for (int i = 0; i < count; ++i) {
    const bool is_same = i > 0 && random.chance(0.5);
    PosedScene posed{.scene = is_same ? scenes.front().scene : oracle::randomScene(seed + i)};
    if (is_same) {
      const float share = float(random.uniform(0.97, 1.03));
      for (float& inv_z : posed.scene.planes.inv_z) {
        if (inv_z > 0) inv_z *= share;
      }
    }
    if (i > 0 && random.chance(is_same ? 0.3 : 0.8)) {
      const auto move = [&] { return random.uniform(-0.6, 0.6); };
      posed.position_m = {move(), move(), move()};
      posed.orientation = glm::angleAxis(random.uniform(-0.8, 0.8),
                                         glm::normalize(glm::dvec3(move(), move(), move() + 0.01)));
    }
    scenes.push_back(std::move(posed));
  }
  return scenes;
}

// The oracle's sources of built scenes.
class OraclesOfScenes {
 public:
  OraclesOfScenes(const std::vector<PosedScene>& scenes,
                  std::span<const StructureSlot* const> parts) {
    for (const PosedScene& scene : scenes) {
      const size_t part_count = scene.is_cube_map ? oracle::kFaceCount : 1;
      add(scene, parts.first(part_count));
      parts = parts.subspan(part_count);
    }
  }

  const std::vector<oracle::PosedSource>& posed() const { return posed_; }

 private:
  void add(const PosedScene& posed, std::span<const StructureSlot* const> parts) {
    const oracle::Scene& scene = posed.scene;
    oracle::PosedSource source{.position_m = posed.position_m, .orientation = posed.orientation};
    if (posed.is_cube_map) {
      source.cube = &cubes_.emplace_back(oracleOf(scene, parts));
    } else {
      const StructureSlot& slot = *parts.front();
      source.source = &sources_.emplace_back(sourceOf(scene, slot));
      source.kappa = kappaOf(scene, slot.stats());
    }
    posed_.push_back(source);
  }

  std::deque<oracle::OracleSource> sources_;
  std::deque<oracle::OracleCube> cubes_;
  std::vector<oracle::PosedSource> posed_;
};

}  // namespace

FramePtr frameOf(const std::vector<PosedScene>& scenes, bool is_half_float) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  for (size_t i = 0; i < scenes.size(); ++i) {
    const oracle::Scene& scene = scenes[i].scene;
    LinearColor color{0, 0, 0, 1};
    color[i] = 1;
    const std::vector<LinearColor> colors(size_t(scene.planes.layer_count), color);
    const FramePtr one = is_half_float ? frameOf(scene, colors) : frameOf(scene);
    SourceFormat& format = frame->format.sources.emplace_back(one->format.sources.front());
    format.camera.pose = {scenes[i].position_m, scenes[i].orientation};
    format.is_cube_map = scenes[i].is_cube_map;
    std::vector<LayerPlanes>& layers = frame->sources.emplace_back(one->sources.front());
    for (LayerPlanes& layer : layers) {
      if (is_half_float) continue;
      std::vector<uint8_t> bytes(layer.color->size());
      for (size_t b = 0; b < bytes.size(); ++b) bytes[b] = b % 4 == i || b % 4 == 3 ? 255 : 0;
      layer.color = std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
    }
  }
  return frame;
}

SourcesUnderTest::SourcesUnderTest(const Device& device)
    : device_(device), builder_(device), tracer_(device), recorder_(device), timeline_(device) {}

void SourcesUnderTest::build(const Frame& frame) {
  structure_.emplace(device_, shapesOf(frame));
  structure_->upload(frame);
  sources_.clear();
  for (const SourceFormat& source : frame.format.sources) sources_.push_back(seenSource(source));
  structure_->recordBuild(recorder_.begin(), builder_);
  timeline_.wait(recorder_.submit(timeline_));
}

std::vector<MergedView> SourcesUnderTest::trace(const std::vector<oracle::OutputView>& views,
                                                double tolerance_px) {
  const TraceJob job = jobOf(views, tolerance_px, sources_);
  const AtlasLayout& layout = *job.layout;
  TraceSlot traced(device_, {.width_px = layout.size_px.width,
                             .row_count_max = layout.size_px.height,
                             .tile_count_max = uint32_t(views.size()),
                             .walk_count = job.walk_count,
                             .outputs = {.depth = true, .mask = true, .linear = true}});
  tracer_.recordBand(recorder_.begin(), structure_->parts(), job, {0, layout.size_px.height},
                     traced, nullptr);
  timeline_.wait(recorder_.submit(timeline_));
  std::vector<MergedView> by_view(views.size());
  for (size_t index = 0; index < layout.size_px.area(); ++index) {
    MergedView& view = by_view[index % layout.size_px.width / layout.tile_size_px.width];
    view.width = int(layout.tile_size_px.width);
    view.answers.push_back(answerOf(traced.mask()[index], traced.depth()[index],
                                    &traced.linear()[4 * index], sources_.size()));
  }
  return by_view;
}

oracle::Verdict judgeScenes(SourcesUnderTest& tracer, const std::vector<PosedScene>& scenes,
                            const std::vector<oracle::OutputView>& views, const JudgedRays& rays) {
  tracer.build(*frameOf(scenes, rays.is_half_float));
  const OraclesOfScenes oracles(scenes, tracer.structure().parts());
  oracle::MergeJudge judge(oracles.posed(), rays.tolerance_px);
  const std::vector<MergedView> traced = tracer.trace(views, rays.tolerance_px);
  for (size_t v = 0; v < views.size(); ++v) {
    for (int px = 0; px < views[v].width * views[v].height; ++px) {
      const int column = px % views[v].width, row = px / views[v].width;
      judge.consider(oracle::rayOf(views[v], column + 0.5, row + 0.5),
                     traced[v].answers[size_t(px)],
                     rays.name + ", view " + views[v].name + " px (" + std::to_string(column) +
                         ", " + std::to_string(row) + ")");
    }
  }
  return judge.verdict();
}

oracle::Verdict judgeSources(SourcesUnderTest& tracer, uint64_t seed) {
  oracle::Random random(seed);
  const std::vector<PosedScene> scenes = randomSources(seed, random);
  const auto views = oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
  return judgeScenes(tracer, scenes, views,
                     {.tolerance_px = oracle::toleranceOfSeed_px(seed),
                      .is_half_float = seed % 2 == 0,
                      .name = "seed " + std::to_string(seed)});
}

}  // namespace viewloom
