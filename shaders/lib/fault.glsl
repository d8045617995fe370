// SPDX-License-Identifier: Apache-2.0
// The mistake that a test has planted; none in the product.
#ifndef VIEWLOOM_LIB_FAULT_GLSL_
#define VIEWLOOM_LIB_FAULT_GLSL_

#include "shared/fault.h"

layout(constant_id = kFaultConstantId) const uint kFault = kFaultNone;

bool hasFault(uint fault) {
  return kFault == fault;
}

#endif  // VIEWLOOM_LIB_FAULT_GLSL_
