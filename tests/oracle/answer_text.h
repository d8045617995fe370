// SPDX-License-Identifier: Apache-2.0
// Answers and rays in words, for messages.
#pragma once

#include <string>

#include "oracle/judge.h"

namespace viewloom::oracle {

std::string describe(const OracleAnswer& answer);
std::string describe(const TestedAnswer& answer);
std::string describe(const Ray& ray);

}  // namespace viewloom::oracle
