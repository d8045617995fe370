// SPDX-License-Identifier: Apache-2.0
// The first event among all facets and all edges of a source, without walking: checks the oracle's
// walk.
#pragma once

#include "oracle/oracle_trace.h"

namespace viewloom::oracle {

// The same as traceOracle with one hit; linked_facet is not filled in.
OracleAnswer traceAllFacets(const OracleSource& source, const Ray& ray);

}  // namespace viewloom::oracle
