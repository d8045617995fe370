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

using RawCatalogService = v1::CatalogService::WithRawCallbackMethod_ListStreams<
    v1::CatalogService::WithRawCallbackMethod_ListDisplays<
        v1::CatalogService::WithRawCallbackMethod_ListPresets<
            v1::CatalogService::WithRawCallbackMethod_GetServerInfo<
                v1::CatalogService::WithRawCallbackMethod_AdviseSource<
                    v1::CatalogService::Service>>>>>;

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
// from any thread.
class CatalogService final : public RawCatalogService {
 public:
  CatalogService(const StreamDirectory& directory, const Broadcaster& broadcaster,
                 AccessControl& access, const ServerDescription& description);

 private:
  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;

  grpc::ServerUnaryReactor* ListStreams(Context* context, const Bytes* request,
                                        Bytes* response) override;
  grpc::ServerUnaryReactor* ListDisplays(Context* context, const Bytes* request,
                                         Bytes* response) override;
  grpc::ServerUnaryReactor* ListPresets(Context* context, const Bytes* request,
                                        Bytes* response) override;
  grpc::ServerUnaryReactor* GetServerInfo(Context* context, const Bytes* request,
                                          Bytes* response) override;
  grpc::ServerUnaryReactor* AdviseSource(Context* context, const Bytes* request,
                                         Bytes* response) override;

  const StreamDirectory& directory_;
  const Broadcaster& broadcaster_;
  AccessControl& access_;
  const AtlasLimits atlas_limits_;
  const v1::GetServerInfoResponse info_;
  const v1::ListPresetsResponse presets_;
};

}  // namespace viewloom
