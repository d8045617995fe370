// SPDX-License-Identifier: Apache-2.0
#include "rpc/catalog_service.h"

#include <memory>
#include <utility>

#include "admission/request_boundary.h"
#include "display/named_display.h"
#include "display/source_advice.h"
#include "messages/display_from_proto.h"
#include "messages/wire_message.h"
#include "rpc/call_access.h"
#include "rpc/display_request.h"
#include "rpc/layout_to_proto.h"
#include "rpc/refused_call.h"
#include "rpc/report_to_proto.h"

namespace viewloom {
namespace {

v1::Reach reachToProto(ServerReach reach) {
  switch (reach) {
    case ServerReach::kMachine:
      return v1::REACH_MACHINE;
    case ServerReach::kProtected:
      return v1::REACH_PROTECTED;
    case ServerReach::kOpen:
      return v1::REACH_OPEN;
  }
  return v1::REACH_UNSPECIFIED;
}

v1::GetServerInfoResponse infoToProto(const ServerDescription& description) {
  v1::GetServerInfoResponse proto;
  proto.set_version(description.version);
  proto.set_device(description.device);
  proto.set_driver(description.driver);
  proto.set_traces_on_cpu(description.is_software);
  *proto.mutable_ingest_limits() = limitsToProto(description.frame_limits);
  proto.set_atlas_side_px_max(description.atlas_limits.side_px_max);
  proto.set_atlas_px_max(description.atlas_limits.area_px_max);
  proto.set_view_count_max(description.atlas_limits.view_count_max);
  proto.set_stream_count_max(description.stream_count_max);
  proto.set_display_count_max(description.broadcaster_limits.display_count_max);
  proto.set_subscriber_count_max(description.broadcaster_limits.subscriber_count_max);
  proto.set_http_address(description.http_address);
  proto.set_containment(description.containment);
  proto.set_reach(reachToProto(description.reach));
  return proto;
}

v1::ListPresetsResponse presetsToProto() {
  v1::ListPresetsResponse proto;
  for (const NamedDevice& known : namedDevices()) {
    v1::Preset& entry = *proto.add_presets();
    entry.set_name(std::string(known.device.name));
    entry.set_device(std::string(known.device.device));
    entry.set_note(std::string(known.device.note));
    for (const std::string& kind : known.kinds) entry.add_kinds(kind);
    v1::AtlasLayout& layout = *entry.mutable_layout();
    layout = gridToProto(known.layout);
    if (!known.device.has_size) {
      layout.clear_size();
      layout.clear_tile_size();
      layout.clear_aspect();
    }
    if (known.device.panel_px == SizePx{}) continue;
    *entry.mutable_panel_size() = sizeToProto(known.device.panel_px);
    entry.set_panel_dpi(known.device.panel_dpi);
  }
  return proto;
}

v1::StreamEntry entryToProto(const StreamEntry& entry, uint32_t subscriber_count) {
  v1::StreamEntry proto;
  proto.set_name(entry.name);
  proto.set_live(entry.live);
  proto.set_frame_number(entry.frame_number);
  *proto.mutable_size() = sizeToProto(entry.size_px);
  proto.set_layer_count(entry.layer_count);
  proto.set_rate_hz(entry.rate_hz);
  proto.set_received_count(entry.received_count);
  proto.set_replaced_count(entry.replaced_count);
  proto.set_refused_count(entry.refused_count);
  proto.set_used_count(entry.used_count);
  proto.set_subscriber_count(subscriber_count);
  *proto.mutable_stats() = statsToProto(entry.stats);
  return proto;
}

absl::StatusOr<SourceAdvice> adviceOf(grpc::ByteBuffer bytes, const AtlasLimits& limits) {
  v1::AdviseSourceRequest request;
  VIEWLOOM_RETURN_IF_ERROR(parseMessage(bytes, request, kDisplayRequestBytesMax));
  const absl::StatusOr<DisplaySpec> spec = displayFromProto(request.display());
  const absl::Status status = spec.ok() ? validateAtlasLimits(*spec, limits) : spec.status();
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(status, "display"));
  return adviseSource(*spec, request.near_m(), request.far_m());
}

v1::AdviseSourceResponse adviceToProto(const SourceAdvice& advice) {
  v1::AdviseSourceResponse proto;
  *proto.mutable_camera() = cameraToProto(advice.source.camera);
  *proto.mutable_size() = sizeToProto(advice.source.size_px);
  proto.set_layer_count(advice.layer_count);
  if (!advice.second_source) return proto;
  *proto.mutable_second_source() = cameraToProto(advice.second_source->camera);
  *proto.mutable_second_size() = sizeToProto(advice.second_source->size_px);
  return proto;
}

}  // namespace

CatalogService::CatalogService(const StreamDirectory& directory, const Broadcaster& broadcaster,
                               AccessControl& access, MemoryBudget& memory,
                               const ServerDescription& description)
    : directory_(directory),
      broadcaster_(broadcaster),
      access_(access),
      atlas_limits_(description.atlas_limits),
      info_(infoToProto(description)),
      presets_(presetsToProto()),
      calls_(memory) {
  // In the order of the proto.
  answer<v1::ListStreamsResponse>(0, kListStreams,
                                  [this](const Caller& caller, grpc::ByteBuffer&, auto& response) {
                                    listStreams(caller, response);
                                    return absl::OkStatus();
                                  });
  answer<v1::ListDisplaysResponse>(1, kListDisplays,
                                   [this](const Caller& caller, grpc::ByteBuffer&, auto& response) {
                                     listDisplays(caller, response);
                                     return absl::OkStatus();
                                   });
  answer<v1::ListPresetsResponse>(2, kListPresets,
                                  [this](const Caller&, grpc::ByteBuffer&, auto& response) {
                                    response = presets_;
                                    return absl::OkStatus();
                                  });
  answer<v1::GetServerInfoResponse>(3, kGetServerInfo,
                                    [this](const Caller&, grpc::ByteBuffer&, auto& response) {
                                      response = info_;
                                      return absl::OkStatus();
                                    });
  answer<v1::AdviseSourceResponse>(
      4, kAdviseSource, [this](const Caller&, grpc::ByteBuffer& request, auto& response) {
        const absl::StatusOr<SourceAdvice> advice = adviceOf(request, atlas_limits_);
        if (advice.ok()) response = adviceToProto(*advice);
        return advice.status();
      });
}

template <typename Response>
void CatalogService::answer(int method_index, std::string_view rpc, Fill<Response> fill) {
  openEarly(method_index, [this, rpc, fill](grpc::CallbackServerContext* context) -> Reactor* {
    const absl::StatusOr<Caller> caller =
        unlessThrown([&] { return admitCall(access_, *context, rpc); });
    if (!caller.ok()) return new RefusedCall(caller.status());
    const auto call = std::make_shared<QuestionCall>(
        caller->shareName(clientHost(*context)),
        [fill, asking = *caller](grpc::ByteBuffer& request) -> absl::StatusOr<grpc::ByteBuffer> {
          Response response;
          VIEWLOOM_RETURN_IF_ERROR(fill(asking, request, response));
          return bytesFromMessage(response);
        });
    call->setContext(*context);
    calls_.open(call);
    return call.get();
  });
}

void CatalogService::tick(uint32_t unread_ticks_max) {
  calls_.forEach([unread_ticks_max](QuestionCall& call) {
    call.tick();
    call.cutIfUnread(unread_ticks_max);
  });
}

void CatalogService::end() {
  calls_.turnAway();
  calls_.forEach([](QuestionCall& call) { call.end(absl::UnavailableError(kDrainMessage)); });
}

void CatalogService::listStreams(const Caller& caller, v1::ListStreamsResponse& response) const {
  for (const StreamEntry& entry : directory_.list()) {
    if (!caller.sees(entry.name)) continue;
    *response.add_streams() = entryToProto(entry, broadcaster_.subscriberCount(entry.name));
  }
}

void CatalogService::listDisplays(const Caller& caller, v1::ListDisplaysResponse& response) const {
  for (const ActiveDisplayPtr& display : broadcaster_.displays("")) {
    if (!caller.sees(display->stream)) continue;
    v1::DisplayEntry& entry = *response.add_displays();
    entry.set_id(display->id);
    entry.set_stream(display->stream);
    if (const auto layout = broadcaster_.layout(display->id)) {
      *entry.mutable_layout() = layoutToProto(*layout, display->encoding);
    }
    entry.set_subscriber_count(display->subscriber_count);
    entry.set_atlas_count(broadcaster_.atlasCount(display->id));
  }
}

}  // namespace viewloom
