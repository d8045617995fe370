// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_stereo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "bench/eye_service.h"
#include "bench/served_head.h"
#include "scoring/psnr.h"
#include "support/eyes/head_truth.h"
#include "support/truth/scenes.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;
using test::EyeScore;
using test::HeadTruth;

constexpr SizePx kSource_px{480, 360};
constexpr double kFocal_px = 420;
constexpr SizePx kEye_px{160, 120};
constexpr int kPoseCount = 6;
constexpr double kPause_s = 0.63;  // of the head's way, between two poses
constexpr uint32_t kLayersMost = 3;

// The mean of squared errors, from their dB.
class MeanDb {
 public:
  void add(double db) {
    sum_ += std::pow(10, -db / 10);
    ++count_;
  }
  double db() const { return psnrDb(sum_ / count_); }

 private:
  double sum_ = 0;
  int count_ = 0;
};

// Scores over both eyes and all poses.
struct TrackScore {
  MeanDb inside, known, full, still;
  double worst_known_db = std::numeric_limits<double>::infinity();
  double outside_share = 0, outside_differs_share = 0, depth_off_share = 0;  // sums

  void add(const EyeScore& served, const EyeScore& at_rest) {
    inside.add(served.inside_db);
    known.add(served.known_db);
    full.add(served.full_db);
    still.add(at_rest.full_db);
    worst_known_db = std::min(worst_known_db, served.known_db);
    outside_share += served.outside_share;
    outside_differs_share += served.outside_differs_share;
    depth_off_share += served.depth_off_share;
  }
};

EyePoses posesAt(double time_s) {
  EyePoses poses = headAt(HeadMotion::kFree, time_s);
  for (TrackedEye& eye : poses.eyes) eye.projection = test::fovOf(kSource_px, kFocal_px);
  return poses;
}

Json scoreOf(const Device& device, const char* name, const truth::Scene& scene,
             uint32_t layer_count) {
  const HeadTruth truth(scene, kSource_px, kFocal_px, layer_count);
  ServedHead head(device, truth.frame(), kEye_px);
  const AtlasPtr at_rest = head.seenBy(posesAt(0));
  TrackScore track;
  for (int i = 1; i <= kPoseCount; ++i) {
    const EyePoses poses = posesAt(kPause_s * i);
    const AtlasPtr served = head.seenBy(poses);
    for (size_t eye = 0; eye < poses.eyes.size(); ++eye) {
      const Camera camera{
          .pose = poses.eyes[eye].pose,
          .intrinsics = intrinsicsFromFov(test::fovOf(kSource_px, kFocal_px), kEye_px)};
      const test::TrueEye true_eye = truth.seenBy(camera, kEye_px);
      track.add(true_eye.score(*served, eye), true_eye.score(*at_rest, eye));
    }
  }
  const double count = 2.0 * kPoseCount;
  return {{"scene", name},
          {"layers", layer_count},
          {"poses", kPoseCount},
          {"inside_db", track.inside.db()},
          {"known_db", track.known.db()},
          {"full_db", track.full.db()},
          {"still_db", track.still.db()},
          {"worst_known_db", track.worst_known_db},
          {"outside_share", track.outside_share / count},
          {"outside_differs_share", track.outside_differs_share / count},
          {"depth_off_share", track.depth_off_share / count}};
}

}  // namespace

Json qualityOfStereo(const Device& device) {
  Json rows = Json::array();
  for (const uint32_t layer_count : {1u, kLayersMost}) {
    rows.push_back(scoreOf(device, "cluttered room", truth::clutteredRoom(), layer_count));
    rows.push_back(scoreOf(device, "thin structures", truth::thinStructures(), layer_count));
    rows.push_back(scoreOf(device, "large smooth", truth::largeSmooth(), layer_count));
  }
  return rows;
}

}  // namespace viewloom::bench
