// SPDX-License-Identifier: Apache-2.0
#include "bench/knob_loads.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "bench/eye_service.h"
#include "bench/lens_scene.h"
#include "bench/moving_frames.h"
#include "support/srgb_transfer.h"
#include "support/truth/mirror_scenes.h"
#include "support/truth/mirrored.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"
#include "temporal/camera_track.h"

namespace viewloom::bench {
namespace {

constexpr uint32_t kLayers = 2;
constexpr SizePx kSource_px{960, 720};
constexpr SizePx kView_px{480, 360};
constexpr double kFocalPerWidth = 0.9;
constexpr uint32_t kEnvironment_rgb = 0x808080;
constexpr double kLensRadius_m = 0.05;
constexpr uint32_t kTrueLensRays = 256;  // a px

struct Sight {
  Camera camera;
  SizePx size_px;
};

Sight sightOf(const Pose& pose, SizePx size_px, uint32_t by) {
  const SizePx small{size_px.width / by, size_px.height / by};
  return {.camera = {.pose = pose,
                     .intrinsics = {.focal_px = glm::dvec2(kFocalPerWidth * small.width),
                                    .principal_px = {0.5 * small.width, 0.5 * small.height}}},
          .size_px = small};
}

// True views in a row, one beside the other.
class TrueAtlas {
 public:
  TrueAtlas(SizePx view_px, size_t view_count)
      : view_px_(view_px), width_px_(view_px.width * uint32_t(view_count)) {
    load_.truth.size_px = {width_px_, view_px.height};
    load_.truth.rgb.resize(3 * load_.truth.size_px.area());
    load_.is_known.resize(load_.truth.size_px.area());
  }

  // Linear light and truth::Known, [height][width].
  void add(const std::vector<glm::vec3>& light, const std::vector<uint8_t>& known) {
    for (size_t i = 0; i < light.size(); ++i) {
      const size_t px = i / view_px_.width * width_px_ + first_px_ + i % view_px_.width;
      for (int c = 0; c < 3; ++c) {
        load_.truth.rgb[3 * px + size_t(c)] = float(srgbFrom(std::min(double{light[i][c]}, 1.0)));
      }
      load_.is_known[px] = known[i] < kLayers;
    }
    first_px_ += view_px_.width;
  }

  KnobLoad take() { return std::move(load_); }

 private:
  const SizePx view_px_;
  const uint32_t width_px_;
  uint32_t first_px_ = 0;
  KnobLoad load_;
};

// In the world, in a row.
DisplaySpec displayOf(const std::vector<Sight>& sights) {
  CamerasSpec cameras{
      .cameras = {}, .tile_size_px = sights.front().size_px, .columns = uint32_t(sights.size())};
  for (const Sight& sight : sights) {
    cameras.cameras.push_back({sight.camera.pose, sight.camera.intrinsics});
  }
  return {.kind = cameras, .world_pose = Pose{}};
}

KnobLoad roomLoad(const char* application, const std::vector<Pose>& poses, uint32_t by) {
  const truth::Instant instant(truth::clutteredRoom(), 0);
  const Sight source = sightOf({}, kSource_px, by);
  std::vector<Sight> sights;
  for (const Pose& pose : poses) sights.push_back(sightOf(pose, kView_px, by));
  TrueAtlas atlas(sights.front().size_px, sights.size());
  for (const Sight& sight : sights) {
    atlas.add(takePicture(instant, sight.camera, {.size_px = sight.size_px}).layers[0].color,
              knownFrom(instant, source.camera, source.size_px, sight.camera, sight.size_px));
  }
  KnobLoad load = atlas.take();
  load.application = application;
  load.frame = truth::frameOf(
      takePicture(instant, source.camera, {.size_px = source.size_px, .layer_count = kLayers}),
      kLayers);
  load.display = displayOf(sights);
  return load;
}

KnobLoad viewsLoad(uint32_t by) {
  std::vector<Pose> eyes;
  for (const double aside_m : {-0.24, -0.08, 0.08, 0.24}) {
    eyes.push_back({.position_m = {aside_m, 0, 0}});
  }
  return roomLoad("views", eyes, by);
}

KnobLoad stereoLoad(uint32_t by) {
  const EyePoses eyes = headAt(HeadMotion::kFree, 0.7);
  return roomLoad("stereo", {eyes.eyes[0].pose, eyes.eyes[1].pose}, by);
}

// Blur reaches beyond the source in a margin of the view, which does not count.
KnobLoad lensLoad(uint32_t by) {
  const truth::Instant instant(truth::clutteredRoom(), 0);
  const SizePx source_px = lensPictureSize(kSource_px.width / by);
  const Sight sight{.camera = lensCamera(kView_px.width / by),
                    .size_px = lensPictureSize(kView_px.width / by)};
  const std::vector<float> samples =
      trueLensPicture(instant, sight.camera, sight.size_px, kLensRadius_m, kTrueLensRays);
  std::vector<glm::vec3> light;
  std::vector<uint8_t> known;
  const uint32_t margin_px = sight.size_px.width / 20;
  for (uint32_t y = 0; y < sight.size_px.height; ++y) {
    for (uint32_t x = 0; x < sight.size_px.width; ++x) {
      const size_t px = light.size();
      light.push_back({samples[3 * px], samples[3 * px + 1], samples[3 * px + 2]});
      const bool is_inside = x >= margin_px && x + margin_px < sight.size_px.width &&
                             y >= margin_px && y + margin_px < sight.size_px.height;
      known.push_back(is_inside ? 0 : kLayers);
    }
  }
  TrueAtlas atlas(sight.size_px, 1);
  atlas.add(light, known);
  KnobLoad load = atlas.take();
  load.application = "lens";
  load.frame = truth::frameOf(takePicture(instant, lensCamera(source_px.width),
                                          {.size_px = source_px, .layer_count = kLayers}),
                              kLayers);
  load.display = displayOf({sight});
  load.display.lens =
      LensSpec{.aperture_radius_m = kLensRadius_m, .focus_distance_m = kLensFocus_m};
  return load;
}

// Half way to the third frame of 30 Hz, as the first two tell that the camera moves.
KnobLoad timeLoad() {
  const Sequence sequence = movingCamera();
  CameraTrack track;
  CameraMotion motion;
  const auto timeNs = [](uint32_t index) { return std::llround(1e9 * index / kSequenceRate_hz); };
  for (const uint32_t index : {0U, 2U}) {
    const double time_s = index / kSequenceRate_hz;
    motion = track.add({.pose = sequence.camera_at(time_s),
                        .captured_ns = timeNs(index),
                        .arrived_ns = timeNs(index),
                        .inv_z_near = 0.5});
  }
  const truth::Picture source = pictureOf(sequence, 2, kLayers);
  const truth::Picture truth = pictureOf(sequence, 3, 1);
  const truth::Instant instant(sequence.scene, 0);
  TrueAtlas atlas(kSequence_px, 1);
  atlas.add(truth.layers[0].color,
            knownFrom(instant, source.camera, kSequence_px, truth.camera, kSequence_px));
  KnobLoad load = atlas.take();
  load.application = "time";
  load.frame = truth::frameOf(source, kLayers);
  const int64_t bridge_ns = timeNs(15);
  const Sight seen{.camera = {.pose = predicted(motion, timeNs(3), bridge_ns).source_pose,
                              .intrinsics = sequenceIntrinsics()},
                   .size_px = kSequence_px};
  load.display = displayOf({seen});
  return load;
}

KnobLoad reflectionsLoad(uint32_t by) {
  const truth::Instant instant(truth::mirrorFloor(0.4), 0);
  const Sight source = sightOf({}, kSource_px, by);
  const Sight beside = sightOf({.position_m = {0.15, 0.08, 0}}, kView_px, by);
  const double grey = linearFrom((kEnvironment_rgb & 0xff) / 255.0);
  TrueAtlas atlas(beside.size_px, 1);
  atlas.add(
      takeMirrored(instant, beside.camera, beside.size_px,
                   {.bounce_count = 1, .sample_count = 512, .environment = glm::vec3(float(grey))}),
      mirroredKnownFrom(instant, {{source.camera, source.size_px}}, beside.camera, beside.size_px));
  KnobLoad load = atlas.take();
  load.application = "reflections";
  load.frame = truth::frameOf(
      takePicture(
          instant, source.camera,
          {.size_px = source.size_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}),
      kLayers);
  load.display = displayOf({beside});
  load.display.reflection = ReflectionSpec{.bounce_count = 1, .environment_rgb = kEnvironment_rgb};
  return load;
}

}  // namespace

std::vector<KnobLoad> knobLoads(uint32_t by) {
  return {viewsLoad(by), stereoLoad(by), lensLoad(by), timeLoad(), reflectionsLoad(by)};
}

}  // namespace viewloom::bench
