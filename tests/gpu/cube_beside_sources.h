// SPDX-License-Identifier: Apache-2.0
// A cube map and one or two other sources in a frame, on scenes and views of the oracle.
#pragma once

#include "gpu/sources_under_test.h"

namespace viewloom {

// Every ray of random views of the scenes of a seed: some sources see what a face of the cube map
// does, from there or from beside it, some contradict it.
oracle::Verdict judgeCubeBesideSources(SourcesUnderTest& tracer, uint64_t seed);

}  // namespace viewloom
