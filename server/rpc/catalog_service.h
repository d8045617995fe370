// SPDX-License-Identifier: Apache-2.0
// CatalogService: streams, displays, presets and what this server is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "access/access_control.h"
#include "admission/memory_budget.h"
#include "display/atlas_layout.h"
#include "frame/limits.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
#include "rpc/live_calls.h"
#include "rpc/one_request_call.h"
#include "tls/exposure.h"
#include "viewloom/v1/catalog_service.grpc.pb.h"

namespace viewloom {

// Answer of GetServerInfo; fixed while the server runs.
struct ServerDescription {
  std::string version;
  std::string device;  // Vulkan device name
  std::string driver;
  bool is_software = false;  // the device is a CPU
  FrameLimits frame_limits;
  AtlasLimits atlas_limits;
  uint32_t stream_count_max = 0;
  BroadcasterLimits broadcaster_limits;
  std::string http_address;  // of the viewer page; empty = none
  ServerReach reach = ServerReach::kMachine;
  std::string containment;  // what contains the process, in words; "none"
};

// Reads no bytes of requests that have nothing to say. Thread-safety: all methods may be called
// from any thread, tick() from one.
class CatalogService final : public EarlyService<v1::CatalogService::Service> {
 public:
  // All but the description outlive it.
  CatalogService(const StreamDirectory& directory, const Broadcaster& broadcaster,
                 AccessControl& access, MemoryBudget& memory, const ServerDescription& description);

  // To be called every kTick; cuts calls like IngestService::tick.
  void tick(uint32_t unread_ticks_max);
  // Ends all calls, and those to come, with UNAVAILABLE.
  void end();

 private:
  // Writes the answer for a caller who may ask; returns the status of the call.
  template <typename Response>
  using Fill = std::function<absl::Status(const Caller& caller, grpc::ByteBuffer& request,
                                          Response& response)>;
  template <typename Response>
  void answer(int method_index, std::string_view rpc, Fill<Response> fill);

  void listStreams(const Caller& caller, v1::ListStreamsResponse& response) const;
  void listDisplays(const Caller& caller, v1::ListDisplaysResponse& response) const;

  const StreamDirectory& directory_;
  const Broadcaster& broadcaster_;
  AccessControl& access_;
  const AtlasLimits atlas_limits_;
  const v1::GetServerInfoResponse info_;
  const v1::ListPresetsResponse presets_;
  LiveCalls<QuestionCall> calls_;
};

}  // namespace viewloom
