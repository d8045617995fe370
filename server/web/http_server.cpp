// SPDX-License-Identifier: Apache-2.0
#include "web/http_server.h"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "admission/display_price.h"
#include "base/host_port.h"
#include "base/log.h"
#include "base/str_cat.h"
#include "base/thread_name.h"
#include "web/connection.h"
#include "web/once_ended.h"
#include "web/tls_contexts.h"

namespace viewloom {
namespace {

// Handles left for the rest of the program when accepting fails: how long until it is tried again.
constexpr std::chrono::milliseconds kAcceptPause{100};

struct HeldConnection {
  std::weak_ptr<Connection> connection;
  Admission admission;
};

using ConnectionList = std::vector<std::shared_ptr<Connection>>;

tcp::endpoint endpointOf(const HttpOptions& options) {
  ErrorCode error;
  const auto address = net::ip::make_address(options.address, error);
  if (!error) return {address, options.port};
  throw std::runtime_error(
      strCat("web address \"", options.address, "\": accepted is a numeric IPv4 or IPv6 address"));
}

// A socket whose other side went already has none.
std::string identityOf(const tcp::socket& socket) {
  ErrorCode error;
  const tcp::endpoint endpoint = socket.remote_endpoint(error);
  return error ? "" : identityOfHost(endpoint.address().to_string());
}

tcp::acceptor listen(net::io_context& io, const HttpOptions& options) {
  const tcp::endpoint endpoint = endpointOf(options);
  try {
    return tcp::acceptor(io, endpoint);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(strCat("cannot listen on ", options.address, ":", options.port,
                                    " for the web page: ", error.code().message(),
                                    "; choose another address or port"));
  }
}

}  // namespace

struct HttpServer::State {
  State(HttpOptions options, const StreamDirectory& streams, Broadcaster& broadcaster,
        EyeSink& eyes, const Metrics& metrics, const Clock& clock, AccessControl& access,
        std::function<absl::Status()> grpc_health, MemoryBudget& memory, FairShares* shares)
      : io(static_cast<int>(options.thread_count)),
        acceptor(listen(io, options)),
        endpoint(acceptor.local_endpoint()),
        context{options,
                HostPolicy(machineNames(), options.allowed_hosts, options.allowed_origins),
                std::move(grpc_health),
                streams,
                broadcaster,
                eyes,
                metrics,
                clock,
                access,
                memory,
                shares != nullptr ? *shares : own_shares} {
    if (options.tls) tls.emplace(options.tls);
  }

  FairShares own_shares;  // where there are no engines
  net::io_context io;
  tcp::acceptor acceptor;  // used by accept() alone
  const tcp::endpoint endpoint;
  WebContext context;
  std::optional<TlsContexts> tls;  // used by accept() alone

  std::mutex mutex;
  std::condition_variable fewer;
  std::map<uint64_t, HeldConnection> connections;  // oldest first
  uint64_t connection_id = 0;                      // used by take() alone

  std::vector<std::jthread> threads;

  void run();
  void startAccepting();
  net::awaitable<void> accept();
  net::awaitable<void> acceptOne(ErrorCode& error);
  void take(tcp::socket socket);
  // To what a further connection is admitted; none when it has to go. Under the mutex.
  // `seen` is to be let go after it: the end of a connection takes the mutex.
  std::optional<Admission> admit(bool has_memory, ConnectionList& seen);
  bool cutOldestIdle(Admission admission, ConnectionList& seen);
  size_t countOf(Admission admission) const;
  ConnectionList living();
};

// Handlers that an exception leaves are dropped: what they served has been told, or ends by a
// timeout.
void HttpServer::State::run() {
  for (bool is_running = true; is_running;) {
    try {
      io.run();
      is_running = false;
    } catch (const std::bad_alloc&) {
      log(LogLevel::kWarning, "no memory is left to serve an HTTP client; it is dropped");
    } catch (const std::exception& thrown) {
      noteThrown("the service of an HTTP client", thrown);
    }
  }
}

void HttpServer::State::startAccepting() {
  net::co_spawn(acceptor.get_executor(), accept(), OnceEnded([this] { startAccepting(); }));
}

net::awaitable<void> HttpServer::State::acceptOne(ErrorCode& error) {
  try {
    tcp::socket socket(net::make_strand(io));
    co_await acceptor.async_accept(socket, into(error));
    if (!error) take(std::move(socket));
  } catch (const std::exception& thrown) {
    noteThrown("accepting an HTTP connection", thrown);
    error = net::error::no_memory;
  }
}

net::awaitable<void> HttpServer::State::accept() {
  while (!context.draining) {
    ErrorCode error;
    co_await acceptOne(error);
    if (error && error != net::error::operation_aborted) {
      net::steady_timer pause(acceptor.get_executor(), kAcceptPause);
      co_await pause.async_wait(into(error));
    }
  }
}

void HttpServer::State::take(tcp::socket socket) {
  std::optional<Reservation> memory = context.memory.tryReserve(
      {.use = MemoryUse::kConnections, .identity = identityOf(socket), .bytes = kConnectionBytes});
  ConnectionList seen;
  std::unique_lock lock(mutex);
  const std::optional<Admission> admission = admit(memory.has_value(), seen);
  lock.unlock();
  if (!admission) {
    context.metrics.connections_refused[Transport::kWeb].add();
    return;  // closes the socket
  }
  const uint64_t id = ++connection_id;
  // Made without the lock: its end takes it, also where there is no memory to make it.
  const std::shared_ptr<Connection> connection(
      new Connection(
          context, std::move(socket),
          {.admission = *admission, .memory = memory ? *std::move(memory) : Reservation()},
          tls ? tls->current() : nullptr),
      [this, id](Connection* ended) {
        delete ended;
        std::lock_guard relock(mutex);
        connections.erase(id);
        fewer.notify_all();
      });
  {
    // Let go before the connection, also where there is no memory for the entry.
    std::lock_guard relock(mutex);
    connections.emplace(id, HeldConnection{connection, *admission});
  }
  connection->start();
}

std::optional<Admission> HttpServer::State::admit(bool has_memory, ConnectionList& seen) {
  const HttpOptions& options = context.options;
  const size_t status_max = options.status_connection_count_max;
  const size_t most = options.connection_count_max;
  const bool has_room = connections.size() < most || countOf(Admission::kEverything) < most;
  if (has_memory && has_room) return Admission::kEverything;
  // Those that were cut are still there for a moment.
  if (connections.size() >= most + 2 * status_max) return std::nullopt;
  if (has_memory && cutOldestIdle(Admission::kEverything, seen)) return Admission::kEverything;
  if (countOf(Admission::kStatus) >= status_max) cutOldestIdle(Admission::kStatus, seen);
  return Admission::kStatus;
}

bool HttpServer::State::cutOldestIdle(Admission admission, ConnectionList& seen) {
  for (const auto& [id, held] : connections) {
    if (held.admission != admission) continue;
    seen.push_back(held.connection.lock());
    if (!seen.back() || !seen.back()->awaitsRequest()) continue;
    seen.back()->cut();
    return true;
  }
  return false;
}

size_t HttpServer::State::countOf(Admission admission) const {
  return static_cast<size_t>(std::ranges::count(
      connections, admission, [](const auto& entry) { return entry.second.admission; }));
}

ConnectionList HttpServer::State::living() {
  ConnectionList living;
  std::lock_guard lock(mutex);
  for (const auto& [id, held] : connections) {
    if (auto alive = held.connection.lock()) living.push_back(std::move(alive));
  }
  return living;
}

HttpServer::HttpServer(HttpOptions options, const StreamDirectory& streams,
                       Broadcaster& broadcaster, EyeSink& eyes, const Metrics& metrics,
                       const Clock& clock, AccessControl& access,
                       std::function<absl::Status()> grpc_health, MemoryBudget& memory,
                       FairShares* shares)
    : state_(std::make_unique<State>(std::move(options), streams, broadcaster, eyes, metrics, clock,
                                     access, std::move(grpc_health), memory, shares)) {
  State& state = *state_;
  state.startAccepting();
  for (uint32_t i = 0; i < state.context.options.thread_count; ++i) {
    state.threads.emplace_back([&state] {
      nameThread("http");
      state.run();
    });
  }
}

HttpServer::~HttpServer() {
  drain();
  state_->threads.clear();
}

uint16_t HttpServer::port() const {
  return state_->endpoint.port();
}

std::string HttpServer::url() const {
  const auto& address = state_->endpoint.address();
  const std::string host =
      address.is_v6() ? strCat("[", address.to_string(), "]") : address.to_string();
  return strCat(state_->tls ? "https://" : "http://", host, ":", port(), "/");
}

void HttpServer::drain() {
  State& state = *state_;
  state.context.draining = true;
  net::post(state.acceptor.get_executor(), [&state] {
    ErrorCode ignored;  // closed already when drained twice
    state.acceptor.close(ignored);
  });
  for (const auto& connection : state.living()) connection->leave();
  std::unique_lock lock(state.mutex);
  const auto none = [&state] { return state.connections.empty(); };
  if (state.fewer.wait_for(lock, state.context.options.drain_timeout, none)) return;
  lock.unlock();
  for (const auto& connection : state.living()) connection->cut();
  lock.lock();
  state.fewer.wait(lock, none);
}

}  // namespace viewloom
