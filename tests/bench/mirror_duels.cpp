// SPDX-License-Identifier: Apache-2.0
#include "bench/mirror_duels.h"

#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "gpu/commands.h"
#include "gpu/mirror_stage.h"
#include "offline/median.h"

namespace viewloom::bench {
namespace {

constexpr double kTolerances_px[] = {kDefaultTolerance_px, 1, 4};
constexpr uint32_t kStrides_px[] = {1, 2, 4, 8, 16};
constexpr double kThicknesses_m[] = {0.02, 0.1, 0.5};
constexpr uint32_t kLayerCounts[] = {1, 2};
constexpr uint32_t kStepCounts[] = {16, 64, 1 << 16};

DisplaySpec displayOf(const Camera& camera, const ReflectionSpec& effect) {
  DisplaySpec spec;
  spec.kind = CamerasSpec{
      .cameras = {{camera.pose, camera.intrinsics}}, .tile_size_px = kMirrorView_px, .columns = 1};
  spec.world_pose = Pose{};
  spec.reflection = effect;
  const auto completed = completeDisplaySpec(spec);
  if (!completed.ok()) throw std::runtime_error(std::string(completed.status().message()));
  return *completed;
}

// How light is found, and how long that took so far.
struct Way {
  std::string name;
  double tolerance_px = kDefaultTolerance_px;
  MirrorStage::Record record;
  std::vector<double> times_ms = {};
};

std::string nameOf(const MarchOptions& options) {
  std::ostringstream name;
  name << "stride " << options.stride_px << " px, " << options.thickness_m << " m thick, "
       << options.layer_count << (options.layer_count == 1 ? " layer" : " layers");
  const bool is_bounded = options.step_count_max < kStepCounts[std::size(kStepCounts) - 1];
  if (is_bounded) name << ", " << options.step_count_max << " steps";
  return name.str();
}

std::vector<Way> walksOf(MirrorPass& mirror) {
  std::vector<Way> ways;
  for (const double tolerance_px : kTolerances_px) {
    std::ostringstream name;
    name << tolerance_px << " px";
    ways.push_back({.name = name.str(),
                    .tolerance_px = tolerance_px,
                    .record = [&](Commands commands, const ReflectedRows& rows) {
                      mirror.record(commands, rows);
                    }});
  }
  return ways;
}

std::vector<Way> marchesOf(DdaMirrors& rival) {
  std::vector<Way> ways;
  const auto add = [&](const MarchOptions& options) {
    ways.push_back({.name = nameOf(options),
                    .record = [&rival, options](Commands commands, const ReflectedRows& rows) {
                      rival.record(commands, rows, options);
                    }});
  };
  for (const uint32_t layer_count : kLayerCounts) {
    for (const double thickness_m : kThicknesses_m) {
      for (const uint32_t stride_px : kStrides_px) {
        for (const uint32_t step_count : kStepCounts) {
          add({stride_px, layer_count, step_count, thickness_m});
        }
      }
    }
  }
  return ways;
}

std::vector<MirrorPoint> pointsOf(const std::vector<Way>& ways) {
  std::vector<MirrorPoint> points;
  for (const Way& way : ways) {
    const double time_ms = way.times_ms.empty() ? 0 : medianOf(way.times_ms);
    points.push_back({.name = way.name, .time_ms = time_ms, .psnr = {}});
  }
  return points;
}

// A round before those that are counted compiles, and is scored.
MirrorDuel duelOf(MirrorStage& stage, const std::vector<glm::vec3>& truth, const HeldBy& held,
                  std::vector<Way> walks, std::vector<Way> marches, uint32_t round_count) {
  const auto run = [&](const Way& way) {
    stage.setTolerance(way.tolerance_px);
    return stage.timedMs(way.record);
  };
  const auto score = [&](const std::vector<float>& linear) {
    return mirrorPsnr(stage.layout(), linear, truth, held);
  };
  std::vector<MirrorPsnr> scores;
  for (std::vector<Way>* ways : {&walks, &marches}) {
    for (const Way& way : *ways) {
      run(way);
      scores.push_back(score(stage.picture()));
    }
  }
  for (uint32_t round = 0; round < round_count; ++round) {
    for (Way& march : marches) march.times_ms.push_back(run(march));
    for (Way& walk : walks) walk.times_ms.push_back(run(walk));
  }
  MirrorDuel duel;
  duel.without = score(stage.without());
  duel.walks = pointsOf(walks);
  duel.marches = pointsOf(marches);
  for (size_t i = 0; i < walks.size(); ++i) duel.walks[i].psnr = scores[i];
  for (size_t i = 0; i < marches.size(); ++i) duel.marches[i].psnr = scores[walks.size() + i];
  return duel;
}

}  // namespace

const MirrorPoint* MirrorDuel::bestMarch(double time_ms_max) const {
  const MirrorPoint* best = nullptr;
  for (const MirrorPoint& march : marches) {
    if (march.time_ms > time_ms_max) continue;
    if (best == nullptr || march.psnr.all_db > best->psnr.all_db) best = &march;
  }
  return best;
}

const MirrorPoint& MirrorDuel::bestMarch() const {
  return *bestMarch(std::numeric_limits<double>::infinity());
}

const MirrorPoint* MirrorDuel::fastestMarch(double all_db_min) const {
  const MirrorPoint* fastest = nullptr;
  for (const MirrorPoint& march : marches) {
    if (!(march.psnr.all_db > all_db_min)) continue;
    if (fastest == nullptr || march.time_ms < fastest->time_ms) fastest = &march;
  }
  return fastest;
}

std::vector<MirrorDuel> mirrorDuels(const Device& device, const MirrorScene& mirrors,
                                    uint32_t round_count) {
  const truth::Instant instant(mirrors.scene, 0);
  const Stand& stand = mirrors.stands.front();
  const FramePtr frame = frameOf(instant, stand);
  MirrorKernels kernels(device);
  DdaMirrors rival(device);
  std::vector<MirrorDuel> duels;
  for (const MirrorView& view : mirrorViews()) {
    MirrorStage stage(kernels, *frame, displayOf(view.camera, mirrors.effect()));
    MirrorDuel duel =
        duelOf(stage, mirrors.truthOf(instant, view.camera), heldBy(instant, stand, view.camera),
               walksOf(kernels.mirror), marchesOf(rival), round_count);
    duel.scene = mirrors.name;
    duel.view = view.name;
    duels.push_back(std::move(duel));
  }
  return duels;
}

}  // namespace viewloom::bench
