// SPDX-License-Identifier: Apache-2.0
// Cube maps built and traced as the server does, on scenes and views of the oracle.
#pragma once

#include "gpu/sources_under_test.h"
#include "gpu/structure_checks.h"
#include "oracle/cube_judge.h"

namespace viewloom {

struct JudgedCube {
  Complaints complaints;  // of the structures of the faces, with their aprons
  oracle::Verdict verdict;

  void add(const JudgedCube& other) {
    complaints.add(other.complaints);
    verdict.add(other.verdict);
  }
};

// Every ray of random views, looking all around, of the cube map of a seed: what surrounds it goes
// on from face to face, or every face has a scene of its own.
JudgedCube judgeCube(SourcesUnderTest& tracer, uint64_t seed);

}  // namespace viewloom
