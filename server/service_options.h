// SPDX-License-Identifier: Apache-2.0
// Options of the service's parts, by the settings.
#pragma once

#include <cstdint>
#include <string>

#include "access/access_control.h"
#include "base/descriptors.h"
#include "config/config.h"
#include "display/atlas_layout.h"
#include "frame/limits.h"
#include "publish/broadcaster.h"
#include "web/web_context.h"

namespace viewloom {

FrameLimits frameLimits(const LimitsConfig& limits);
AtlasLimits atlasLimits(const LimitsConfig& limits);
BroadcasterLimits broadcasterLimits(const LimitsConfig& limits);
AccessOptions accessOptions(const AccessConfig& config);

// Connections that the settings ask for, or less if the system allows fewer open files.
ConnectionShares connectionShares(const Config& config);

// The address is "127.0.0.1:8080" or "[::1]:8080", as the settings have checked.
HttpOptions httpOptions(const HttpConfig& config, uint32_t connection_count_max);

// The address as configured, with the port that was taken.
std::string listeningAddress(const std::string& configured, uint16_t port, bool has_tls);

}  // namespace viewloom
