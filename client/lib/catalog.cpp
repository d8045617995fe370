// SPDX-License-Identifier: Apache-2.0
#include "lib/catalog.h"

#include <chrono>
#include <utility>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "base/str_cat.h"
#include "viewloom/v1/catalog_service.grpc.pb.h"

namespace viewloom {
namespace {

using Stub = v1::CatalogService::Stub;

constexpr std::chrono::seconds kPatience{5};

template <typename Request, typename Response>
absl::StatusOr<Response> call(const std::shared_ptr<grpc::Channel>& channel,
                              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&,
                                                           Response*),
                              const Request& request = {}, const std::stop_token& stop = {}) {
  grpc::ClientContext context;
  const std::stop_callback break_off(stop, [&context] { context.TryCancel(); });
  context.set_deadline(std::chrono::system_clock::now() + kPatience);
  Response response;
  const grpc::Status status = (Stub(channel).*method)(&context, request, &response);
  if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED) {
    return absl::DeadlineExceededError(strCat("no answer within ", kPatience.count(), " s"));
  }
  if (!status.ok()) return statusFromGrpc(status);
  return response;
}

}  // namespace

Catalog::Catalog(std::shared_ptr<grpc::Channel> channel) : channel_(std::move(channel)) {}

absl::StatusOr<v1::ListStreamsResponse> Catalog::listStreams(const std::stop_token& stop) const {
  return call(channel_, &Stub::ListStreams, {}, stop);
}

absl::StatusOr<v1::ListDisplaysResponse> Catalog::listDisplays() const {
  return call(channel_, &Stub::ListDisplays);
}

absl::StatusOr<v1::ListPresetsResponse> Catalog::listPresets() const {
  return call(channel_, &Stub::ListPresets);
}

absl::StatusOr<v1::GetServerInfoResponse> Catalog::getServerInfo() const {
  return call(channel_, &Stub::GetServerInfo);
}

absl::StatusOr<v1::AdviseSourceResponse> Catalog::adviseSource(
    const v1::AdviseSourceRequest& request) const {
  return call(channel_, &Stub::AdviseSource, request);
}

}  // namespace viewloom
