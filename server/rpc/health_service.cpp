// SPDX-License-Identifier: Apache-2.0
#include "rpc/health_service.h"

#include <memory>
#include <utility>

#include "base/host_port.h"
#include "messages/wire_message.h"
#include "rpc/call_access.h"
#include "rpc/status_to_grpc.h"

namespace viewloom {
namespace {

using grpc::health::v1::HealthCheckRequest;
using grpc::health::v1::HealthCheckResponse;

// The longest name of a service is a tenth of it.
constexpr size_t kHealthRequestBytesMax = 512;

absl::StatusOr<std::string> serviceOf(grpc::ByteBuffer request) {
  HealthCheckRequest message;
  VIEWLOOM_RETURN_IF_ERROR(parseMessage(request, message, kHealthRequestBytesMax));
  return message.service();
}

}  // namespace

HealthService::HealthService(MemoryBudget& memory, std::set<std::string> services)
    : services_(std::move(services)), watches_(memory, kHealthWatchesMax) {}

void HealthService::drain() {
  is_draining_ = true;
  watches_.forEach([](HealthWatch& watch) { watch.drain(); });
}

void HealthService::end() {
  watches_.turnAway();
  watches_.forEach([](HealthWatch& watch) { watch.end(absl::UnavailableError(kDrainMessage)); });
}

Serving HealthService::servingOf(const std::string& service) const {
  if (!service.empty() && !services_.contains(service)) return HealthCheckResponse::SERVICE_UNKNOWN;
  return is_draining_ ? HealthCheckResponse::NOT_SERVING : HealthCheckResponse::SERVING;
}

grpc::ServerUnaryReactor* HealthService::Check(grpc::CallbackServerContext* context,
                                               const grpc::ByteBuffer* request,
                                               grpc::ByteBuffer* response) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  const absl::StatusOr<std::string> service = serviceOf(*request);
  if (!service.ok()) {
    reactor->Finish(statusToGrpc(service.status()));
    return reactor;
  }
  HealthCheckResponse message;
  message.set_status(servingOf(*service));
  if (message.status() == HealthCheckResponse::SERVICE_UNKNOWN) {
    reactor->Finish(statusToGrpc(absl::NotFoundError("this server has no such service")));
    return reactor;
  }
  *response = bytesFromMessage(message);
  reactor->Finish(grpc::Status::OK);
  return reactor;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* HealthService::Watch(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  const absl::StatusOr<std::string> service = serviceOf(*request);
  const auto watch = std::make_shared<HealthWatch>(
      identityOfHost(clientHost(*context)),
      service.ok() ? servingOf(*service) : HealthCheckResponse::UNKNOWN);
  if (!service.ok()) watch->end(service.status());
  watches_.open(watch);
  // A drain that began meanwhile may have missed it.
  if (is_draining_) watch->drain();
  return watch.get();
}

}  // namespace viewloom
