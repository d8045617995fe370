// SPDX-License-Identifier: Apache-2.0
// Things that few walked rays of a lens miss: mode exact sees them nevertheless.
#include "gpu/gathering_places.h"
#include "gpu/through_lens.h"

namespace viewloom::lens_exact_test {
namespace {

// A white pole of 1 px, near the lens and far out of focus, before a dark wall that is in focus.
constexpr double kFocal_px = 320;
constexpr float kPole_m = 0.5F;
constexpr float kWall_m = 2;
constexpr uint32_t kPole_px = 160;
constexpr uint8_t kDark_code = 20;
// Spreads the pole over 96 px.
constexpr double kRadius_m = 0.1;

SyntheticLayer wallLayer(bool has_pole) {
  SyntheticLayer layer;
  for (uint32_t px = 0; px < kSource_px.area(); ++px) {
    const bool is_pole = has_pole && px % kSource_px.width == kPole_px;
    const uint8_t code = is_pole ? 255 : kDark_code;
    layer.color.insert(layer.color.end(), {code, code, code, 255});
    layer.depth_m.push_back(is_pole ? kPole_m : kWall_m);
  }
  return layer;
}

// Colours of the blocks of 8x8 px that the pole is spread over, beside the true ones.
struct PoleSeen {
  double off = 0;            // root mean square, as a share of the light's
  double missing_share = 0;  // of the blocks: less than a quarter of what is true
};

class ExactLens : public ThroughLens, public testing::WithParamInterface<GatheringPlace> {
 protected:
  void SetUp() override {
    ThroughLens::SetUp();
    if (IsSkipped()) return;
    renderer_ = &rendererAt(GetParam());
    renderer_->build(*poleFrame());
    truth_ = poleLight({.walked_count = kWalkedSamplesMax, .gathered_count = 0});
  }

  PoleSeen seenBy(const LensSpec& lens) {
    const std::vector<double> blocks = poleLight(lens);
    PoleSeen seen;
    double squares = 0;
    double true_squares = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
      squares += std::pow(blocks[i] - truth_[i], 2);
      true_squares += truth_[i] * truth_[i];
      seen.missing_share += blocks[i] < 0.25 * truth_[i] ? 1.0 / double(blocks.size()) : 0;
    }
    seen.off = std::sqrt(squares / true_squares);
    std::cout << lens.walked_count << " + " << *lens.gathered_count
              << (lens.is_exact ? " exact" : " fast") << ": off by " << seen.off << ", missing in "
              << seen.missing_share << " of the blocks\n";
    return seen;
  }

 private:
  static constexpr uint32_t kBlock_px = 8;
  static constexpr SizePx kView_px{48, 96};

  static FramePtr poleFrame() {
    const Camera camera{.pose = {},
                        .intrinsics = {.focal_px = {kFocal_px, kFocal_px},
                                       .principal_px = {kPole_px + 0.5, kSource_px.height / 2.0}}};
    return test::layeredFrame(1, camera, kSource_px, {wallLayer(true), wallLayer(false)});
  }

  // Around the pole, block by block, beside the wall's.
  std::vector<double> poleLight(LensSpec lens) {
    lens.aperture_radius_m = kRadius_m;
    lens.focus_distance_m = kWall_m;
    const ViewCamera camera{.pose = {},
                            .projection = Intrinsics{{kFocal_px, kFocal_px},
                                                     {kView_px.width / 2, kView_px.height / 2}}};
    DisplaySpec spec{.kind =
                         CamerasSpec{.cameras = {camera}, .tile_size_px = kView_px, .columns = 1}};
    spec.lens = lens;
    const RenderedAtlas atlas = render(spec);
    std::vector<double> blocks(kView_px.area() / (kBlock_px * kBlock_px));
    for (uint32_t y = 0; y < kView_px.height; ++y) {
      for (uint32_t x = 0; x < kView_px.width; ++x) {
        const double light = linearFrom(channelOf(colorAt(atlas, 0, x, y), 1) / 255.0);
        blocks[y / kBlock_px * (kView_px.width / kBlock_px) + x / kBlock_px] +=
            light - linearFrom(kDark_code / 255.0);
      }
    }
    return blocks;
  }

  std::vector<double> truth_;
};

// Blocks of 64 px with as many gathered rays each, beside 64 walked ones: noise is 3 %.
constexpr double kOff = 0.12;
// With one ray a px a third of the blocks miss the pole, and most of its light.
constexpr double kOffOfFew = 0.5;       // seen 0.57
constexpr double kMissingOfFew = 0.25;  // seen 0.33
constexpr uint32_t kGathered = 64;

TEST_P(ExactLens, showsWhatTheWalkedRaysOfABlockMissed) {
  const PoleSeen fast = seenBy({.walked_count = 1, .gathered_count = kGathered});
  EXPECT_GT(fast.off, kOffOfFew);
  EXPECT_GT(fast.missing_share, kMissingOfFew);
  const PoleSeen exact = seenBy({.walked_count = 1, .gathered_count = kGathered, .is_exact = true});
  EXPECT_LT(exact.off, kOff);
  EXPECT_EQ(exact.missing_share, 0);
}

INSTANTIATE_TEST_SUITE_P(Places, ExactLens, kGatheringPlaces, gatheringPlaceName);

}  // namespace
}  // namespace viewloom::lens_exact_test
