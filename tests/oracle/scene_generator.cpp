// SPDX-License-Identifier: Apache-2.0
#include "oracle/scene_generator.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace viewloom::oracle {
namespace {

// kappa_rel of a source that does not state its tolerance (shaders/structure.md, Links).
constexpr float kMeasuredKappaRelative = 0.02f;

// inv_z in 1/m at a sample, kNoSurface where the sheet has a gap.
using Sheet = std::function<double(int column, int row)>;

constexpr std::pair<int, int> kSizes[] = {{1, 1},   {1, 7},   {7, 1},   {2, 2},    {5, 3},
                                          {17, 9},  {33, 65}, {64, 64}, {100, 37}, {31, 32},
                                          {65, 16}, {128, 3}, {16, 16}, {63, 129}};

Sheet ramp(Random& random, double middle, double strength, int width, int height) {
  const double slope_x = random.uniform(-1, 1) * strength * middle / width;
  const double slope_y = random.uniform(-1, 1) * strength * middle / height;
  return [=](int column, int row) {
    return middle + slope_x * (column - 0.5 * width) + slope_y * (row - 0.5 * height);
  };
}

Sheet curved(Random& random, double middle, int width, int height) {
  const double waves_x = random.uniform(0.2, 2), waves_y = random.uniform(0.2, 2);
  const double phase = random.uniform(0, 6);
  const double height_of_waves = random.uniform(0.02, 0.2) * middle;
  return [=](int column, int row) {
    return middle + height_of_waves * std::sin(phase + waves_x * 6.3 * column / width) *
                        std::cos(waves_y * 6.3 * row / height);
  };
}

Sheet steps(Random& random, double middle, int width) {
  const int step_px = random.integer(1, std::max(1, width / 3));
  const double rise = random.uniform(-0.2, 0.2) * middle;
  return [=](int column, int) { return std::max(0.01, middle + rise * (column / step_px % 4)); };
}

Sheet checkerboard(Random& random, double middle) {
  const int cell_px = random.integer(1, 3);
  const double other = middle * random.uniform(0.5, 1.5);
  return [=](int column, int row) {
    return (column / cell_px + row / cell_px) % 2 == 0 ? middle : other;
  };
}

Sheet sawTeeth(Random& random, double middle) {
  const int tooth_px = random.integer(2, 9);
  const double rise = random.uniform(-0.1, 0.1) * middle;
  const bool along_rows = random.chance(0.5);
  return
      [=](int column, int row) { return middle + rise * ((along_rows ? column : row) % tooth_px); };
}

Sheet poles(Random& random, double middle) {
  const int distance_px = random.integer(3, 12), width_px = random.integer(1, 2);
  const int offset_px = random.integer(0, 11);
  const bool upright = random.chance(0.7);
  return [=](int column, int row) {
    return ((upright ? column : row) + offset_px) % distance_px < width_px ? middle : kNoSurface;
  };
}

Sheet discs(Random& random, Sheet inside, int width, int height) {
  const double x = random.uniform(0, width), y = random.uniform(0, height);
  const double radius = random.uniform(0.1, 0.6) * std::max(2, std::min(width, height));
  return [=](int column, int row) {
    return std::hypot(column - x, row - y) < radius ? inside(column, row) : double{kNoSurface};
  };
}

Sheet sky() {
  return [](int, int) { return 0.0; };
}

// The base of a scene: something in (almost) every column.
std::pair<std::string, Sheet> backdrop(Random& random, int width, int height) {
  const double middle = random.uniform(0.05, 0.5);
  switch (random.integer(0, 6)) {
    case 0:
      return {"ramp", ramp(random, middle, 0.3, width, height)};
    case 1:
      return {"slant", ramp(random, middle, 1.6, width, height)};
    case 2:
      return {"curve", curved(random, middle, width, height)};
    case 3:
      return {"steps", steps(random, middle, width)};
    case 4:
      return {"checkerboard", checkerboard(random, middle)};
    case 5:
      return {"saw", sawTeeth(random, middle)};
    default:
      return {"sky", sky()};
  }
}

std::pair<std::string, Sheet> foreground(Random& random, int width, int height) {
  const double middle = random.uniform(0.4, 2);
  switch (random.integer(0, 3)) {
    case 0:
      return {"poles", poles(random, middle)};
    case 1:
      return {"flat disc", discs(random, ramp(random, middle, 0, width, height), width, height)};
    case 2:
      return {"slanted disc", discs(random, ramp(random, middle, 2, width, height), width, height)};
    default:
      return {"curved disc", discs(random, curved(random, middle, width, height), width, height)};
  }
}

void addSheet(Scene& scene, const std::string& name, const Sheet& sheet,
              std::vector<std::vector<float>>& columns) {
  scene.name += name + ' ';
  for (int row = 0; row < scene.planes.height; ++row) {
    for (int column = 0; column < scene.planes.width; ++column) {
      const double inv_z = sheet(column, row);
      if (inv_z < 0) continue;
      columns[size_t(row) * size_t(scene.planes.width) + size_t(column)].push_back(float(inv_z));
    }
  }
}

void disturb(Scene& scene, Random& random, std::vector<std::vector<float>>& columns) {
  const bool with_noise = random.chance(0.35), with_holes = random.chance(0.3);
  const double sigma = std::exp(random.uniform(-9, -3));
  const double hole_share = random.uniform(0.01, 0.4);
  if (with_noise) scene.name += "noise ";
  if (with_holes) scene.name += "holes ";
  for (std::vector<float>& column : columns) {
    for (float& inv_z : column) {
      if (with_noise && inv_z > 0) inv_z = float(std::max(0.0, inv_z + sigma * random.normal()));
      if (with_holes && random.chance(hole_share)) inv_z = kNoSurface;
    }
  }
}

// The nearest surfaces of each column, some columns in disorder and with gaps when asked for.
void fillLayers(Scene& scene, Random& random, std::vector<std::vector<float>>& columns) {
  const bool unsorted = random.chance(0.25);
  if (unsorted) scene.name += "unsorted ";
  const int layer_count = scene.planes.layer_count;
  for (size_t index = 0; index < columns.size(); ++index) {
    std::vector<float>& column = columns[index];
    std::sort(column.begin(), column.end(), std::greater<>());
    column.resize(size_t(layer_count), kNoSurface);
    if (unsorted && random.chance(0.5)) {
      std::swap(column.front(), column[size_t(random.integer(0, layer_count - 1))]);
    }
    const int width = scene.planes.width;
    for (int layer = 0; layer < layer_count; ++layer) {
      scene.planes.at(layer, int(index) % width, int(index) / width) = column[size_t(layer)];
    }
  }
}

Pinhole randomPinhole(Random& random, int width, int height) {
  const double focal = random.uniform(0.7, 2) * std::max({width, height, 4});
  return {{focal, focal * random.uniform(0.9, 1.1)},
          {width * random.uniform(0.3, 0.7), height * random.uniform(0.3, 0.7)}};
}

}  // namespace

uint64_t Random::bits() {  // SplitMix64 (Steele, Lea, Flood 2014)
  uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Random::uniform(double low, double high) {
  return low + (high - low) * std::ldexp(double(bits() >> 11), -53);
}

int Random::integer(int low, int high) {
  return low + int(bits() % uint64_t(high - low + 1));
}

double Random::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
  return radius * std::cos(2 * std::numbers::pi * uniform(0, 1));
}

Scene randomScene(uint64_t seed) {
  Random random(seed);
  const auto [width, height] = kSizes[size_t(seed) % std::size(kSizes)];
  return randomScene(random.bits(), width, height, 1 + int(seed / std::size(kSizes)) % 4);
}

Scene randomScene(uint64_t seed, int width, int height, int layer_count) {
  Random random(seed);
  Scene scene{"", makePlanes(width, height, layer_count), randomPinhole(random, width, height), {}};
  std::vector<std::vector<float>> columns(size_t(width) * size_t(height));
  const auto [backdrop_name, backdrop_sheet] = backdrop(random, width, height);
  addSheet(scene, backdrop_name, backdrop_sheet, columns);
  for (int count = random.integer(0, layer_count); count > 0; --count) {
    const auto [name, sheet] = foreground(random, width, height);
    addSheet(scene, name, sheet, columns);
  }
  disturb(scene, random, columns);
  fillLayers(scene, random, columns);
  if (random.chance(0.5)) {
    scene.kappa = {float(random.uniform(0.0005, 0.05)), 0};
  } else {
    scene.kappa = {1e-4f, kMeasuredKappaRelative};
  }
  return scene;
}

Scene smoothScene(int width, int height, int layer_count) {
  Scene scene{
      "smooth", makePlanes(width, height, layer_count), {}, {1e-4f, kMeasuredKappaRelative}};
  scene.pinhole = {{1.2 * width, 1.2 * width}, {0.5 * width, 0.5 * height}};
  for (int layer = 0; layer < layer_count; ++layer) {
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const double x = (column + 0.5) / width, y = (row + 0.5) / height;
        const double inv_z = 0.5 + 0.05 * x * x + 0.03 * std::sin(3 * y) + 0.1 * x * y;
        scene.planes.at(layer, column, row) = float(inv_z / (1 + 0.5 * layer));
      }
    }
  }
  return scene;
}

Scene coarseScene(uint64_t seed, int width, int height, int layer_count) {
  constexpr float kStep = 1.0f / 200;
  constexpr double kSigma = 1.0 / 150;
  Random random(seed);
  Scene scene = smoothScene(width, height, layer_count);
  const bool is_noisy = seed % 2 == 1;
  scene.name = is_noisy ? "noisy" : "rounded";
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const bool is_block = column / 24 % 3 == 1 && row / 16 % 2 == 1;
      const bool is_close = column / 40 % 2 == 1;
      for (int layer = 0; layer < layer_count; ++layer) {
        float& inv_z = scene.planes.at(layer, column, row);
        if (is_close) inv_z = scene.planes.at(0, column, row) - float(layer) * 1.5f * kStep;
      }
      if (is_block) scene.planes.at(0, column, row) += 0.2f;
      for (int layer = 0; layer < layer_count; ++layer) {
        float& inv_z = scene.planes.at(layer, column, row);
        inv_z =
            is_noisy ? inv_z + float(kSigma * random.normal()) : std::round(inv_z / kStep) * kStep;
        if (random.chance(0.002)) inv_z = kNoSurface;
      }
    }
  }
  return scene;
}

}  // namespace viewloom::oracle
