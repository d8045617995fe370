// SPDX-License-Identifier: Apache-2.0
// Step and noise as inspect measures them, against what the server reports of the same frame.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "inspect/measure_depth.h"
#include "sweep/measure_columns.h"
#include "unit/inspect/depth_planes.h"

namespace viewloom::inspect::server_measures_test {
namespace {

using test::depthPlane;
using test::DepthPlane;

constexpr uint32_t kWidth = 321, kHeight = 203;

SourceStats serverStats(const DepthPlane& made, PlaneEncoding encoding, double scale) {
  Frame frame;
  SourceFormat& source = frame.format.sources.emplace_back();
  source.camera.intrinsics = {{100, 100}, {160, 100}};
  LayerFormat& layer = source.layers.emplace_back();
  layer.depth.kind = PlaneKind::kDepth;
  layer.depth.encoding = encoding;
  layer.depth.size_px = {kWidth, kHeight};
  layer.depth.depth.meaning = DepthMeaning::kDisparity;
  layer.depth.depth.scale = scale;
  LayerPlanes& planes = frame.sources.emplace_back().emplace_back();
  planes.depth = std::make_shared<const std::vector<uint8_t>>(made.bytes);
  DepthColumns columns;
  columns.beginFrame(frame);
  const ColumnCounts counts = columns.prepareRows(0, kHeight);
  ColumnHistograms histograms;
  for (uint32_t row = 0; 4 * row < kHeight; ++row) histograms.addBlockRow(columns, row);
  RangeHistogram range{settleRange(histograms)};
  for (uint32_t row = 0; 4 * row < kHeight; ++row) range.addBlockRow(columns, row);
  return settleColumns(histograms, range, counts, kWidth, 0).stats;
}

void expectTheSame(const DepthPlane& made, PlaneEncoding encoding, double scale) {
  DepthPlane scaled = made;
  scaled.plane.mutable_depth()->set_scale(scale);
  const auto samples = readDepthSamples(scaled.plane, scaled.bytes, {});
  ASSERT_TRUE(samples.ok()) << samples.status();
  const DepthMeasures measures = measureDepth(*samples);
  const SourceStats stats = serverStats(made, encoding, scale);
  // The server's bins are a sixteenth of an octave, of which it takes the end.
  EXPECT_GE(stats.depth_step, measures.step * 0.999);
  EXPECT_LE(stats.depth_step, measures.step * 1.07);
  EXPECT_GE(stats.noise_sigma, measures.noise_sigma * 0.999);
  EXPECT_LE(stats.noise_sigma, measures.noise_sigma * 1.07);
  EXPECT_EQ(stats.inv_z_min, measures.inv_z_min);
  EXPECT_EQ(stats.inv_z_max, measures.inv_z_max);
  EXPECT_EQ(stats.bad_samples_count, samples->bad_count);
}

TEST(ServerMeasures, areThoseOfCodes) {
  expectTheSame(depthPlane<uint16_t>(kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY,
                                     [](uint32_t x, uint32_t y) {
                                       return uint16_t(900 + std::lround(0.31 * x + 0.17 * y));
                                     }),
                PlaneEncoding::kDepthU16, 0.001);
}

TEST(ServerMeasures, areThoseOfNoise) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.004F);
  expectTheSame(depthPlane<float>(kWidth, kHeight, v1::DEPTH_MEANING_DISPARITY,
                                  [&](uint32_t x, uint32_t y) {
                                    if (x == 7 && y == 9) return -1.0F;
                                    return 0.5F + 0.001F * float(x) + noise(random);
                                  }),
                PlaneEncoding::kDepthF32, 1);
}

}  // namespace
}  // namespace viewloom::inspect::server_measures_test
