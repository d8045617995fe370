// SPDX-License-Identifier: Apache-2.0
#include "access/operations.h"

#include <algorithm>
#include <array>

namespace viewloom {
namespace {

constexpr std::array kOperations = {
    Operation{kPublishFrames, Need::kRole, Role::kPublish, Reach::kStream},
    Operation{kStreamAtlases, Need::kRole, Role::kWatch, Reach::kStream},
    Operation{kListStreams, Need::kIdentity, {}, Reach::kVisible},
    Operation{kListDisplays, Need::kIdentity, {}, Reach::kVisible},
    Operation{kListPresets, Need::kIdentity, {}, Reach::kServer},
    Operation{kGetServerInfo, Need::kIdentity, {}, Reach::kServer},
    Operation{kAdviseSource, Need::kIdentity, {}, Reach::kServer},
    Operation{kWebSocket, Need::kRole, Role::kWatch, Reach::kStream},
    Operation{kStills, Need::kRole, Role::kWatch, Reach::kStream},
    Operation{kPlayers, Need::kRole, Role::kWatch, Reach::kStream},
    Operation{kApiLink, Need::kRole, Role::kWatch, Reach::kStream},
    Operation{kApiQr, Need::kRole, Role::kWatch, Reach::kStream},
    Operation{kApiStreams, Need::kIdentity, {}, Reach::kVisible},
    Operation{kApiDisplays, Need::kIdentity, {}, Reach::kVisible},
    Operation{kApiPresets, Need::kIdentity, {}, Reach::kServer},
    Operation{kApiFields, Need::kIdentity, {}, Reach::kServer},
    Operation{kApiSession, Need::kIdentity, {}, Reach::kServer},
    Operation{kMetricsPage, Need::kRole, Role::kOperate, Reach::kServer},
    Operation{kHealthPage, Need::kNothing, {}, Reach::kServer},
};

}  // namespace

std::span<const Operation> operations() {
  return kOperations;
}

std::optional<Operation> operationOf(std::string_view rpc_or_path) {
  const auto* const found =
      std::ranges::find_if(kOperations, [rpc_or_path](const Operation& operation) {
        return operation.name.ends_with('/') ? rpc_or_path.starts_with(operation.name)
                                             : rpc_or_path == operation.name;
      });
  return found == kOperations.end() ? std::nullopt : std::optional(*found);
}

}  // namespace viewloom
