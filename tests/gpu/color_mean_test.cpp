// SPDX-License-Identifier: Apache-2.0
// Colour where a px of the view covers several of the source, walked and swept, against means that
// are taken sample by sample in double precision (shaders/color.md, Means).
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "gpu/sweep_under_test.h"
#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/test_device.h"

namespace viewloom::color_mean_test {
namespace {

constexpr int kWidth = 192;
constexpr int kHeight = 96;
constexpr double kTolerance_px = 0.05;
// In codes. Positions have 1/256 px, so along each axis a share is off by up to 1/512, of
// differences of up to 255; and means are rounded to a quarter of a code twice.
constexpr double kCodeTolerance = 2 * 255.0 / 512 + 2 * 0.125;

using Codes = std::array<double, 3>;

struct Picture {
  std::vector<uint8_t> rgba = std::vector<uint8_t>(size_t{kWidth} * kHeight * 4);

  Codes at(int column, int row) const {
    const size_t px = size_t(row) * kWidth + size_t(column);
    return {double(rgba[4 * px]), double(rgba[4 * px + 1]), double(rgba[4 * px + 2])};
  }
  void set(int column, int row, std::array<uint8_t, 3> codes) {
    std::copy(codes.begin(), codes.end(), &rgba[4 * (size_t(row) * kWidth + size_t(column))]);
  }
};

Picture noise() {
  std::mt19937 random(3);
  Picture picture;
  for (uint8_t& byte : picture.rgba) byte = uint8_t(random());
  return picture;
}

// Area that one px of a view covers, px of the source.
struct Footprint {
  double x_px, y_px;
};

// How much of sample `at` a mean around sample `of` takes.
double shareOf(int at, int of, double footprint_px) {
  const double reach_px = std::clamp((footprint_px - 1.4) / 2, 0.0, 8.0);
  return std::clamp(reach_px + 1 - std::abs(at - of), 0.0, 1.0);
}

// Mean on a plane, whose samples are all linked.
Codes meanAround(const Picture& picture, int column, int row, const Footprint& footprint) {
  Codes sum{};
  double weight = 0;
  for (int y = std::max(row - 9, 0); y < std::min(row + 10, kHeight); ++y) {
    for (int x = std::max(column - 9, 0); x < std::min(column + 10, kWidth); ++x) {
      const double share = shareOf(x, column, footprint.x_px) * shareOf(y, row, footprint.y_px);
      for (size_t c = 0; c < 3; ++c) sum[c] += share * picture.at(x, y)[c];
      weight += share;
    }
  }
  for (double& channel : sum) channel /= weight;
  return sum;
}

// Between the four around a place; sampleAt(column, row).
template <typename SampleAt>
Codes between(double x_px, double y_px, const SampleAt& sampleAt) {
  const double x = std::clamp(x_px - 0.5, 0.0, kWidth - 1.0);
  const double y = std::clamp(y_px - 0.5, 0.0, kHeight - 1.0);
  const int column = std::min(int(x), kWidth - 2);
  const int row = std::min(int(y), kHeight - 2);
  Codes blend{};
  for (size_t c = 0; c < 3; ++c) {
    blend[c] = std::lerp(
        std::lerp(sampleAt(column, row)[c], sampleAt(column + 1, row)[c], x - column),
        std::lerp(sampleAt(column, row + 1)[c], sampleAt(column + 1, row + 1)[c], x - column),
        y - row);
  }
  return blend;
}

oracle::OutputView coarseView(const oracle::Scene& scene, const Footprint& footprint,
                              double moved_px, double inv_z) {
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m.x = moved_px / (view.pinhole.focal_px.x * inv_z);
  view.pinhole.focal_px /= glm::dvec2(footprint.x_px, footprint.y_px);
  view.pinhole.principal_px /= glm::dvec2(footprint.x_px, footprint.y_px);
  view.width = int(kWidth / footprint.x_px);
  view.height = int(kHeight / footprint.y_px);
  return view;
}

Codes codesOf(const TracedView& traced, size_t px) {
  return {255.0 * traced.srgb[px][0], 255.0 * traced.srgb[px][1], 255.0 * traced.srgb[px][2]};
}

double worstOf(const Codes& a, const Codes& b) {
  double worst = 0;
  for (size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]));
  return worst;
}

class ColorMeanTest : public GpuTest {
 protected:
  // Walked, and swept.
  std::array<TracedView, 2> trace(const oracle::Scene& scene, const Picture& picture,
                                  const oracle::OutputView& view) {
    const auto frame = std::make_shared<Frame>(*frameOf(scene));
    for (LayerPlanes& planes : frame->sources[0]) {
      planes.color = std::make_shared<std::vector<uint8_t>>(picture.rgba);
    }
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frame);
    sweep_.prepare(frame);
    return {walk_.trace(*slot, {view}, kTolerance_px).front(),
            sweep_.trace({view}, kTolerance_px).front()};
  }

  static constexpr double kInvZ = 0.25;
  const oracle::Scene plane_ = oracle::planeScene({0, 0, kInvZ}, kWidth, kHeight);
  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  SweepUnderTest sweep_;
};

TEST_F(ColorMeanTest, isThatOfWhatAPixelCovers) {
  const Picture picture = noise();
  for (const Footprint& footprint :
       {Footprint{1, 1}, {1.4, 1.4}, {1.6, 1}, {1, 2}, {4.6, 1.9}, {3, 7.5}, {24, 2}}) {
    const oracle::OutputView view = coarseView(plane_, footprint, 0.3, kInvZ);
    for (const TracedView& traced : trace(plane_, picture, view)) {
      double worst = 0;
      for (size_t px = 0; px < traced.records.size(); ++px) {
        const abi::RayRecord& record = traced.records[px];
        if (record.ray_class != abi::kClassHit) continue;
        const Codes expected = between(record.x_px, record.y_px, [&](int column, int row) {
          return meanAround(picture, column, row, footprint);
        });
        worst = std::max(worst, worstOf(codesOf(traced, px), expected));
      }
      EXPECT_LE(worst, kCodeTolerance) << footprint.x_px << " x " << footprint.y_px;
      EXPECT_GT(worst, 0);
    }
  }
}

// Two surfaces of one colour each, and px between them that cover both.
TEST_F(ColorMeanTest, takesNothingFromAcrossASilhouette) {
  constexpr int kFirstNear = 90;
  const oracle::Scene scene =
      oracle::stepScene({0, 0, 1.0}, {0, 0, 0.25}, kFirstNear, false, kWidth, kHeight);
  Picture picture;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const bool is_near = column >= kFirstNear;
      picture.set(column, row,
                  is_near ? std::array<uint8_t, 3>{255, 0, 0} : std::array<uint8_t, 3>{0, 0, 255});
    }
  }
  for (const TracedView& traced : trace(scene, picture, coarseView(scene, {4.6, 1.9}, 0, 1))) {
    for (size_t px = 0; px < traced.records.size(); ++px) {
      const bool is_near = traced.records[px].inv_z > 0.5F;
      const Codes expected = is_near ? Codes{255, 0, 0} : Codes{0, 0, 255};
      ASSERT_LE(worstOf(codesOf(traced, px), expected), 1e-3) << "px " << px;
    }
  }
}

// The last column of the far side holds half of the near colour.
TEST_F(ColorMeanTest, takesNothingOfSamplesThatMayBeMixed) {
  constexpr int kFirstNear = 90;
  constexpr double kFar = 0.25;
  const oracle::Scene scene =
      oracle::stepScene({0, 0, 1.0}, {0, 0, kFar}, kFirstNear, false, kWidth, kHeight);
  Picture picture;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const uint8_t near = column >= kFirstNear ? 255 : column == kFirstNear - 1 ? 128 : 0;
      picture.set(column, row, {near, 0, uint8_t(255 - near)});
    }
  }
  // So far that all mixed samples give way, and to the side from which nothing is hidden.
  const oracle::OutputView view = coarseView(scene, {4.6, 1.9}, -5, kFar);
  for (const TracedView& traced : trace(scene, picture, view)) {
    int far_count = 0;
    for (size_t px = 0; px + 1 < traced.records.size(); ++px) {
      // At the edge px take part of each other's colour.
      const bool is_far = traced.records[px].inv_z < 0.5F && traced.records[px + 1].inv_z < 0.5F;
      if (!is_far || traced.records[px].ray_class != abi::kClassHit) continue;
      ++far_count;
      ASSERT_LE(worstOf(codesOf(traced, px), {0, 0, 255}), 1e-3) << "px " << px;
    }
    EXPECT_GT(far_count, 100);
  }
}

// A display that changes its px all the time, on a frame that stays, takes no more memory than two.
TEST_F(ColorMeanTest, keepsTheMeansOfTwoReachesAndMakesOthersAnew) {
  const auto frame = std::make_shared<Frame>(*frameOf(plane_));
  frame->sources[0][0].color = std::make_shared<std::vector<uint8_t>>(noise().rgba);
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frame);
  const auto show = [&](double footprint_px) {
    const oracle::OutputView view = coarseView(plane_, {footprint_px, footprint_px}, 0.3, kInvZ);
    return walk_.trace(*slot, {view}, kTolerance_px).front().srgb;
  };
  const auto first = show(2);
  show(3);
  const uint64_t held_bytes = gpuMemoryBytes();
  for (const double footprint_px : {4.0, 5.0, 6.0}) show(footprint_px);
  EXPECT_EQ(gpuMemoryBytes(), held_bytes);
  EXPECT_EQ(show(2), first);
}

struct Flicker {
  double mean_square = 0;  // of errors
  double mean_change = 0;  // of errors, from view to view
};

// Colours of a view that moves by 0.7 px of the source, against the light on all that its px cover:
// samples unchanged, each over its px.
TEST_F(ColorMeanTest, flickersLessThanSamplesDo) {
  const Picture picture = noise();
  constexpr Footprint kFootprint{4.6, 1.9};
  constexpr int kFine = 16;
  const auto truthAt = [&](double x_px, double y_px) {
    Codes sum{};
    for (int i = 0; i < kFine * kFine; ++i) {
      const double x = x_px + kFootprint.x_px * ((i % kFine + 0.5) / kFine - 0.5);
      const double y = y_px + kFootprint.y_px * ((i / kFine + 0.5) / kFine - 0.5);
      const Codes place =
          picture.at(std::clamp(int(x), 0, kWidth - 1), std::clamp(int(y), 0, kHeight - 1));
      for (size_t c = 0; c < 3; ++c) sum[c] += place[c] / (kFine * kFine);
    }
    return sum;
  };
  for (size_t method = 0; method < 2; ++method) {
    Flicker mean;
    Flicker samples;
    std::vector<double> before_mean;
    std::vector<double> before_samples;
    for (int step = 0; step < 4; ++step) {
      const oracle::OutputView view = coarseView(plane_, kFootprint, 8 + 0.7 * step, kInvZ);
      const TracedView traced = trace(plane_, picture, view)[method];
      std::vector<double> mean_errors;
      std::vector<double> sample_errors;
      for (size_t px = 0; px < traced.records.size(); ++px) {
        const abi::RayRecord& record = traced.records[px];
        const Codes truth = truthAt(record.x_px, record.y_px);
        const Codes sampled = between(record.x_px, record.y_px,
                                      [&](int column, int row) { return picture.at(column, row); });
        mean_errors.push_back(codesOf(traced, px)[0] - truth[0]);
        sample_errors.push_back(sampled[0] - truth[0]);
      }
      const auto add = [](const std::vector<double>& errors, std::vector<double>& before,
                          Flicker& flicker) {
        for (size_t i = 0; i < errors.size(); ++i) {
          flicker.mean_square += errors[i] * errors[i] / double(errors.size());
          if (!before.empty()) {
            flicker.mean_change += std::abs(errors[i] - before[i]) / double(errors.size());
          }
        }
        before = errors;
      };
      add(mean_errors, before_mean, mean);
      add(sample_errors, before_samples, samples);
    }
    std::cout << "errors " << std::sqrt(mean.mean_square / 4) << ", of samples "
              << std::sqrt(samples.mean_square / 4) << "; flicker " << mean.mean_change / 3
              << ", of samples " << samples.mean_change / 3 << "\n";
    // Half as much, in light and in change: 6 dB.
    EXPECT_LT(mean.mean_square, samples.mean_square / 4);
    EXPECT_LT(mean.mean_change, samples.mean_change / 2);
  }
}

}  // namespace
}  // namespace viewloom::color_mean_test
