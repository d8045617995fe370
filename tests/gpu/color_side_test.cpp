// SPDX-License-Identifier: Apache-2.0
// Colour planes of another size than depth, beside a silhouette: what a disc uncovers shows nothing
// of the disc, on no row.
#include <algorithm>
#include <cmath>

#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/test_device.h"

namespace viewloom::color_side_test {
namespace {

constexpr double kTolerance_px = 0.05;
constexpr double kWall = 0.25, kDisc = 1;  // 1/m
constexpr double kDiscRadius = 0.23;       // of the image's height
constexpr int kDiscCode = 230;             // red of the disc; of the wall 0
constexpr double kWallCodes = 160;         // by which the wall's blue grows from top to bottom
constexpr double kCodeTolerance = 0.5;     // of a colour that is not rounded yet
constexpr int kSubsamples = 8;             // a side, of texels that the disc's rim crosses

using Codes = std::array<double, 3>;

// The disc in an image of a size, px.
struct Disc {
  glm::dvec2 middle;
  double radius = 0;

  double beyondRim(glm::dvec2 place) const { return glm::length(place - middle) - radius; }
};

Disc discIn(SizePx size_px) {
  const glm::dvec2 size(size_px.width, size_px.height);
  // Nowhere on a grid.
  return {.middle = size * glm::dvec2(0.507, 0.493), .radius = kDiscRadius * size.y};
}

Codes wallAt(double y_share) {
  return {0, 90, 40 + kWallCodes * y_share};
}

// How much of a texel the disc covers.
double coverOf(const Disc& disc, uint32_t x, uint32_t y) {
  int inside = 0;
  for (int i = 0; i < kSubsamples * kSubsamples; ++i) {
    const glm::dvec2 part(i % kSubsamples, i / kSubsamples);
    inside += disc.beyondRim(glm::dvec2(x, y) + (part + 0.5) / double(kSubsamples)) < 0;
  }
  return double(inside) / (kSubsamples * kSubsamples);
}

// With a smooth rim, as cameras and renderers make it.
SharedBytes pictureOf(SizePx size_px) {
  const Disc disc = discIn(size_px);
  auto bytes = std::make_shared<std::vector<uint8_t>>();
  for (uint32_t y = 0; y < size_px.height; ++y) {
    const Codes wall = wallAt((y + 0.5) / size_px.height);
    for (uint32_t x = 0; x < size_px.width; ++x) {
      const double cover = coverOf(disc, x, y);
      const Codes near = {kDiscCode, 60, 40};
      for (size_t i = 0; i < 3; ++i) {
        bytes->push_back(uint8_t(std::lround(std::lerp(wall[i], near[i], cover))));
      }
      bytes->push_back(255);
    }
  }
  return bytes;
}

class ColorSideTest : public GpuTest {
 protected:
  // Depth and colour of these sizes, and views as large as the larger of them.
  void build(SizePx depth_px, SizePx color_px) {
    SCOPED_TRACE("built");
    depth_px_ = depth_px;
    color_px_ = color_px;
    view_px_ = color_px.width > depth_px.width ? color_px : depth_px;
    scene_ = oracle::planeScene({0, 0, kWall}, int(depth_px.width), int(depth_px.height));
    const Disc disc = discIn(depth_px);
    for (int y = 0; y < int(depth_px.height); ++y) {
      for (int x = 0; x < int(depth_px.width); ++x) {
        if (disc.beyondRim({x + 0.5, y + 0.5}) < 0) scene_.planes.at(0, x, y) = float(kDisc);
      }
    }
    Frame frame = *frameOf(scene_);
    frame.format.sources[0].layers[0].color.size_px = color_px;
    frame.sources[0][0].color = picture_ = pictureOf(color_px);
    slot_ = walk_.build(frame);
  }

  TracedView traceFrom(glm::dvec2 eye_m, SizePx view_px) {
    oracle::OutputView view = oracle::ownView(scene_);
    const glm::dvec2 scale =
        glm::dvec2(view_px.width, view_px.height) / glm::dvec2(depth_px_.width, depth_px_.height);
    view.pinhole.focal_px *= scale;
    view.pinhole.principal_px *= scale;
    view.width = int(view_px.width);
    view.height = int(view_px.height);
    view.position_m = {eye_m.x, eye_m.y, 0};
    focal_px_ = view.pinhole.focal_px;
    return walk_.trace(*slot_, {view}, kTolerance_px).front();
  }

  // A px of a view per px of depth and of colour, the larger.
  double coarsest_px() const {
    return double(view_px_.width) / std::min(depth_px_.width, color_px_.width);
  }

  void expectTheWallBesideTheDisc(glm::dvec2 eye_m) {
    const TracedView view = traceFrom(eye_m, view_px_);
    // Image rows grow downwards, so an eye further up moves its picture down.
    const glm::dvec2 per_inv_z = focal_px_ * eye_m * glm::dvec2(-1, 1);
    Disc disc = discIn(view_px_);
    disc.middle += per_inv_z * kDisc;
    // Facets of the disc reach half a diagonal of a px of depth beyond its rim, and px at edges
    // are blended with what is beside them.
    const double depth_px = double(view_px_.width) / depth_px_.width;
    const double rim_px = std::sqrt(0.5) * depth_px + 1;
    // Colour comes from the next px of depth or the next texel further in, whichever is larger,
    // or its neighbour: so far it may come from another row.
    const double off_max = kWallCodes * 2 * coarsest_px() / view_px_.height + kCodeTolerance;
    int beside_count = 0, disc_count = 0, hidden_count = 0;
    double reddest = 0, furthest_off = 0;
    for (int y = 0; y < int(view_px_.height); ++y) {
      for (int x = 0; x < int(view_px_.width); ++x) {
        const size_t at = view.index(x, y);
        const double beyond_px = disc.beyondRim({x + 0.5, y + 0.5});
        const double red = 255 * view.srgb[at][0];
        disc_count += beyond_px < -2 * rim_px && std::abs(red - kDiscCode) < kCodeTolerance;
        // Rows that the eye alone sees continue the border.
        const double source_y = y + 0.5 - per_inv_z.y * kWall;
        if (beyond_px < rim_px || source_y < 1 || source_y > view_px_.height - 1) continue;
        ++beside_count;
        hidden_count += view.records[at].ray_class == abi::kClassHidden;
        reddest = std::max(reddest, red);
        const double blue = wallAt(source_y / view_px_.height)[2];
        // Hidden light goes on from where the ray passed the rim.
        if (view.records[at].ray_class == abi::kClassHidden && eye_m.y != 0) continue;
        furthest_off = std::max(furthest_off, std::abs(255 * view.srgb[at][2] - blue));
      }
    }
    EXPECT_LE(reddest, kCodeTolerance);
    EXPECT_LE(furthest_off, off_max);
    EXPECT_GT(disc_count, 300);
    EXPECT_GT(hidden_count, 100);
    EXPECT_GT(beside_count, 4000);
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  SizePx depth_px_, color_px_, view_px_;
  oracle::Scene scene_;
  SharedBytes picture_;
  std::unique_ptr<StructureSlot> slot_;
  glm::dvec2 focal_px_{0.0};
};

constexpr glm::dvec2 kEyes_m[] = {{0.12, 0}, {-0.12, 0}, {0, 0.12}, {0, -0.12}, {-0.1, 0.08}};

struct Sizes {
  SizePx depth_px, color_px;
};
constexpr Sizes kSizes[] = {{{64, 48}, {128, 96}},
                            {{128, 96}, {64, 48}},
                            {{40, 30}, {160, 120}},
                            {{80, 60}, {128, 96}},
                            {{160, 120}, {112, 84}}};

TEST_F(ColorSideTest, whatADiscUncoversShowsNothingOfIt) {
  for (const Sizes& sizes : kSizes) {
    build(sizes.depth_px, sizes.color_px);
    for (const glm::dvec2& eye_m : kEyes_m) {
      SCOPED_TRACE("depth " + std::to_string(sizes.depth_px.width) + " px wide, colour " +
                   std::to_string(sizes.color_px.width) + ", eye at " + std::to_string(eye_m.x) +
                   " " + std::to_string(eye_m.y));
      expectTheWallBesideTheDisc(eye_m);
    }
  }
}

// There all texels show as they are, also at the rim.
TEST_F(ColorSideTest, fromTheSourcesOwnPlaceTexelsAreAsTheyAre) {
  for (const Sizes& sizes : kSizes) {
    build(sizes.depth_px, sizes.color_px);
    const TracedView view = traceFrom({0, 0}, sizes.color_px);
    int differing = 0;
    for (size_t i = 0; i < view.srgb.size(); ++i) {
      for (size_t channel = 0; channel < 3; ++channel) {
        const double code = 255 * view.srgb[i][channel];
        differing += std::abs(code - double((*picture_)[4 * i + channel])) > kCodeTolerance;
      }
    }
    EXPECT_EQ(differing, 0) << sizes.depth_px.width << " and " << sizes.color_px.width;
  }
}

}  // namespace
}  // namespace viewloom::color_side_test
