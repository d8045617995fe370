// SPDX-License-Identifier: Apache-2.0
#include "base/thread_name.h"

#include <sys/prctl.h>

namespace viewloom {

void nameThread(const char* name) {
  prctl(PR_SET_NAME, name);  // cannot fail
}

}  // namespace viewloom
