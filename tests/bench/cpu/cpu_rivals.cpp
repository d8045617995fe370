// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu/cpu_rivals.h"

#ifdef VIEWLOOM_HAS_EMBREE
#include "bench/cpu/embree_mesh.h"
#endif
#include "bench/cpu/planar_runs.h"
#include "bench/cpu/sample_rows.h"

namespace viewloom::bench {

std::vector<std::unique_ptr<Contestant>> makeCpuRivals() {
  std::vector<std::unique_ptr<Contestant>> rivals;
#ifdef VIEWLOOM_HAS_EMBREE
  rivals.push_back(std::make_unique<EmbreeMesh>());
#endif
  rivals.push_back(std::make_unique<SampleRows>());
  rivals.push_back(std::make_unique<PlanarRuns>());
  return rivals;
}

}  // namespace viewloom::bench
