// SPDX-License-Identifier: Apache-2.0
// Asks a server what it has.
#pragma once

#include <memory>
#include <stop_token>

#include "base/status.h"
#include "lib/channel.h"
#include "viewloom/v1/catalog_service.pb.h"

namespace viewloom {

// Each call ends within five seconds; UNAVAILABLE when nobody listens.
// Thread-safety: all methods may be called from any thread.
class Catalog {
 public:
  explicit Catalog(std::shared_ptr<grpc::Channel> channel);

  // CANCELLED once a stop is requested.
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
