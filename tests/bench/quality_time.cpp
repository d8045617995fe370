// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_time.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "bench/moving_frames.h"
#include "offline/shown_frame.h"
#include "support/truth/picture_frame.h"
#include "temporal/camera_track.h"
#include "walk/offline_renderer.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kLayers = 2;
constexpr uint32_t kFrameCount = 17;  // at kSequenceRate_hz
constexpr double kInvZNear = 0.5;     // 1/m
constexpr int64_t kBridge_ns = 250'000'000;

int64_t timeNs(uint32_t index) {
  return std::llround(1e9 * index / kSequenceRate_hz);
}

// A sequence as it truly is, frame by frame.
struct TrueSequence {
  std::string name;
  std::vector<truth::Picture> pictures;
  std::vector<FramePtr> frames;
};

// `pictures`: of the sequence, if they were taken already.
TrueSequence takeAll(const Sequence& sequence, std::vector<truth::Picture> pictures = {}) {
  const bool are_taken = !pictures.empty();
  TrueSequence taken{.name = sequence.name,
                     .pictures = std::move(pictures),
                     .frames = std::vector<FramePtr>(kFrameCount)};
  taken.pictures.resize(kFrameCount);
  WorkerPool workers;
  workers.forEach(kFrameCount, [&](uint32_t index, uint32_t) {
    if (!are_taken) taken.pictures[index] = pictureOf(sequence, index, kLayers);
    taken.frames[index] = frameOf(sequence, taken.pictures[index], index, kLayers);
  });
  return taken;
}

// The frame's cameras at once. `before`: the one that was kept before it.
TrackedFrame trackedFrame(const TrueSequence& sequence, uint32_t index, uint32_t before) {
  TrackedFrame tracked = viewloom::trackedFrame(
      *sequence.frames[index], before < index ? sequence.frames[before].get() : nullptr, kInvZNear);
  tracked.captured_ns = timeNs(index);
  tracked.arrived_ns = timeNs(index);
  tracked.built_ns = timeNs(index);
  return tracked;
}

// One view, of the sequence's size, from a place in the world.
ScoredImage viewFrom(OfflineRenderer& renderer, const Pose& pose) {
  const CamerasSpec camera{
      .cameras = {{Pose{}, sequenceIntrinsics()}}, .tile_size_px = kSequence_px, .columns = 1};
  const auto spec = completeDisplaySpec({.kind = camera, .world_pose = pose});
  if (!spec.ok()) throw std::runtime_error(std::string(spec.status().message()));
  const auto atlas = renderer.render(*spec, {.linear = true}, [](uint32_t, uint32_t) {});
  if (!atlas.ok()) throw std::runtime_error(std::string(atlas.status().message()));
  ScoredImage image{.size_px = kSequence_px, .rgb = {}};
  for (size_t px = 0; px < kSequence_px.area(); ++px) {
    for (size_t c = 0; c < 3; ++c) image.rgb.push_back(atlas->linear[4 * px + c]);
  }
  return image;
}

// Sums of what every dropped frame scores.
class Scores {
 public:
  // `nearest`: the kept frame that is warped to where the display stands.
  void add(const truth::Picture& dropped, const truth::Picture& repeated,
           const truth::Picture& nearest, const Pose& display, const ScoredImage& got) {
    const ScoredImage truth = imageOf(dropped);
    sums_.repeated_db += psnrDb(imageOf(repeated), truth);
    sums_.warped_db += psnrDb(rowWarp(nearest, display, WarpedColor::kOfPx), truth);
    sums_.blended_db += psnrDb(rowWarp(nearest, display, WarpedColor::kBetweenPx), truth);
    sums_.got_db += psnrDb(got, truth);
    ++count_;
  }
  TimeScore means(const TrueSequence& sequence, std::string mode, uint32_t kept_one_of) const {
    return {.sequence = sequence.name,
            .mode = std::move(mode),
            .kept_one_of = kept_one_of,
            .repeated_db = sums_.repeated_db / count_,
            .warped_db = sums_.warped_db / count_,
            .blended_db = sums_.blended_db / count_,
            .got_db = sums_.got_db / count_};
  }

 private:
  TimeScore sums_;
  uint32_t count_ = 0;
};

// Each dropped frame from the kept one before it, as the two before tell that the camera moves, and
// planes of motion that things do.
TimeScore scorePrediction(OfflineRenderer& renderer, const TrueSequence& sequence,
                          uint32_t kept_one_of) {
  Scores scores;
  WorkerPool workers;
  FrameRetimer retimer(workers);
  CameraTrack track;
  track.add(trackedFrame(sequence, 0, 0));
  for (uint32_t kept = kept_one_of; kept + kept_one_of < kFrameCount; kept += kept_one_of) {
    const truth::Picture& picture = sequence.pictures[kept];
    const CameraMotion motion = track.add(trackedFrame(sequence, kept, kept - kept_one_of));
    for (uint32_t index = kept + 1; index < kept + kept_one_of; ++index) {
      const ShownInstant shown = predicted(motion, timeNs(index), kBridge_ns);
      if (index == kept + 1 || motion.movesThings()) {
        renderer.build(*carriedFrame(retimer, sequence.frames[kept], shown.carried_ns, shown.things,
                                     Guesses::kStand));
      }
      scores.add(sequence.pictures[index], picture, picture, shown.source_pose,
                 viewFrom(renderer, shown.source_pose));
    }
  }
  return scores.means(sequence, "predict", kept_one_of);
}

// Each dropped frame from the kept ones on both sides, as two sources.
TimeScore scoreInterpolation(OfflineRenderer& renderer, const TrueSequence& sequence,
                             uint32_t kept_one_of) {
  Scores scores;
  WorkerPool workers;
  FrameRetimer newest_retimer(workers), before_retimer(workers);
  CameraTrack track;
  track.add(trackedFrame(sequence, 0, 0));
  for (uint32_t kept = kept_one_of; kept < kFrameCount; kept += kept_one_of) {
    const truth::Picture& picture = sequence.pictures[kept];
    const truth::Picture& before = sequence.pictures[kept - kept_one_of];
    const CameraMotion motion = track.add(trackedFrame(sequence, kept, kept - kept_one_of));
    for (uint32_t index = kept + 1 - kept_one_of; index < kept; ++index) {
      const ShownInstant shown = interpolated(motion, timeNs(index) + motion.lag_ns, kBridge_ns);
      const int64_t from_before_ns = shown.carried_ns + motion.interval_ns;
      renderer.build(
          *joinedFrames(*carriedFrame(newest_retimer, sequence.frames[kept], shown.carried_ns,
                                      shown.things, Guesses::kGiveWay),
                        *carriedFrame(before_retimer, sequence.frames[kept - kept_one_of],
                                      from_before_ns, shown.things, Guesses::kGiveWay)));
      const bool is_later_nearer = 2 * (kept - index) <= kept_one_of;
      scores.add(sequence.pictures[index], before, is_later_nearer ? picture : before,
                 shown.source_pose, viewFrom(renderer, shown.source_pose));
    }
  }
  return scores.means(sequence, "interpolate", kept_one_of);
}

// Every frame that is dropped, traced from what a stream has of it: no prediction can be better.
double scoreTraced(OfflineRenderer& renderer, const TrueSequence& sequence, uint32_t kept_one_of) {
  double sum_db = 0;
  uint32_t count = 0;
  for (uint32_t index = 1; index < kFrameCount; ++index) {
    if (index % kept_one_of == 0) continue;
    renderer.build(*sequence.frames[index]);
    const truth::Picture& truth = sequence.pictures[index];
    sum_db += psnrDb(viewFrom(renderer, truth.camera.pose), imageOf(truth));
    ++count;
  }
  return sum_db / count;
}

}  // namespace

std::vector<TimeScore> timeScores(const Device& device) {
  OfflineRenderer renderer(device);
  std::vector<TimeScore> scores;
  const auto addScores = [&](const TrueSequence& sequence, uint32_t kept_one_of) {
    scores.push_back(scorePrediction(renderer, sequence, kept_one_of));
    scores.push_back(scoreInterpolation(renderer, sequence, kept_one_of));
  };
  const TrueSequence things = takeAll(movingThings());
  for (const TrueSequence& sequence : {takeAll(movingCamera()), things, takeAll(fastThings())}) {
    for (const uint32_t kept_one_of : {2U, 4U}) addScores(sequence, kept_one_of);
  }
  const TrueSequence sources = takeAll(movingSources(), things.pictures);
  addScores(sources, 4);
  const double traced_db = scoreTraced(renderer, sources, 4);
  for (size_t i = scores.size() - 2; i < scores.size(); ++i) scores[i].traced_db = traced_db;
  return scores;
}

Json qualityOfTime(const Device& device) {
  Json rows = Json::array();
  for (const TimeScore& score : timeScores(device)) {
    rows.push_back({{"sequence", score.sequence},
                    {"mode", score.mode},
                    {"kept_one_of", score.kept_one_of},
                    {"repeated_db", score.repeated_db},
                    {"warped_db", score.warped_db},
                    {"blended_db", score.blended_db},
                    {"got_db", score.got_db}});
    if (score.traced_db) rows.back()["traced_db"] = *score.traced_db;
  }
  return rows;
}

}  // namespace viewloom::bench
