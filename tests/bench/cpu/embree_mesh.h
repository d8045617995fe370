// SPDX-License-Identifier: Apache-2.0
// The rival "embree": a ray tracer for meshes, given the depth grids as one.
#pragma once

#include <memory>
#include <string_view>

#include "bench/contestant.h"

namespace viewloom::bench {

// The mesh (mesh_strip.h) is in (x px, y px, 1/Z), where rays stay straight: each is the segment
// from the nearest depth to infinity. Colour is bilinear on whole cells, the sample's elsewhere.
//
// Results on 1920x1080, two layers, 48 views, 2 cores (AVX-512, Embree 3.13.5, 2026-11-21). With
// one px's views in a packet, flagged as coherent, a trace takes half the time of packets with 16
// px of one view, and a third of that without the flag. Binned SAH builds five times as long as
// Morton codes, for a slower trace. Grids instead of quads trace three times as slowly.
class EmbreeMesh : public Contestant {
 public:
  EmbreeMesh();
  ~EmbreeMesh() override;

  std::string_view name() const override { return "embree"; }
  bool takes(const BenchLoad& load) const override;
  void prepare(const BenchLoad& load) override;
  void build() override;
  void trace() override;
  Picture picture() override;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace viewloom::bench
