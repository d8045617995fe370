// SPDX-License-Identifier: Apache-2.0
#include "rpc/health_service.h"

#include <memory>
#include <utility>

#include "base/host_port.h"
#include "base/str_cat.h"
#include "messages/wire_message.h"
#include "rpc/call_access.h"

namespace viewloom {
namespace {

using grpc::health::v1::HealthCheckRequest;
using grpc::health::v1::HealthCheckResponse;

// The longest name of a service is a tenth of it.
constexpr size_t kHealthRequestBytesMax = 512;
// Methods in the order of their proto.
constexpr int kCheck = 0;
constexpr int kWatch = 1;

std::string identityOf(const grpc::CallbackServerContext& context) {
  return strCat("health checks of ", identityOfHost(clientHost(context)));
}

}  // namespace

HealthService::HealthService(MemoryBudget& memory, std::set<std::string> services)
    : services_(std::move(services)),
      checks_(memory, kHealthCallsMax),
      watches_(memory, kHealthCallsMax) {
  openEarly(kCheck, [this](grpc::CallbackServerContext* context) -> Reactor* {
    const auto check = std::make_shared<QuestionCall>(
        identityOf(*context),
        [this](grpc::ByteBuffer& request) -> absl::StatusOr<grpc::ByteBuffer> {
          const absl::StatusOr<Serving> serving = servingOf(request);
          VIEWLOOM_RETURN_IF_ERROR(serving.status());
          if (*serving == HealthCheckResponse::SERVICE_UNKNOWN)
            return absl::NotFoundError("this server has no such service");
          HealthCheckResponse response;
          response.set_status(*serving);
          return bytesFromMessage(response);
        });
    check->setContext(*context);
    checks_.open(check);
    return check.get();
  });
  openEarly(kWatch, [this](grpc::CallbackServerContext* context) -> Reactor* {
    const auto watch = std::make_shared<HealthWatch>(
        identityOf(*context), [this](grpc::ByteBuffer& request) { return servingOf(request); });
    watch->setContext(*context);
    watches_.open(watch);
    // A drain that began meanwhile may have missed it.
    if (is_draining_) watch->drain();
    return watch.get();
  });
}

void HealthService::tick(uint32_t unread_ticks_max) {
  const auto tick_one = [unread_ticks_max](OneRequestCall& call) {
    call.tick();
    call.cutIfUnread(unread_ticks_max);
  };
  checks_.forEach(tick_one);
  watches_.forEach(tick_one);
}

void HealthService::drain() {
  is_draining_ = true;
  watches_.forEach([](HealthWatch& watch) { watch.drain(); });
}

void HealthService::end() {
  const auto end_one = [](OneRequestCall& call) {
    call.end(absl::UnavailableError(kDrainMessage));
  };
  checks_.turnAway();
  checks_.forEach(end_one);
  watches_.turnAway();
  watches_.forEach(end_one);
}

absl::StatusOr<Serving> HealthService::servingOf(grpc::ByteBuffer& request) const {
  HealthCheckRequest message;
  VIEWLOOM_RETURN_IF_ERROR(parseMessage(request, message, kHealthRequestBytesMax));
  const std::string& service = message.service();
  if (!service.empty() && !services_.contains(service)) return HealthCheckResponse::SERVICE_UNKNOWN;
  return is_draining_ ? HealthCheckResponse::NOT_SERVING : HealthCheckResponse::SERVING;
}

}  // namespace viewloom
