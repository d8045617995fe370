// SPDX-License-Identifier: Apache-2.0
// CatalogService: streams, displays, presets and what this server is.
#pragma once

#include <string>

#include "access/access_control.h"
#include "display/atlas_layout.h"
#include "frame/limits.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
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

// Thread-safety: all methods may be called from any thread.
class CatalogService final : public v1::CatalogService::CallbackService {
 public:
  CatalogService(const StreamDirectory& directory, const Broadcaster& broadcaster,
                 AccessControl& access, const ServerDescription& description);

 private:
  grpc::ServerUnaryReactor* ListStreams(grpc::CallbackServerContext* context,
                                        const v1::ListStreamsRequest* request,
                                        v1::ListStreamsResponse* response) override;
  grpc::ServerUnaryReactor* ListDisplays(grpc::CallbackServerContext* context,
                                         const v1::ListDisplaysRequest* request,
                                         v1::ListDisplaysResponse* response) override;
  grpc::ServerUnaryReactor* ListPresets(grpc::CallbackServerContext* context,
                                        const v1::ListPresetsRequest* request,
                                        v1::ListPresetsResponse* response) override;
  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest* request,
                                          v1::GetServerInfoResponse* response) override;
  grpc::ServerUnaryReactor* AdviseSource(grpc::CallbackServerContext* context,
                                         const v1::AdviseSourceRequest* request,
                                         v1::AdviseSourceResponse* response) override;

  const StreamDirectory& directory_;
  const Broadcaster& broadcaster_;
  AccessControl& access_;
  const AtlasLimits atlas_limits_;
  const v1::GetServerInfoResponse info_;
  const v1::ListPresetsResponse presets_;
};

}  // namespace viewloom
