// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/test_loads.h"

#include <algorithm>
#include <cstring>

#include "gpu/walk_under_test.h"

namespace viewloom::bench {
namespace {

std::shared_ptr<const AtlasLayout> rowOf(const std::vector<oracle::OutputView>& views) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->columns = uint32_t(views.size());
  layout->tile_size_px = {uint32_t(views.front().width), uint32_t(views.front().height)};
  layout->size_px = {layout->columns * layout->tile_size_px.width, layout->tile_size_px.height};
  for (const oracle::OutputView& view : views) {
    layout->views.push_back({{{view.position_m, view.orientation},
                              {view.pinhole.focal_px, view.pinhole.principal_px}}});
  }
  return layout;
}

LoadSource sourceOf(const oracle::Scene& scene, oracle::Random& random) {
  const oracle::InvZPlanes planes = oracle::canonicalPlanes(scene.planes);
  LoadSource source;
  source.size_px = {uint32_t(planes.width), uint32_t(planes.height)};
  source.kappa = {.least = scene.kappa.absolute, .share = scene.kappa.relative};
  source.inv_z_max = *std::max_element(planes.inv_z.begin(), planes.inv_z.end());
  const ptrdiff_t area = ptrdiff_t(source.size_px.area());
  for (int layer = 0; layer < planes.layer_count; ++layer) {
    const auto first = planes.inv_z.begin() + layer * area;
    source.inv_z.emplace_back(first, first + area);
    std::vector<uint32_t>& rgba = source.rgba.emplace_back();
    for (ptrdiff_t i = 0; i < area; ++i) rgba.push_back(uint32_t(random.bits()) | 0xff000000);
  }
  return source;
}

}  // namespace

BenchLoad loadOf(const oracle::Scene& scene, const std::vector<oracle::OutputView>& views) {
  BenchLoad load;
  load.name = scene.name;
  oracle::Random random(1);
  load.source = sourceOf(scene, random);
  Frame frame = *frameOf(scene);
  for (size_t layer = 0; layer < load.source.rgba.size(); ++layer) {
    const std::vector<uint32_t>& rgba = load.source.rgba[layer];
    auto bytes = std::make_shared<std::vector<uint8_t>>(rgba.size() * sizeof(uint32_t));
    std::memcpy(bytes->data(), rgba.data(), bytes->size());
    frame.sources[0][layer].color = bytes;
  }
  load.frame = std::make_shared<const Frame>(std::move(frame));
  const Camera& camera = load.frame->format.sources[0].camera;
  load.job = makeTraceJob(rowOf(views), DisplaySpec{}, Pose{}, camera, load.source.size_px);
  return load;
}

std::vector<oracle::OutputView> viewsBeside(const oracle::Scene& scene, int count, double from_x_m,
                                            double step_m) {
  std::vector<oracle::OutputView> views;
  for (int i = 0; i < count; ++i) {
    views.push_back(oracle::ownView(scene));
    views.back().position_m.x = from_x_m + i * step_m;
  }
  return views;
}

}  // namespace viewloom::bench
