// SPDX-License-Identifier: Apache-2.0
// Depth samples of every encoding and meaning, side by side in one source, against the reference.
#include <cmath>
#include <functional>
#include <limits>

#include <glm/gtc/packing.hpp>

#include "gpu/walk_under_test.h"
#include "support/depth_reference.h"
#include "support/test_device.h"

namespace viewloom::depth_encodings_test {
namespace {

// Both sides odd: planes of 2-byte samples end within a word.
constexpr SizePx kSize_px{13, 7};
constexpr Intrinsics kIntrinsics{{20, 21}, {6, 3}};
// Rounding of inv_z: sums, a quotient, a root and rounded coefficients, half an ulp each.
constexpr double kRounding = 8.0 / (1 << 23);

// One layer: samples as stored, by the number of the px.
struct Layer {
  PlaneEncoding encoding;
  DepthFormat format;
  std::function<double(uint32_t)> sample;
};

// From near to far, so that layers of one column keep their order. Millimetres are scattered: on a
// slope of few of them they would be coarse depth, which is smoothed.
const Layer kPlanarF32{PlaneEncoding::kDepthF32,
                       {.meaning = DepthMeaning::kPlanar, .invalid_value = -1.0},
                       [](uint32_t i) { return i % 7 == 3 ? -1.0 : 1 + 0.01 * i; }};
const Layer kRayU16{PlaneEncoding::kDepthU16,
                    {.meaning = DepthMeaning::kRayDistance, .scale = 0.001},
                    [](uint32_t i) { return i % 5 == 0 ? 0.0 : 3000 + i * i * i * 31 % 1999; }};
const Layer kDisparityF16{PlaneEncoding::kDepthF16,
                          {.meaning = DepthMeaning::kDisparity},
                          [](uint32_t i) { return i % 11 == 4 ? -0.5 : 0.1 + i / 1024.0; }};
const Layer kWindowU16{PlaneEncoding::kDepthU16,
                       {.meaning = DepthMeaning::kWindow,
                        .near_z_m = 20,
                        .far_z_m = std::numeric_limits<double>::infinity()},
                       [](uint32_t i) { return 20000 + 300.0 * i; }};

template <typename Sample, typename Convert>
SharedBytes packed(const Layer& layer, const Convert& convert) {
  std::vector<Sample> samples;
  for (uint32_t i = 0; i < kSize_px.area(); ++i) samples.push_back(convert(layer.sample(i)));
  const auto* bytes = reinterpret_cast<const uint8_t*>(samples.data());
  return std::make_shared<const std::vector<uint8_t>>(bytes,
                                                      bytes + samples.size() * sizeof(Sample));
}

SharedBytes packed(const Layer& layer) {
  switch (layer.encoding) {
    case PlaneEncoding::kDepthU16:
      return packed<uint16_t>(layer, [](double sample) { return uint16_t(sample); });
    case PlaneEncoding::kDepthF16:
      return packed<uint16_t>(layer,
                              [](double sample) { return glm::packHalf1x16(float(sample)); });
    default:
      return packed<float>(layer, [](double sample) { return float(sample); });
  }
}

// Sample as the encoding holds it.
double stored(const Layer& layer, uint32_t index) {
  const double sample = layer.sample(index);
  if (layer.encoding == PlaneEncoding::kDepthU16) return sample;
  if (layer.encoding == PlaneEncoding::kDepthF32) return double{float(sample)};
  return double{glm::unpackHalf1x16(glm::packHalf1x16(float(sample)))};
}

Frame frameOfLayers(const std::vector<Layer>& layers) {
  Frame frame;
  frame.format.number = 1;
  SourceFormat& source = frame.format.sources.emplace_back();
  source.camera.intrinsics = kIntrinsics;
  std::vector<LayerPlanes>& planes = frame.sources.emplace_back();
  for (const Layer& layer : layers) {
    LayerFormat& format = source.layers.emplace_back();
    format.depth.kind = PlaneKind::kDepth;
    format.depth.encoding = layer.encoding;
    format.depth.size_px = kSize_px;
    format.depth.depth = layer.format;
    format.color.size_px = kSize_px;
    planes.push_back(
        {.color = std::make_shared<const std::vector<uint8_t>>(kSize_px.area() * 4, uint8_t{255}),
         .depth = packed(layer)});
  }
  return frame;
}

class DepthEncodingsTest : public GpuTest {
 protected:
  void expectReference(const std::vector<Layer>& layers) {
    const std::unique_ptr<StructureSlot> slot = walk_.build(frameOfLayers(layers));
    const StructureImage image = walk_.readBack(*slot);
    uint32_t bad_count = 0;
    for (uint32_t index = 0; index < kSize_px.area(); ++index) {
      const glm::uvec2 pixel_px{index % kSize_px.width, index / kSize_px.width};
      std::vector<double> column;
      for (const Layer& layer : layers) {
        const DepthValue value = linearizeDepth(layer.format, layer.encoding, stored(layer, index),
                                                pixel_px, kIntrinsics);
        if (value.kind == DepthClass::kSurface) column.push_back(value.inv_z);
        bad_count += value.kind == DepthClass::kBad;
      }
      column.resize(layers.size(), double{abi::kNoSurface});
      for (size_t i = 0; i < layers.size(); ++i) {
        EXPECT_NEAR(image.layers[i].inv_z[index], column[i], std::abs(column[i]) * kRounding)
            << "layer " << i << " px " << index;
      }
    }
    EXPECT_EQ(slot->stats().bad_samples_count, bad_count);
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
};

TEST_F(DepthEncodingsTest, areTheReferencesAlone) {
  for (const Layer& layer : {kPlanarF32, kRayU16, kDisparityF16, kWindowU16}) {
    expectReference({layer});
  }
}

TEST_F(DepthEncodingsTest, areTheReferencesSideBySide) {
  expectReference({kPlanarF32, kRayU16, kDisparityF16, kWindowU16});
}

// 0.9996 m rounds to 1.000 m: the same surface.
TEST_F(DepthEncodingsTest, aSurfaceInTwoEncodingsIsOne) {
  const Layer fine{PlaneEncoding::kDepthF32, {.meaning = DepthMeaning::kPlanar}, [](uint32_t) {
                     return 0.9996;
                   }};
  const Layer coarse{PlaneEncoding::kDepthU16,
                     {.meaning = DepthMeaning::kPlanar, .scale = 0.001},
                     [](uint32_t) { return 1000.0; }};
  const std::unique_ptr<StructureSlot> slot = walk_.build(frameOfLayers({fine, coarse}));
  const StructureImage image = walk_.readBack(*slot);
  for (const float inv_z : image.layers[1].inv_z) {
    EXPECT_EQ(inv_z, abi::kNoSurface);
  }
}

}  // namespace
}  // namespace viewloom::depth_encodings_test
