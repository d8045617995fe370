// SPDX-License-Identifier: Apache-2.0
#include "bench/rivals/cpu_rivals.h"

#ifdef VIEWLOOM_HAS_EMBREE
#include "bench/rivals/embree_mesh.h"
#endif
#include "bench/rivals/planar_runs.h"
#include "bench/rivals/sample_rows.h"

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
