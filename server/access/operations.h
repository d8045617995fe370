// SPDX-License-Identifier: Apache-2.0
// All that clients can ask for, and the role that each needs. Both doors look it up here.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "access/rights.h"

namespace viewloom {

enum class Need : uint8_t {
  kNothing,   // anybody
  kIdentity,  // whoever has proven an identity, with any role
  kRole       // an identity with the role
};

enum class Reach : uint8_t {
  kServer,   // says something about the whole server
  kVisible,  // lists streams: those that the identity's patterns match
  kStream    // names one stream, which the identity's patterns must match
};

struct Operation {
  std::string_view name;  // full name of an RPC, or method and path of a request
  Need need = Need::kRole;
  Role role = Role::kWatch;  // if need is kRole
  Reach reach = Reach::kServer;
};

// RPCs, as gRPC names them.
inline constexpr std::string_view kPublishFrames = "/viewloom.v1.IngestService/PublishFrames";
inline constexpr std::string_view kStreamAtlases = "/viewloom.v1.DisplayService/StreamAtlases";
inline constexpr std::string_view kListStreams = "/viewloom.v1.CatalogService/ListStreams";
inline constexpr std::string_view kListDisplays = "/viewloom.v1.CatalogService/ListDisplays";
inline constexpr std::string_view kListPresets = "/viewloom.v1.CatalogService/ListPresets";
inline constexpr std::string_view kGetServerInfo = "/viewloom.v1.CatalogService/GetServerInfo";
inline constexpr std::string_view kAdviseSource = "/viewloom.v1.CatalogService/AdviseSource";
// Requests of the web port. A name that ends with '/' stands for all paths below it.
inline constexpr std::string_view kWebSocket = "/ws";
inline constexpr std::string_view kStills = "/still/";
inline constexpr std::string_view kPlayers = "/stream/";
inline constexpr std::string_view kApiStreams = "/api/streams";
inline constexpr std::string_view kApiDisplays = "/api/displays";
inline constexpr std::string_view kApiPresets = "/api/presets";
inline constexpr std::string_view kApiFields = "/api/fields";
inline constexpr std::string_view kApiLink = "/api/link";
inline constexpr std::string_view kApiQr = "/api/qr";
inline constexpr std::string_view kApiSession = "/api/session";
inline constexpr std::string_view kMetricsPage = "/metrics";
inline constexpr std::string_view kHealthPage = "/healthz";

std::span<const Operation> operations();
// The operation of an RPC or of a path; empty for unknown ones, which nobody may do.
std::optional<Operation> operationOf(std::string_view rpc_or_path);

}  // namespace viewloom
