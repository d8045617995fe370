// SPDX-License-Identifier: Apache-2.0
// Lists the streams, displays and presets of a server.
#pragma once

#include <memory>
#include <stop_token>

#include "base/status.h"
#include "lib/channel.h"
#include "viewloom/v1/catalog_service.pb.h"

namespace viewloom {

// Client of CatalogService. Each call ends within 5 s. UNAVAILABLE if there is no server.
// Thread-safety: all methods may be called from any thread.
class Catalog {
 public:
  explicit Catalog(std::shared_ptr<grpc::Channel> channel);

  // Ends with CANCELLED if a stop is requested.
  absl::StatusOr<v1::ListStreamsResponse> listStreams(const std::stop_token& stop = {}) const;
  absl::StatusOr<v1::ListDisplaysResponse> listDisplays() const;
  absl::StatusOr<v1::ListPresetsResponse> listPresets() const;
  absl::StatusOr<v1::GetServerInfoResponse> getServerInfo() const;
  absl::StatusOr<v1::AdviseSourceResponse> adviseSource(
      const v1::AdviseSourceRequest& request) const;

 private:
  std::shared_ptr<grpc::Channel> channel_;
};

}  // namespace viewloom
