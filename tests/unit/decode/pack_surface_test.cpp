// SPDX-License-Identifier: Apache-2.0
#include "decode/pack_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "decode/frame_decoder.h"
#include "frame/limits.h"
#include "shared/surface_abi.h"

namespace viewloom::pack_surface_test {
namespace {

using Bytes = std::vector<uint8_t>;

// Half a step of the octahedron along both axes, where it lies furthest from the sphere.
constexpr double kApart = 7e-5;

SharedBytes shared(Bytes bytes) {
  return std::make_shared<const Bytes>(std::move(bytes));
}

// Decodes a normal as the proto defines it, by another way than the server's: the corners are
// folded over the edges.
glm::dvec3 decodedNormal(uint32_t texel) {
  const double u = 2.0 * (texel & 0xffff) / 65535 - 1;
  const double v = 2.0 * (texel >> 16) / 65535 - 1;
  const double beyond = std::abs(u) + std::abs(v) - 1;
  if (beyond <= 0) return glm::normalize(glm::dvec3(u, v, -beyond));
  return glm::normalize(glm::dvec3(std::copysign(std::abs(u) - beyond, u),
                                   std::copysign(std::abs(v) - beyond, v), -beyond));
}

LayerFormat layerOf(SizePx size_px, PlaneEncoding normal, PlaneEncoding specular) {
  const auto plane = [&](PlaneKind kind, PlaneEncoding encoding) {
    return PlaneFormat{.kind = kind, .encoding = encoding, .size_px = size_px, .depth = {}};
  };
  return {.color = plane(PlaneKind::kColor, PlaneEncoding::kRgba8),
          .depth = plane(PlaneKind::kDepth, PlaneEncoding::kDepthF32),
          .others = {plane(PlaneKind::kNormal, normal),
                     plane(PlaneKind::kRoughness, PlaneEncoding::kR8),
                     plane(PlaneKind::kSpecular, specular)}};
}

std::vector<abi::SurfaceTexel> packed(const LayerFormat& layer, const SurfacePlanes& planes,
                                      uint64_t& bad_count, const glm::dquat& turn = {1, 0, 0, 0}) {
  BytePool pool(1);
  LayerPlanes to;
  addSurface(layer, planes, turn, pool, to);
  bad_count = to.bad_normals_count;
  std::vector<abi::SurfaceTexel> texels(to.surface->size() / sizeof(abi::SurfaceTexel));
  std::memcpy(texels.data(), to.surface->data(), to.surface->size());
  return texels;
}

void addHalf(float value, Bytes& bytes) {
  const uint16_t half = glm::packHalf1x16(value);
  bytes.push_back(uint8_t(half));
  bytes.push_back(uint8_t(half >> 8));
}

TEST(PackSurface, keepsEveryDirection) {
  constexpr uint32_t kCount = 500;
  std::mt19937 random(3);
  std::normal_distribution<float> spread;
  Bytes normals;
  std::vector<glm::dvec3> sent;
  for (uint32_t i = 0; i < kCount; ++i) {
    // Normals may have any length.
    const glm::vec3 normal(spread(random), spread(random), spread(random));
    for (int c = 0; c < 3; ++c) addHalf(normal[c], normals);
    glm::dvec3 stored;
    for (int c = 0; c < 3; ++c) {
      stored[c] =
          glm::unpackHalf1x16(uint16_t(normals[6 * i + 2 * c] | normals[6 * i + 2 * c + 1] << 8));
    }
    sent.push_back(glm::normalize(stored));
  }
  const LayerFormat layer = layerOf({kCount, 1}, PlaneEncoding::kXyz16f, PlaneEncoding::kR8);
  uint64_t bad_count = 0;
  const SurfacePlanes planes{shared(normals), shared(Bytes(kCount)), shared(Bytes(kCount))};
  const auto same = packed(layer, planes, bad_count);
  EXPECT_EQ(bad_count, 0u);
  LayerFormat in_world = layer;
  in_world.others[0].normal_space = NormalSpace::kWorld;
  const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, -1)));
  const auto turned = packed(in_world, planes, bad_count, turn);
  for (uint32_t i = 0; i < kCount; ++i) {
    EXPECT_LT(glm::distance(decodedNormal(same[i].normal), sent[i]), kApart);
    EXPECT_LT(glm::distance(decodedNormal(turned[i].normal), glm::inverse(turn) * sent[i]), kApart);
  }
}

TEST(PackSurface, handsOctahedraOnAsTheyAre) {
  const Bytes normals = {0x34, 0x12, 0x78, 0x96, 0xff, 0xff, 0x00, 0x80};
  const LayerFormat layer = layerOf({2, 1}, PlaneEncoding::kOct16, PlaneEncoding::kR8);
  uint64_t bad_count = 0;
  const auto texels =
      packed(layer, {shared(normals), shared(Bytes(2)), shared(Bytes(2))}, bad_count);
  EXPECT_LT(glm::distance(decodedNormal(texels[0].normal), decodedNormal(0x96781234)), kApart);
  EXPECT_LT(glm::distance(decodedNormal(texels[1].normal), decodedNormal(0x8000ffff)), kApart);
}

TEST(PackSurface, countsNormalsWithoutALength) {
  Bytes normals;
  for (const float x : {0.0F, 1.0F, std::nanf(""), HUGE_VALF, 0.01F}) {
    for (const float value : {x, 0.0F, 0.0F}) addHalf(value, normals);
  }
  const LayerFormat layer = layerOf({5, 1}, PlaneEncoding::kXyz16f, PlaneEncoding::kR8);
  uint64_t bad_count = 0;
  const auto texels =
      packed(layer, {shared(normals), shared(Bytes(5)), shared(Bytes(5))}, bad_count);
  EXPECT_EQ(bad_count, 4u);
  for (const int i : {0, 2, 3, 4}) EXPECT_EQ(texels[i].normal, abi::kNoNormal);
  EXPECT_NE(texels[1].normal, abi::kNoNormal);

  const LayerFormat bytes = layerOf({2, 1}, PlaneEncoding::kXyz8, PlaneEncoding::kR8);
  const Bytes middle = {128, 127, 128, 128, 128, 0};
  const auto of_bytes =
      packed(bytes, {shared(middle), shared(Bytes(2)), shared(Bytes(2))}, bad_count);
  EXPECT_EQ(bad_count, 1u);
  EXPECT_EQ(of_bytes[0].normal, abi::kNoNormal);
  // Away from the eye: one of the four corners that all mean that, and not the one of nothing.
  EXPECT_LT(glm::distance(decodedNormal(of_bytes[1].normal), glm::dvec3(0, 0, -1)), 0.01);
  EXPECT_NE(of_bytes[1].normal, abi::kNoNormal);
}

TEST(PackSurface, keepsWhatIsMirroredAndHowRough) {
  const LayerFormat color = layerOf({2, 1}, PlaneEncoding::kOct16, PlaneEncoding::kRgba8);
  uint64_t bad_count = 0;
  const auto texels =
      packed(color, {nullptr, shared({7, 255}), shared({1, 2, 3, 99, 40, 50, 60, 99})}, bad_count);
  EXPECT_EQ(texels[0].light, 0x07030201u);
  EXPECT_EQ(texels[1].light, 0xff3c3228u);
  EXPECT_EQ(texels[0].normal, abi::kNoNormal);
  const LayerFormat grey = layerOf({2, 1}, PlaneEncoding::kOct16, PlaneEncoding::kR8);
  EXPECT_EQ(packed(grey, {nullptr, nullptr, shared({8, 9})}, bad_count)[1].light, 0x00090909u);
}

TEST(PackSurface, comesFromPlanesInAnyOrderAfterColorAndDepth) {
  LayerFormat layer = layerOf({1, 1}, PlaneEncoding::kXyz8, PlaneEncoding::kRgb8);
  std::reverse(layer.others.begin(), layer.others.end());
  BytePool pool(4);
  FrameDecoder decoder(pool);
  const auto decoded = [&] {
    CollectedFrame frame{.format = {.number = 1, .sources = {{.layers = {layer}}}}, .planes = {}};
    frame.planes = {shared({1, 2, 3, 255}), shared(Bytes(4)), shared({10, 20, 30}), shared({5}),
                    shared({128, 128, 255})};
    return decoder.decode(std::move(frame));
  };
  const auto frame = decoded();
  ASSERT_TRUE(frame.ok()) << frame.status();
  const SharedBytes& surface = (*frame)->sources[0][0].surface;
  ASSERT_EQ(surface->size(), size_t{kSurfaceTexelBytes});
  EXPECT_EQ((Bytes(surface->begin() + 4, surface->end())), (Bytes{10, 20, 30, 5}));

  layer.color_has_reflections = true;  // nothing is added
  EXPECT_EQ((*decoded())->sources[0][0].surface, nullptr);
}

}  // namespace
}  // namespace viewloom::pack_surface_test
