// SPDX-License-Identifier: Apache-2.0
#include "lib/catalog.h"

#include <chrono>
#include <utility>

#include "lib/channel.h"

namespace viewloom {
namespace {

using Stub = v1::CatalogService::Stub;

template <typename Request, typename Response>
absl::StatusOr<Response> call(Stub& stub,
                              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&,
                                                           Response*),
                              const Request& request = {}) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(5));
  Response response;
  const grpc::Status status = (stub.*method)(&context, request, &response);
  if (!status.ok()) return statusFromGrpc(status);
  return response;
}

}  // namespace

Catalog::Catalog(std::shared_ptr<grpc::Channel> channel)
    : stub_(v1::CatalogService::NewStub(std::move(channel))) {}

absl::StatusOr<v1::ListStreamsResponse> Catalog::listStreams() const {
  return call(*stub_, &Stub::ListStreams);
}

absl::StatusOr<v1::ListDisplaysResponse> Catalog::listDisplays() const {
  return call(*stub_, &Stub::ListDisplays);
}

absl::StatusOr<v1::ListPresetsResponse> Catalog::listPresets() const {
  return call(*stub_, &Stub::ListPresets);
}

absl::StatusOr<v1::GetServerInfoResponse> Catalog::getServerInfo() const {
  return call(*stub_, &Stub::GetServerInfo);
}

absl::StatusOr<v1::AdviseSourceResponse> Catalog::adviseSource(
    const v1::AdviseSourceRequest& request) const {
  return call(*stub_, &Stub::AdviseSource, request);
}

}  // namespace viewloom
