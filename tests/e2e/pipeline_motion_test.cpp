// SPDX-License-Identifier: Apache-2.0
// Things that move by themselves, on displays with an output rate: where they are shown between
// frames, and what that takes.
#include <cstring>
#include <set>
#include <utility>

#include <gmock/gmock.h>

#include <glm/gtc/packing.hpp>

#include "e2e/ticks_fixture.h"

namespace viewloom::test::pipeline_motion_test {
namespace {

constexpr SizePx kPicture_px{64, 48};
constexpr double kFocal_px = 64;
constexpr float kPlate_m = 2;
constexpr float kWall_m = 4;
constexpr double kPlateSpeed_mps = 0.9375;  // 30 px/s; a binary16
constexpr double kPlateSpeed_px_per_s = kPlateSpeed_mps * kFocal_px / kPlate_m;
constexpr double kPlateLeft_px = 12;  // when the server's clock is 0; a frame later it is 15
constexpr double kPlateWidth_px = 12;
// Tolerance for the middle of the white plate, whose edges lie at whole pixels of the source.
constexpr double kMiddleError_px = 0.55;

// The same tolerance for edges that rays find, at whole pixels of the display.
constexpr double kOwnMiddleError_px = 0.55;

bool isPlate(double left_px, uint32_t x, uint32_t y) {
  return x >= left_px && x < left_px + kPlateWidth_px && y >= 16 && y < 32;
}

double plateLeft(double time_s) {
  return kPlateLeft_px + kPlateSpeed_px_per_s * time_s;
}

template <typename T>
SharedBytes bytesOf(const std::vector<T>& values) {
  std::vector<uint8_t> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

// Two layers: a white plate that goes to the right, before a dark wall.
LayerPlanes layerAt(double left_px, uint32_t index, bool tells_motion) {
  std::vector<uint32_t> color;
  std::vector<float> depth_m;
  std::vector<uint16_t> motion;
  for (uint32_t y = 0; y < kPicture_px.height; ++y) {
    for (uint32_t x = 0; x < kPicture_px.width; ++x) {
      const bool is_plate = isPlate(left_px, x, y);
      const bool shows_plate = is_plate && index == 0;
      color.push_back(shows_plate ? 0xffffffff : 0xff202020);
      depth_m.push_back(shows_plate ? kPlate_m : is_plate || index == 0 ? kWall_m : 0);
      motion.push_back(shows_plate ? glm::packHalf1x16(float(kPlateSpeed_mps)) : uint16_t{0});
      motion.insert(motion.end(), 2, 0);
    }
  }
  const bool moves = tells_motion && index == 0;
  return {.color = bytesOf(color),
          .depth = bytesOf(depth_m),
          .motion = moves ? bytesOf(motion) : SharedBytes()};
}

// A frame of the plate, captured and received at the server's `now_ns`.
FramePtr plateFrame(uint64_t number, int64_t now_ns, bool tells_motion) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = number;
  frame->format.capture_time_ns = kStart_ns + now_ns;
  frame->times = {now_ns, now_ns, now_ns};
  SourceFormat& source = frame->format.sources.emplace_back();
  source.camera.intrinsics = {.focal_px = glm::dvec2(kFocal_px),
                              .principal_px = {0.5 * kPicture_px.width, 0.5 * kPicture_px.height}};
  frame->sources.emplace_back();
  for (uint32_t layer = 0; layer < 2; ++layer) {
    LayerFormat& format = source.layers.emplace_back();
    format.color.size_px = kPicture_px;
    format.depth = {.kind = PlaneKind::kDepth,
                    .encoding = PlaneEncoding::kDepthF32,
                    .size_px = kPicture_px,
                    .depth = {}};
    frame->sources.front().push_back(
        layerAt(std::round(plateLeft(1e-9 * double(now_ns))), layer, tells_motion));
  }
  return frame;
}

// The wall, and the plate as a source of its own, whose camera goes with it: to that nothing moves.
FramePtr wallAndPlate(uint64_t number, int64_t now_ns) {
  auto frame = std::make_shared<Frame>(*plateFrame(number, now_ns, false));
  frame->sources.front()[0] = layerAt(kPicture_px.width, 0, false);
  frame->format.sources.front().layers.resize(1);
  frame->sources.front().resize(1);
  LayerPlanes plate = layerAt(kPlateLeft_px, 0, false);
  std::vector<float> depth_m;
  for (uint32_t y = 0; y < kPicture_px.height; ++y) {
    for (uint32_t x = 0; x < kPicture_px.width; ++x) {
      depth_m.push_back(isPlate(kPlateLeft_px, x, y) ? kPlate_m : 0);
    }
  }
  plate.depth = bytesOf(depth_m);
  frame->format.sources.push_back(frame->format.sources.front());
  frame->format.sources.back().camera.pose.position_m.x = kPlateSpeed_mps * 1e-9 * double(now_ns);
  frame->sources.push_back({plate});
  return frame;
}

// In the place of the source, as large.
DisplaySpec ownPlace() {
  const Intrinsics lens{.focal_px = glm::dvec2(kFocal_px),
                        .principal_px = {0.5 * kPicture_px.width, 0.5 * kPicture_px.height}};
  DisplaySpec spec;
  spec.kind = CamerasSpec{.cameras = {{Pose{}, lens}}, .tile_size_px = kPicture_px, .columns = 1};
  return ticking(spec);
}

// px from the left.
double middleOfPlate(const EncodedAtlas& atlas) {
  std::vector<uint8_t> rgb;
  for (const EncodedBand& band : atlas.bands) {
    rgb.insert(rgb.end(), band.bytes->begin(), band.bytes->end());
  }
  EXPECT_EQ(rgb.size(), 3 * kPicture_px.area());
  double sum_px = 0, weight = 0;
  for (uint32_t x = 0; x < kPicture_px.width; ++x) {
    const double white = rgb[3 * (size_t{24} * kPicture_px.width + x)] - 0x20;
    sum_px += white * (x + 0.5);
    weight += white;
  }
  return sum_px / weight;
}

double expectedMiddle(const EncodedAtlas& atlas) {
  return plateLeft(1e-9 * double(atlas.shown_time_ns - kStart_ns)) + 0.5 * kPlateWidth_px;
}

constexpr EncodingSpec kRaw{.color = BandEncoding::kRaw};

using Shown = std::pair<uint64_t, int64_t>;  // frame, time

class PipelineMotionTest : public TicksFixture {
 protected:
  static void offerPlate(Server& server, uint64_t number, bool tells_motion = true) {
    server.offer(plateFrame(number, server.clock.nowNs(), tells_motion));
    while (server.metrics.structures_built.value() - server.metrics.structures_retimed.value() <
           double(number)) {
      std::this_thread::yield();
    }
  }

  // All atlases of times that no frame is of.
  static std::set<Shown> betweenFrames(const std::vector<AtlasPtr>& atlases) {
    std::set<Shown> shown;
    for (const AtlasPtr& atlas : atlases) {
      if (atlas->shown_time_ns == atlas->capture_time_ns) continue;
      shown.insert({atlas->frame_number, atlas->shown_time_ns});
    }
    return shown;
  }

  static std::vector<AtlasPtr> all(Server& server, const Viewer& viewer) {
    return viewer.subscriber->waitForAtlases(
        server.broadcaster.atlasCount(viewer.subscription->displayId()));
  }
};

TEST_F(PipelineMotionTest, carriesThingsOnByOneMoreBuildForAllWhoSeeThatTime) {
  Server server(device());
  const Viewer viewer = watch(server, ownPlace(), kRaw);
  const Viewer quilt = watch(server, ticking(), kRaw);
  offerPlate(server, 1);
  viewer.subscriber->waitForAtlases(1);
  quilt.subscriber->waitForAtlases(1);
  server.clock.advance(kFrame_ns);
  offerPlate(server, 2);
  int predicted_count = 0;
  AtlasPtr atlas;
  do {
    atlas = next(server, viewer);
    if (atlas->frame_number < 2 || atlas->shown_time_ns > atlas->capture_time_ns + kFrame_ns) {
      continue;
    }
    EXPECT_NEAR(middleOfPlate(*atlas), expectedMiddle(*atlas), kMiddleError_px);
    predicted_count += atlas->timing == Timing::kPredicted ? 1 : 0;
  } while (atlas->timing != Timing::kHeld);
  EXPECT_GE(predicted_count, 2);
  // Nothing goes on once it is held, on either display.
  while (server.broadcaster.newest(quilt.subscription->displayId())->timing != Timing::kHeld) {
    next(server, quilt);
  }
  const double retimed_count = server.metrics.structures_retimed.value();
  const double traced_count = tracedCount(server.metrics);
  server.clock.advance(10 * kFrame_ns);
  server.pipeline.drain();
  EXPECT_EQ(server.metrics.structures_retimed.value(), retimed_count);
  EXPECT_EQ(tracedCount(server.metrics), traced_count);

  std::set<Shown> shown = betweenFrames(all(server, viewer));
  const std::set<Shown> on_quilt = betweenFrames(all(server, quilt));
  const size_t apart_count = shown.size() + on_quilt.size();
  shown.insert(on_quilt.begin(), on_quilt.end());
  EXPECT_LT(shown.size(), apart_count) << "some times are shown by both";
  EXPECT_EQ(retimed_count, double(shown.size())) << "each is built once";
  EXPECT_EQ(server.metrics.structures_built.value(), 2 + retimed_count);
}

TEST_F(PipelineMotionTest, buildsNothingBetweenFramesWithoutMotion) {
  Server server(device());
  const Viewer viewer = watch(server, ownPlace(), kRaw);
  for (uint64_t number = 1; number <= 2; ++number) {
    offerPlate(server, number, false);
    EXPECT_EQ(viewer.subscriber->waitForAtlases(1).front()->timing, Timing::kCaptured);
    server.clock.advance(kFrame_ns);
  }
  server.clock.advance(10 * kFrame_ns);
  server.pipeline.drain();
  EXPECT_EQ(server.metrics.structures_built.value(), 2);
  EXPECT_EQ(server.metrics.structures_retimed.value(), 0);
}

TEST_F(PipelineMotionTest, carriesASourceThatGoesWithItsThingAndBuildsNothing) {
  for (const bool is_between : {false, true}) {
    Server server(device());
    DisplaySpec spec = ownPlace();
    if (is_between) spec.temporal->mode = TemporalMode::kInterpolate;
    const Viewer viewer = watch(server, spec, kRaw);
    const auto offer = [&](uint64_t number) {
      server.offer(wallAndPlate(number, server.clock.nowNs()));
      while (server.metrics.structures_built.value() < double(number)) std::this_thread::yield();
    };
    offer(1);
    viewer.subscriber->waitForAtlases(1);
    int shown_count = 0;
    for (uint64_t number = 2; number <= 5; ++number) {
      server.clock.advance(kFrame_ns - (number == 2 ? 0 : 2 * kTick_ns));
      offer(number);
      for (int i = 0; i < 2; ++i) {
        const AtlasPtr atlas = next(server, viewer);
        if (atlas->timing != (is_between ? Timing::kInterpolated : Timing::kPredicted)) continue;
        // From there on it slows down.
        if (atlas->shown_time_ns > atlas->capture_time_ns + kFrame_ns) continue;
        ++shown_count;
        EXPECT_NEAR(middleOfPlate(*atlas), expectedMiddle(*atlas), kOwnMiddleError_px);
      }
    }
    EXPECT_GE(shown_count, 2);
    server.pipeline.drain();
    EXPECT_EQ(server.metrics.structures_built.value(), 5) << "of frames alone";
    EXPECT_EQ(server.metrics.structures_retimed.value(), 0);
  }
}

TEST_F(PipelineMotionTest, standsBetweenTwoFramesWithThingsWhereTheyWereThen) {
  Server server(device());
  DisplaySpec spec = ownPlace();
  spec.temporal->mode = TemporalMode::kInterpolate;
  const Viewer viewer = watch(server, spec, kRaw);
  offerPlate(server, 1);
  viewer.subscriber->waitForAtlases(1);
  int between_count = 0;
  for (uint64_t number = 2; number <= 5; ++number) {
    server.clock.advance(kFrame_ns - (number == 2 ? 0 : 2 * kTick_ns));
    offerPlate(server, number);
    for (int i = 0; i < 2; ++i) {
      const AtlasPtr atlas = next(server, viewer);
      if (atlas->timing != Timing::kInterpolated) continue;
      ++between_count;
      EXPECT_LT(atlas->shown_time_ns, atlas->capture_time_ns);
      EXPECT_NEAR(middleOfPlate(*atlas), expectedMiddle(*atlas), kMiddleError_px);
      EXPECT_EQ(atlas->method, TraceMethod::kWalk) << "both frames are asked";
    }
  }
  EXPECT_GT(between_count, 0);
  server.pipeline.drain();
  EXPECT_GT(server.metrics.structures_retimed.value(), 0);
}

}  // namespace
}  // namespace viewloom::test::pipeline_motion_test
