// SPDX-License-Identifier: Apache-2.0
// The second surface that a ray meets: what stands behind the first one.
#pragma once

#include "oracle/oracle_trace.h"

namespace viewloom::oracle {

// Surfaces that a ray may go through until it meets another one.
inline constexpr size_t kThroughMax = 64;

// For an answer with kThroughMax hits: the first hit that is further from the first one than a
// connected surface would be; without such a one, the first.
OracleAnswer behindFirst(const OracleSource& source, OracleAnswer answer);

}  // namespace viewloom::oracle
