// SPDX-License-Identifier: Apache-2.0
// A built-in animated scene as exact layered colour and depth from any camera, without a GPU.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "frame/camera.h"
#include "frame/size.h"
#include "synthetic/scene.h"

namespace viewloom {

struct SyntheticOptions {
  SizePx size_px{960, 540};
  uint32_t layer_count = 1;      // 1..4
  double time_s = 0;             // the same time gives the same bytes
  std::optional<Camera> camera;  // default: syntheticCamera(size_px)
  uint32_t thread_count = 0;     // 0 = processorCount()
  bool has_mirrors = false;      // some surfaces mirror; their own colour is then darker
  bool has_motion = false;       // says how surfaces move
  synthetic::Setting setting = synthetic::Setting::kBalls;
};

// Layer k holds, per pixel, the k-th camera-facing surface along the ray through the pixel's
// centre.
struct SyntheticLayer {
  std::vector<uint8_t> color;  // uint8_t[h][w][4], sRGB, opaque, top row first
  std::vector<float> depth_m;  // float[h][w], planar; +inf = sky; 0 = no such surface
  // With mirrors alone; else empty. As PLANE_ENCODING_OCT16, along the world's axes, R8 and RGB8.
  std::vector<uint32_t> normal;    // uint32_t[h][w]
  std::vector<uint8_t> roughness;  // uint8_t[h][w]
  std::vector<uint8_t> specular;   // uint8_t[h][w][3]
  // With motion alone; else empty. As PLANE_ENCODING_XYZ16F, m/s along the world's axes.
  std::vector<uint16_t> motion;  // uint16_t[h][w][3]
};

// Where the scenes are meant to be seen from: the origin, looking along -z, 36 degrees high. The
// surfaces of the balls lie 1.8..8 m away, the sky behind them. Those of the portrait scene lie
// 2..3.8 m away, within a window of 3:4.
Camera syntheticCamera(SizePx size_px);

// Any other camera gives the true picture from there. `layers` is overwritten; its memory is
// reused. Thread-safety: may be called from any thread; each call uses its own threads.
void renderSyntheticFrame(const SyntheticOptions& options, std::vector<SyntheticLayer>& layers);
std::vector<SyntheticLayer> renderSyntheticFrame(const SyntheticOptions& options);

}  // namespace viewloom
