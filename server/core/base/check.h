// SPDX-License-Identifier: Apache-2.0
// VIEWLOOM_CHECK tests an invariant of our own code. A violation is a bug and ends the process in
// every build.
#pragma once

namespace viewloom {

[[noreturn]] void failCheck(const char* file, int line, const char* expression);

}  // namespace viewloom

#define VIEWLOOM_CHECK(expression) \
  ((expression) ? void(0) : ::viewloom::failCheck(__FILE__, __LINE__, #expression))

#ifdef NDEBUG
#define VIEWLOOM_DCHECK(expression) void(0)
#else
#define VIEWLOOM_DCHECK(expression) VIEWLOOM_CHECK(expression)
#endif
