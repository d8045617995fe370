// SPDX-License-Identifier: Apache-2.0
// The columns of a source as the sweep prepares them, beside those of the device.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <map>

#include <glm/gtc/packing.hpp>

#include "gpu/column_tolerance.h"
#include "gpu/walk_under_test.h"
#include "oracle/scene_generator.h"
#include "support/test_device.h"
#include "sweep/depth_columns.h"
#include "sweep/sweep_source.h"

namespace viewloom::columns_test {
namespace {

// Both sides odd: rows end within a vector, planes of 2-byte samples within a word.
constexpr SizePx kSize_px{61, 23};
constexpr Intrinsics kIntrinsics{{60, 63}, {28, 12}};

template <typename Sample>
SharedBytes packed(const std::vector<Sample>& samples) {
  std::vector<uint8_t> bytes(samples.size() * sizeof(Sample));
  std::memcpy(bytes.data(), samples.data(), bytes.size());
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

// A slanted, stepped surface, 1/m: one layer behind another, now and then one before the last.
double surfaceInvZ(oracle::Random& random, uint32_t index, uint32_t layer) {
  const uint32_t x = index % kSize_px.width;
  const double base = 0.9 + 0.004 * x + (x % 20 < 7 ? 0.3 : 0) - 0.2 * layer;
  return base + random.uniform(-0.02, 0.02) + (random.chance(0.06) ? 0.5 : 0);
}

DepthFormat formatOf(DepthMeaning meaning, PlaneEncoding encoding) {
  DepthFormat format{.meaning = meaning};
  const bool is_metric = meaning == DepthMeaning::kPlanar || meaning == DepthMeaning::kRayDistance;
  if (encoding == PlaneEncoding::kDepthU16 && meaning != DepthMeaning::kWindow) {
    format.scale = is_metric ? 0.001 : 1.0 / 40000;
  }
  // Near planes that nearly coincide could be sorted either way.
  format.near_z_m = encoding == PlaneEncoding::kDepthU16 ? 0.4 : 0.3;
  format.far_z_m = 40;
  if (is_metric) format.invalid_value = 7;
  format.invalid_is_far = is_metric && encoding == PlaneEncoding::kDepthF32;
  return format;
}

// The number that stands for a surface, as stored.
double sampleOf(const DepthFormat& format, PlaneEncoding encoding, double inv_z) {
  switch (format.meaning) {
    case DepthMeaning::kWindow: {
      const double share =
          (1 / format.near_z_m - inv_z) / (1 / format.near_z_m - 1 / format.far_z_m);
      return encoding == PlaneEncoding::kDepthU16 ? 65535 * share : share;
    }
    case DepthMeaning::kDisparity:
      return inv_z / format.scale;
    default:
      return 1 / inv_z / format.scale;
  }
}

SharedBytes samplesOf(oracle::Random& random, const DepthFormat& format, PlaneEncoding encoding,
                      uint32_t layer) {
  constexpr double kOdd[] = {0,
                             -1,
                             7,
                             std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(),
                             1e-12,
                             65535};
  std::vector<float> samples;
  for (uint32_t index = 0; index < kSize_px.area(); ++index) {
    const double sample = sampleOf(format, encoding, surfaceInvZ(random, index, layer));
    samples.push_back(float(random.chance(0.1) ? kOdd[random.integer(0, 6)] : sample));
    if (index % 97 == 5) samples.back() = -std::numeric_limits<float>::infinity();
    if (index % 89 == 7) samples.back() = -0.0F;
  }
  if (encoding == PlaneEncoding::kDepthF32) return packed(samples);
  std::vector<uint16_t> words;
  for (const float sample : samples) {
    const bool fits = sample >= 0 && sample <= 65535;
    words.push_back(encoding == PlaneEncoding::kDepthF16 ? glm::packHalf1x16(sample)
                                                         : uint16_t(fits ? sample : 0));
  }
  return packed(words);
}

struct LayerKind {
  DepthMeaning meaning;
  PlaneEncoding encoding;
};

FramePtr frameOfLayers(oracle::Random& random, const std::vector<LayerKind>& layers) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  SourceFormat& source = frame->format.sources.emplace_back();
  source.camera.intrinsics = kIntrinsics;
  std::vector<LayerPlanes>& planes = frame->sources.emplace_back();
  for (const LayerKind& kind : layers) {
    LayerFormat& format = source.layers.emplace_back();
    format.color.size_px = kSize_px;
    format.depth.kind = PlaneKind::kDepth;
    format.depth.encoding = kind.encoding;
    format.depth.size_px = kSize_px;
    format.depth.depth = formatOf(kind.meaning, kind.encoding);
    const uint32_t layer = uint32_t(planes.size());
    planes.push_back(
        {.color = std::make_shared<const std::vector<uint8_t>>(kSize_px.area() * 4, uint8_t{255}),
         .depth = samplesOf(random, format.depth.depth, kind.encoding, layer)});
  }
  return frame;
}

// `share_max`: 0 where the samples are the same, to the bit.
void expectSameStats(const SourceStats& swept, const SourceStats& device, double share_max) {
  EXPECT_EQ(swept.bad_samples_count, device.bad_samples_count);
  EXPECT_EQ(swept.unsorted_columns_count, device.unsorted_columns_count);
  const auto expectClose = [&](double a, double b, const char* name) {
    EXPECT_NEAR(a, b, std::abs(b) * share_max) << name;
  };
  expectClose(swept.depth_step, device.depth_step, "depth_step");
  expectClose(swept.noise_sigma, device.noise_sigma, "noise_sigma");
  expectClose(swept.connection_tolerance, device.connection_tolerance, "connection_tolerance");
  expectClose(swept.smoothing_reach, device.smoothing_reach, "smoothing_reach");
  expectClose(swept.inv_z_near, device.inv_z_near, "inv_z_near");
  expectClose(swept.inv_z_far, device.inv_z_far, "inv_z_far");
}

uint64_t pxCount(const DepthSpread& spread) {
  uint64_t count = 0;
  for (const DepthBin& bin : spread) count += bin.count;
  return count;
}

// A sample that is rounded differently may lie on the other side of a bin's edge: that many do.
void expectSameSpread(const DepthSpread& swept, const DepthSpread& device, double moved_share_max) {
  EXPECT_EQ(pxCount(swept), pxCount(device));
  std::map<double, int64_t> moved;
  for (const DepthBin& bin : swept) moved[bin.inv_z_low] += bin.count;
  for (const DepthBin& bin : device) moved[bin.inv_z_low] -= bin.count;
  int64_t moved_count = 0;
  for (const auto& [inv_z_low, count] : moved) moved_count += std::abs(count);
  EXPECT_LE(double(moved_count), moved_share_max * double(pxCount(device)));
}

// The sweep's are of samples, the device's of planes over their footprints.
void expectRangeInside(const SourceStats& swept, const SourceStats& device,
                       const ColumnTolerance& tolerance) {
  const auto slack = [&](double inv_z) { return inv_z * kStatsShare + tolerance.at(inv_z); };
  EXPECT_GE(swept.inv_z_min, device.inv_z_min - slack(device.inv_z_min));
  EXPECT_LE(swept.inv_z_max, device.inv_z_max + slack(device.inv_z_max));
}

class ColumnsTest : public GpuTest {
 protected:
  void expectTheDevices(const FramePtr& frame) {
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frame);
    const StructureImage image = walk_.readBack(*slot);
    source_.prepare(frame, workers_);
    tolerance_ = toleranceOf(*frame, source_.measured().smoothing, device().info().is_software);
    const bool is_exact = tolerance_.share == 0;
    const DepthColumns& columns = *source_.rowSource().columns;
    swept_min_ = std::numeric_limits<float>::max();
    swept_max_ = abi::kNoSurface;
    ASSERT_EQ(columns.layerCount(), image.layers.size());
    for (uint32_t layer = 0; layer < columns.layerCount(); ++layer) {
      for (int y = 0; y < image.height; ++y) expectRow(columns, image, layer, y);
    }
    EXPECT_EQ(source_.measured().stats.inv_z_max, std::max(swept_max_, 0.0F));
    EXPECT_EQ(source_.measured().stats.inv_z_min, swept_max_ < 0 ? 0.0F : swept_min_);
    expectRangeInside(source_.measured().stats, slot->stats(), tolerance_);
    expectSameStats(source_.measured().stats, slot->stats(), is_exact ? 0 : kStatsShare);
    expectSameSpread(source_.measured().depths, slot->depthSpread(), is_exact ? 0 : 0.01);
    bad_count_ += slot->stats().bad_samples_count;
    unsorted_count_ += slot->stats().unsorted_columns_count;
  }

  void expectRow(const DepthColumns& columns, const StructureImage& image, uint32_t layer, int y) {
    const float* const row = columns.row(layer, y);
    const float* const expected = &image.layers[layer].inv_z[size_t(y) * size_t(image.width)];
    for (int x = 0; x < image.width; ++x) {
      ASSERT_TRUE(tolerance_.holds(row[x], expected[x]))
          << "layer " << layer << " px (" << x << ", " << y << "): " << row[x] << ", on the device "
          << expected[x] << ", apart "
          << (double{row[x]} - double{expected[x]}) / (kUlp * double{row[x]}) << " ulp";
      rounded_count_ += row[x] != expected[x];
      if (row[x] >= 0) swept_min_ = std::min(swept_min_, row[x]);
      swept_max_ = std::max(swept_max_, row[x]);
      ++sample_count_;
    }
    EXPECT_EQ(row[-1], abi::kNoSurface);
    EXPECT_EQ(row[image.width], abi::kNoSurface);
  }

  void printCounts() const {
    std::cout << sample_count_ << " samples, of which " << rounded_count_
              << " are rounded otherwise; " << bad_count_ << " bad, " << unsorted_count_
              << " columns unsorted\n";
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  WorkerPool workers_{2};
  SweepSource source_;         // its memory serves frames of every size and kind
  ColumnTolerance tolerance_;  // of the frame at hand
  float swept_min_ = 0;        // of the rows of a frame, 1/m
  float swept_max_ = 0;
  uint64_t sample_count_ = 0;
  uint64_t rounded_count_ = 0;
  uint64_t bad_count_ = 0;
  uint64_t unsorted_count_ = 0;
};

TEST_F(ColumnsTest, areTheDevicesOnScenesOfTheOracle) {
  for (uint64_t seed = 0; seed < 112; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + " " + scene.name);
    expectTheDevices(frameOf(scene));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(unsorted_count_, 0u);
  printCounts();
}

TEST_F(ColumnsTest, areTheDevicesWhereDepthIsCoarse) {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const oracle::Scene scene = oracle::coarseScene(seed, 201, 101, 1 + int(seed / 2));
    SCOPED_TRACE(scene.name);
    expectTheDevices(frameOf(scene));
    EXPECT_GT(source_.measured().stats.smoothing_reach, 0);
    if (HasFatalFailure()) return;
  }
  printCounts();
}

constexpr DepthMeaning kMeanings[] = {DepthMeaning::kPlanar, DepthMeaning::kRayDistance,
                                      DepthMeaning::kWindow, DepthMeaning::kDisparity};
constexpr PlaneEncoding kEncodings[] = {PlaneEncoding::kDepthF32, PlaneEncoding::kDepthF16,
                                        PlaneEncoding::kDepthU16};

TEST_F(ColumnsTest, areTheDevicesInEveryEncodingAndMeaning) {
  oracle::Random random(5);
  for (const DepthMeaning meaning : kMeanings) {
    for (const PlaneEncoding encoding : kEncodings) {
      for (const uint32_t layer_count : {1U, abi::kLayerCountMax}) {
        SCOPED_TRACE("meaning " + std::to_string(int(meaning)) + ", encoding " +
                     std::to_string(int(encoding)) + ", layers " + std::to_string(layer_count));
        expectTheDevices(
            frameOfLayers(random, std::vector(layer_count, LayerKind{meaning, encoding})));
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(bad_count_, 0u);
  EXPECT_GT(unsorted_count_, 0u);
  printCounts();
}

TEST_F(ColumnsTest, areTheDevicesWhereEncodingsMeet) {
  oracle::Random random(6);
  for (int frame = 0; frame < 24; ++frame) {
    std::vector<LayerKind> layers;
    std::string kinds = "frame " + std::to_string(frame) + ", meaning/encoding";
    for (int layer = 0; layer < 2 + frame % 3; ++layer) {
      const int meaning = random.integer(0, 3), encoding = random.integer(0, 2);
      layers.push_back({kMeanings[meaning], kEncodings[encoding]});
      kinds += " " + std::to_string(meaning) + "/" + std::to_string(encoding);
    }
    SCOPED_TRACE(kinds);
    expectTheDevices(frameOfLayers(random, layers));
    if (HasFatalFailure()) return;
  }
  printCounts();
}

}  // namespace
}  // namespace viewloom::columns_test
