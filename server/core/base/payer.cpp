// SPDX-License-Identifier: Apache-2.0
#include "base/payer.h"

#include "base/host_port.h"

namespace viewloom {

bool Payer::isLocal() const {
  return name_ == kThisMachine;
}

}  // namespace viewloom
