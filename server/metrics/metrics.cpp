// SPDX-License-Identifier: Apache-2.0
#include "metrics/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "metrics/client_seconds.h"

namespace viewloom {
namespace {

constexpr double kSecondsPerNs = 1e-9;

// Seconds; from a cheap stage of a small frame to a software device on a quilt of 67 Mpx.
const prometheus::Histogram::BucketBoundaries kStageBounds = {
    0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.033, 0.066, 0.125, 0.25, 0.5, 1, 2, 4, 8};

// Seconds; from what nobody notices to what makes nobody believe in a window.
const prometheus::Histogram::BucketBoundaries kMotionBounds = {
    0.001, 0.002, 0.004, 0.008, 0.012, 0.016, 0.02, 0.03, 0.04, 0.06, 0.1, 0.15, 0.25, 0.5, 1, 2};

// Seconds; pieces are to take 10 ms, and are not to take more than 30 ms.
const prometheus::Histogram::BucketBoundaries kPieceBounds = {
    0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.5, 1, 2};

using LabelValues = std::vector<const char*>;
const LabelValues kStages = {"receive", "decode", "upload", "build", "retime",
                             "wait",    "trace",  "encode", "total"};
const LabelValues kHandOvers = {"decode", "structure", "trace", "grpc", "web"};
const LabelValues kTransports = {"grpc", "web"};
const LabelValues kRayAnswers = {"hit", "hit_assumed", "hidden", "outside", "empty"};
const LabelValues kTraceMethods = {"walk", "sweep"};
const LabelValues kVideoRungs = {"first", "second"};
const LabelValues kCertificateChanges = {"taken", "refused"};
const LabelValues kEngineWorks = {"trace", "piece", "pack", "build"};
const LabelValues kPayerClasses = {"server", "local", "remote"};
const LabelValues kHttpAnswers = {"success", "redirect", "client_error", "server_error"};

const LabelValues kMemoryUses = {"program",  "messages", "frames",  "structures",
                                 "displays", "atlases",  "viewers", "connections"};

Counter counter(prometheus::Registry& registry, const char* name, const char* help) {
  return Counter(prometheus::BuildCounter().Name(name).Help(help).Register(registry).Add({}));
}

Gauge gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return Gauge(prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({}));
}

Histogram histogram(prometheus::Registry& registry, const char* name, const char* help,
                    const prometheus::Histogram::BucketBoundaries& bounds) {
  return Histogram(
      prometheus::BuildHistogram().Name(name).Help(help).Register(registry).Add({}, bounds));
}

template <typename Label, typename Handle, typename Family, typename... Options, size_t... kIndices>
Labelled<Label, Handle> labelled(Family& family, const char* key, const LabelValues& values,
                                 std::index_sequence<kIndices...>, const Options&... options) {
  return Labelled<Label, Handle>({Handle(family.Add({{key, values.at(kIndices)}}, options...))...});
}

template <typename Label>
Labelled<Label, Counter> counters(prometheus::Registry& registry, const char* name,
                                  const char* help, const char* key, const LabelValues& values) {
  auto& family = prometheus::BuildCounter().Name(name).Help(help).Register(registry);
  return labelled<Label, Counter>(family, key, values,
                                  std::make_index_sequence<Labelled<Label, Counter>::kSize>());
}

template <typename Label>
Labelled<Label, Gauge> gauges(prometheus::Registry& registry, const char* name, const char* help,
                              const char* key, const LabelValues& values) {
  auto& family = prometheus::BuildGauge().Name(name).Help(help).Register(registry);
  return labelled<Label, Gauge>(family, key, values,
                                std::make_index_sequence<Labelled<Label, Gauge>::kSize>());
}

Labelled<Stage, Histogram> stageHistograms(prometheus::Registry& registry) {
  auto& family = prometheus::BuildHistogram()
                     .Name("viewloom_stage_seconds")
                     .Help("Time of a frame or an atlas in each stage.")
                     .Register(registry);
  return labelled<Stage, Histogram>(family, "stage", kStages,
                                    std::make_index_sequence<Labelled<Stage, Histogram>::kSize>(),
                                    kStageBounds);
}

Labelled<EngineWork, Histogram> pieceHistograms(prometheus::Registry& registry, const char* name,
                                                const char* help) {
  auto& family = prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
  return labelled<EngineWork, Histogram>(
      family, "work", kEngineWorks,
      std::make_index_sequence<Labelled<EngineWork, Histogram>::kSize>(), kPieceBounds);
}

PayerClass classOf(const std::vector<Payer>& payers) {
  if (payers.empty() || payers.front().isServer()) return PayerClass::kServer;
  const bool are_local = std::ranges::all_of(payers, &Payer::isLocal);
  return are_local ? PayerClass::kLocal : PayerClass::kRemote;
}

}  // namespace

void Counter::add(double amount) const {
  counter_->Increment(amount);
}
double Counter::value() const {
  return counter_->Value();
}
void Gauge::set(double value) const {
  gauge_->Set(value);
}
void Gauge::add(double amount) const {
  gauge_->Increment(amount);
}
double Gauge::value() const {
  return gauge_->Value();
}
void Histogram::observe(double value) const {
  histogram_->Observe(value);
}

struct Metrics::Store {
  explicit Store(ClientNames names) {
    if (names == ClientNames::kShown) client_seconds.emplace(registry);
  }

  prometheus::Registry registry;
  std::optional<ClientSeconds> client_seconds;
};

Metrics::Metrics(ClientNames names)
    : store_(std::make_unique<Store>(names)),
      frames_received(
          counter(store_->registry, "viewloom_frames_received_total", "Frames received whole.")),
      frames_refused(counter(store_->registry, "viewloom_frames_refused_total",
                             "Frames refused by the checks of their header or bytes.")),
      frames_unchanged(counter(store_->registry, "viewloom_frames_unchanged_total",
                               "Frames that equal the resident one: nothing was made of them.")),
      received_bytes(counter(store_->registry, "viewloom_received_bytes_total",
                             "Bytes of planes, as they came on the wire.")),
      structures_built(counter(store_->registry, "viewloom_structures_built_total",
                               "Acceleration structures built.")),
      structures_retimed(counter(store_->registry, "viewloom_structures_retimed_total",
                                 "Of those, structures of things that move by themselves, built "
                                 "for times between frames.")),
      atlases_traced(counters<TraceMethod>(store_->registry, "viewloom_atlases_traced_total",
                                           "Atlases traced, one per distinct picture, by how.",
                                           "method", kTraceMethods)),
      atlases_encoded(counter(store_->registry, "viewloom_atlases_encoded_total",
                              "Atlases encoded, one per distinct picture and encoding.")),
      atlases_given_up(counter(store_->registry, "viewloom_atlases_given_up_total",
                               "Atlases that were begun and not finished, because nobody watched "
                               "them any more.")),
      bands_encoded(counter(store_->registry, "viewloom_bands_encoded_total", "Bands encoded.")),
      video_pictures(counter(store_->registry, "viewloom_video_pictures_total",
                             "Pictures of H.264 encoded; they are bands, too.")),
      coarse_atlases(counter(store_->registry, "viewloom_coarse_atlases_total",
                             "Atlases of H.264 encoded coarser than their viewers asked for, "
                             "because their lines are slow.")),
      rung_moves(counters<VideoRung>(store_->registry, "viewloom_rung_moves_total",
                                     "Viewers that moved to the other rung of a video, because "
                                     "their line is far slower than others', or no longer.",
                                     "to", kVideoRungs)),
      encoded_bytes(
          counter(store_->registry, "viewloom_encoded_bytes_total", "Bytes of all encoded bands.")),
      rays(counters<RayAnswer>(store_->registry, "viewloom_rays_total",
                               "Rays traced, by how they ended.", "answer", kRayAnswers)),
      replaced(counters<HandOver>(store_->registry, "viewloom_replaced_total",
                                  "Waiting things replaced by newer ones, by hand-over.",
                                  "hand_over", kHandOvers)),
      atlases_sent(counters<Transport>(store_->registry, "viewloom_atlases_sent_total",
                                       "Atlases written to clients.", "transport", kTransports)),
      sent_bytes(counters<Transport>(store_->registry, "viewloom_sent_bytes_total",
                                     "Bytes of atlases written to clients.", "transport",
                                     kTransports)),
      output_ticks_skipped(counter(store_->registry, "viewloom_output_ticks_skipped_total",
                                   "Ticks of displays with an output rate at which the atlas "
                                   "before was still on its way, or that a newer one overtook.")),
      atlases_presented(counter(store_->registry, "viewloom_atlases_presented_total",
                                "Atlases that gRPC clients say they have shown.")),
      motion_to_image(histogram(store_->registry, "viewloom_motion_to_image_seconds",
                                "From when the eyes before a tracked display were measured "
                                "to when their picture was shown, as gRPC clients say.",
                                kMotionBounds)),
      eye_poses_age(histogram(store_->registry, "viewloom_eye_poses_age_seconds",
                              "How long eye poses had been there when the first rays of "
                              "their atlas were submitted.",
                              kMotionBounds)),
      http_responses(counters<HttpAnswer>(store_->registry, "viewloom_http_responses_total",
                                          "HTTP responses, by kind of status.", "answer",
                                          kHttpAnswers)),
      subscribers(gauges<Transport>(store_->registry, "viewloom_subscribers",
                                    "Clients that watch a display now.", "transport", kTransports)),
      streams_live(
          gauge(store_->registry, "viewloom_streams_live", "Streams with a connected publisher.")),
      displays(gauge(store_->registry, "viewloom_displays", "Displays watched now.")),
      http_connections(gauge(store_->registry, "viewloom_http_connections",
                             "HTTP and WebSocket connections open now.")),
      certificate_end(gauge(store_->registry, "viewloom_certificate_end_seconds",
                            "When the certificate in use expires, since 1970; 0 without TLS.")),
      certificate_changes(counters<CertificateChange>(
          store_->registry, "viewloom_certificate_changes_total",
          "Changed files of the certificate, by whether they were taken.", "outcome",
          kCertificateChanges)),
      memory_budget_bytes(gauge(store_->registry, "viewloom_memory_budget_bytes",
                                "Memory that this server may take (memory.budget).")),
      memory_idle_bytes(gauge(store_->registry, "viewloom_memory_idle_bytes",
                              "Memory that waits for reuse now.")),
      memory_resident_bytes(gauge(store_->registry, "viewloom_memory_resident_bytes",
                                  "Memory of the process, as the system counts it.")),
      memory_heap_bytes(gauge(store_->registry, "viewloom_memory_heap_bytes",
                              "Memory that the C library has lent to the process now.")),
      memory_reserved_bytes(gauges<MemoryUse>(store_->registry, "viewloom_memory_reserved_bytes",
                                              "Memory that is reserved now, by what for.", "use",
                                              kMemoryUses)),
      memory_refused(counters<MemoryUse>(store_->registry, "viewloom_memory_refused_total",
                                         "Requests for which the budget had no room, by what for.",
                                         "use", kMemoryUses)),
      stage(stageHistograms(store_->registry)),
      output_delay(histogram(store_->registry, "viewloom_output_delay_seconds",
                             "From the tick of a display with an output rate to its atlas.",
                             kStageBounds)),
      grpc_connections(
          gauge(store_->registry, "viewloom_grpc_connections", "gRPC connections open now.")),
      connections_refused(
          counters<Transport>(store_->registry, "viewloom_connections_refused_total",
                              "Connections closed at once, because their port had too many.",
                              "transport", kTransports)),
      call_refusal(histogram(store_->registry, "viewloom_call_refusal_seconds",
                             "From a message of a gRPC call to its refusal.", kPieceBounds)),
      engine_seconds(counters<PayerClass>(store_->registry, "viewloom_engine_seconds_total",
                                          "Time of engines and their threads, by whom it was for.",
                                          "payer", kPayerClasses)),
      piece(pieceHistograms(store_->registry, "viewloom_piece_seconds",
                            "Time of the pieces that the engines' work is cut into, as measured.")),
      predicted_piece(pieceHistograms(store_->registry, "viewloom_predicted_piece_seconds",
                                      "The same, as predicted when they began.")),
      longest_piece(gauges<EngineWork>(store_->registry, "viewloom_longest_piece_seconds",
                                       "The longest piece since the start.", "work",
                                       kEngineWorks)) {}

Metrics::~Metrics() = default;

std::string Metrics::text() const {
  return prometheus::TextSerializer().Serialize(store_->registry.Collect());
}

void Metrics::observeTime(const std::vector<Payer>& payers, int64_t duration_ns) const {
  const double seconds = static_cast<double>(duration_ns) * kSecondsPerNs;
  engine_seconds[classOf(payers)].add(seconds);
  if (store_->client_seconds) store_->client_seconds->add(payers, seconds);
}

// One of two longest pieces at one moment may be lost.
void Metrics::observePiece(EngineWork work, const std::vector<Payer>& payers,
                           const PieceTimes& times) const {
  const double seconds = static_cast<double>(times.measured_ns) * kSecondsPerNs;
  observeTime(payers, times.measured_ns);
  piece[work].observe(seconds);
  predicted_piece[work].observe(static_cast<double>(times.predicted_ns) * kSecondsPerNs);
  if (seconds > longest_piece[work].value()) longest_piece[work].set(seconds);
}

void Metrics::observeOutputDelay(int64_t duration_ns) const {
  output_delay.observe(static_cast<double>(duration_ns) * kSecondsPerNs);
}

void Metrics::observeStage(Stage which, int64_t duration_ns) const {
  stage[which].observe(static_cast<double>(duration_ns) * kSecondsPerNs);
}

}  // namespace viewloom
