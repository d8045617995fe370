// SPDX-License-Identifier: Apache-2.0
#include "service.h"

#include <atomic>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "access/access_control.h"
#include "admission/coding_room.h"
#include "admission/request_boundary.h"
#include "base/byte_pool.h"
#include "base/log.h"
#include "base/processor_count.h"
#include "base/thread_time.h"
#include "decode/frame_intake.h"
#include "engine_room.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
#include "rpc/rpc_server.h"
#include "service_memory.h"
#include "service_options.h"
#include "service_video.h"
#include "tls/tls_watch.h"
#include "web/http_server.h"

namespace viewloom {
namespace {

// Buffers of planes that wait for reuse: a frame of four layers has eight, and a few are on their
// way.
constexpr size_t kKeptPlaneCount = 64;

// Nothing where no file of TLS is named.
std::unique_ptr<TlsWatch> watchTls(const TlsConfig& config, const Metrics& metrics) {
  if (config.certificate.empty() && config.key.empty() && config.client_ca.empty()) return nullptr;
  const TlsFiles files{.certificate = config.certificate,
                       .key = config.key,
                       .client_authorities = config.client_ca,
                       .is_client_required = config.client_required};
  return std::make_unique<TlsWatch>(files, [&metrics](const auto& found, int64_t end_s) {
    metrics.certificate_end.set(static_cast<double>(end_s));
    if (!found.ok()) metrics.certificate_changes[CertificateChange::kRefused].add();
    if (found.ok() && *found == TlsStore::Found::kTaken) {
      metrics.certificate_changes[CertificateChange::kTaken].add();
    }
  });
}

// Throws where the server must not listen.
const Config& allowed(const Config& config) {
  const std::optional<std::string> refusal = refusalToListen(exposureOf(config));
  if (refusal) throw std::runtime_error(*refusal);
  return config;
}

}  // namespace

Exposure exposureOf(const Config& config) {
  Exposure exposure{
      .addresses = {config.grpc.address},
      .has_tls = !config.tls.certificate.empty(),
      .has_access_control =
          !config.access.isOpen() || (!config.tls.client_ca.empty() && config.tls.client_required),
      .is_open_wanted = config.open};
  if (config.http.enabled) exposure.addresses.push_back(config.http.address);
  return exposure;
}

// In the order of construction; each part uses those above it.
struct Service::Parts {
  Parts(const Config& config, const Clock& clock,
        std::function<void(const std::exception& error)> on_failure,
        const std::function<std::string()>& contain);
  ~Parts() { drain(); }

  void connect();
  absl::Status grpcHealth();
  void openHttp(const Config& config, const Clock& clock);
  void openRpc(const Config& config, const Clock& clock, const std::string& containment);
  void drain();

  // Gives new connections the certificate in use; empty without TLS.
  std::function<TlsMaterialPtr()> material() const;

  const ConnectionShares connection_shares;
  Metrics metrics;
  AccessControl access;
  const std::unique_ptr<TlsWatch> tls;  // null = no encryption
  MemoryBudget memory;
  StreamDirectory directory;
  CodingRoom coding_room{processors().busyMax(), processTimeNs};
  Broadcaster broadcaster;
  BytePool planes;
  const VideoEncoderChoicePtr video_encoders;
  const std::unique_ptr<EngineRoom> engine_room;
  FrameIntake intake;
  const PreparedBytes prepared_bytes;
  std::optional<ServiceMemory> service_memory;
  std::optional<HttpServer> http;
  std::optional<RpcServer> rpc;
  std::atomic<RpcServer*> open_rpc = nullptr;  // displays may come by HTTP before it is there
  std::string grpc_address;
};

Service::Parts::Parts(const Config& config, const Clock& clock,
                      std::function<void(const std::exception& error)> on_failure,
                      const std::function<std::string()>& contain)
    : connection_shares(connectionShares(config)),
      metrics(config.access.isOpen() ? ClientNames::kHidden : ClientNames::kShown),
      access(accessOptions(config.access), clock),
      tls(watchTls(config.tls, metrics)),
      memory(memoryBudgetBytes(config.memory),
             [this](MemoryUse use) { metrics.memory_refused[use].add(); }),
      directory(clock, config.limits.streams_max),
      broadcaster(broadcasterLimits(config.limits), memory, coding_room),
      planes(kKeptPlaneCount, config.limits.frame_bytes_max),
      video_encoders(chooseVideoEncoder(config.pipeline.video_encoder)),
      engine_room(openEngineRoom(config, atlasLimits(config.limits),
                                 threadCount(config.pipeline.encode_threads),
                                 {.clock = clock,
                                  .metrics = metrics,
                                  .broadcaster = broadcaster,
                                  .directory = directory,
                                  .memory = memory,
                                  .video_encoders = video_encoders,
                                  .on_failure = std::move(on_failure)})),
      intake(*engine_room, clock, planes,
             {.thread_count = threadCount(config.pipeline.decode_threads),
              .on_replaced = [this] { metrics.replaced[HandOver::kDecode].add(); }}),
      prepared_bytes(
          [this](const FrameFormat& format) { return engine_room->preparedBytes(format); }) {
  const EngineRoomDescription made = engine_room->description();
  if (made.device.empty()) {
    log(LogLevel::kInfo, "no engines: atlases are handed out, none are made");
  } else {
    log(LogLevel::kInfo, "device: ", made.device, " (", made.driver, ")");
  }
  connect();
  const std::string containment = contain();
  memory.addIdle(planes.idleMemory());
  service_memory.emplace(memory, directory, metrics, prepared_bytes, made.is_software);
  if (config.http.enabled) openHttp(config, clock);
  openRpc(config, clock, containment);
}

// Connections against the data's direction: demand, and room for new streams.
void Service::Parts::connect() {
  broadcaster.onDemandChange([this](const std::string& stream) {
    engine_room->serveDisplays(stream);
    if (RpcServer* const server = open_rpc) server->demandChanged(stream);
  });
  broadcaster.onEyesServed([this](const std::string& stream) {
    if (RpcServer* const server = open_rpc) server->demandChanged(stream);
  });
  engine_room->onWanted([this](const std::string& stream) { intake.resume(stream); });
  directory.onRoomNeeded([this](const std::string& stream) {
    // A frame that comes later would open the stream again, and nobody would forget it.
    if (broadcaster.subscriberCount(stream) > 0 || !intake.forget(stream)) return false;
    engine_room->forgetStream(stream);
    return true;
  });
}

std::function<TlsMaterialPtr()> Service::Parts::material() const {
  if (tls == nullptr) return {};
  return [watch = tls.get()] { return watch->current(); };
}

void Service::Parts::openHttp(const Config& config, const Clock& clock) {
  HttpOptions options = httpOptions(config.http, connection_shares.http);
  options.tls = material();
  options.video_encoders = video_encoders;
  http.emplace(
      std::move(options), directory, broadcaster, *engine_room, metrics, clock, access,
      [this] { return grpcHealth(); }, memory, &engine_room->shares());
}

absl::Status Service::Parts::grpcHealth() {
  const RpcServer* const server = open_rpc;
  if (server == nullptr) return absl::UnavailableError("it is not open yet");
  return server->health();
}

void Service::Parts::openRpc(const Config& config, const Clock& clock,
                             const std::string& containment) {
  const EngineRoomDescription made = engine_room->description();
  const ServerDescription description{.version = VIEWLOOM_VERSION,
                                      .device = made.device,
                                      .driver = made.driver,
                                      .is_software = made.is_software,
                                      .frame_limits = frameLimits(config.limits),
                                      .atlas_limits = atlasLimits(config.limits),
                                      .stream_count_max = config.limits.streams_max,
                                      .broadcaster_limits = broadcasterLimits(config.limits),
                                      .http_address = http ? http->url() : "",
                                      .reach = reachOf(exposureOf(config)),
                                      .containment = containment};
  rpc.emplace(RpcServerOptions{.address = config.grpc.address,
                               .connection_count_max = connection_shares.grpc,
                               .memory_bytes_max = messageBytesMax(memory.totalBytes()),
                               .keepalive = std::chrono::seconds(config.grpc.keepalive_s),
                               .unread = std::chrono::seconds(config.grpc.unread_s),
                               .tls = material()},
              RpcParts{.intake = intake,
                       .pool = planes,
                       .directory = directory,
                       .broadcaster = broadcaster,
                       .eyes = *engine_room,
                       .clock = clock,
                       .metrics = metrics,
                       .access = access,
                       .memory = memory,
                       .prepared_bytes = prepared_bytes},
              description);
  grpc_address = listeningAddress(config.grpc.address, rpc->port(), tls != nullptr);
  open_rpc = &*rpc;
}

void Service::Parts::drain() {
  if (rpc) rpc->drain();
  intake.close();
  engine_room->drain();
  broadcaster.drain();
  const std::jthread viewers_leave([this] {
    try {
      if (http) http->drain();
    } catch (const std::exception& thrown) {
      noteThrown("the farewell to viewers", thrown);  // they are cut
    }
  });
  if (rpc) rpc->shutdown();
}

Service::Service(const Config& config, const Clock& clock,
                 std::function<void(const std::exception& error)> on_failure,
                 const std::function<std::string()>& contain)
    : parts_(std::make_unique<Parts>(allowed(config), clock, std::move(on_failure), contain)) {}

Service::~Service() = default;

const std::string& Service::grpcAddress() const {
  return parts_->grpc_address;
}
std::string Service::httpUrl() const {
  return parts_->http ? parts_->http->url() : "";
}
TlsMaterialPtr Service::tls() const {
  return parts_->tls ? parts_->tls->current() : nullptr;
}
const Metrics& Service::metrics() const {
  return parts_->metrics;
}
const EngineRoom& Service::engineRoom() const {
  return *parts_->engine_room;
}
void Service::drain() {
  parts_->drain();
}

}  // namespace viewloom
