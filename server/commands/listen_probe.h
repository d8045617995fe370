// SPDX-License-Identifier: Apache-2.0
// Tries a listening address without keeping it.
#pragma once

#include <string>

namespace viewloom {

// "host:port", "[v6]:port" or "unix:path". Empty when it can be taken now; else why not.
std::string whyNotListen(const std::string& address);

}  // namespace viewloom
