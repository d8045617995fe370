// SPDX-License-Identifier: Apache-2.0
// The whole server, composed: builds every part, joins outputs to inputs, drains in the order of
// data flow.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "base/clock.h"
#include "config/config.h"
#include "metrics/metrics.h"
#include "tls/exposure.h"
#include "tls/tls_material.h"

namespace viewloom {

class EngineRoom;

// Addresses and protection of a server with these settings.
Exposure exposureOf(const Config& config);

// Serves from its construction on. Throws std::runtime_error, with the remedy, when it cannot
// start, or must not (refusalToListen). Thread-safety: none but that of const methods; failures are
// told from the thread that fails.
class Service {
 public:
  // `on_failure`: the server cannot go on (device lost, out of memory) and should be drained.
  // `clock` outlives the service. `contain` is called once, when devices are open and nobody can
  // connect yet; it returns what contains the process, for GetServerInfo.
  Service(
      const Config& config, const Clock& clock,
      std::function<void(const std::exception& error)> on_failure,
      const std::function<std::string()>& contain = [] { return "none"; });
  // Drains.
  ~Service();

  // "127.0.0.1:50051", with the port in use; with TLS "https://127.0.0.1:50051".
  const std::string& grpcAddress() const;
  // "http://127.0.0.1:8080/", with TLS "https://..."; empty = no web server.
  std::string httpUrl() const;
  // The certificate in use; null without TLS.
  TlsMaterialPtr tls() const;
  const Metrics& metrics() const;
  const EngineRoom& engineRoom() const;

  // Takes no more frames, finishes the atlases that have begun, lets receivers take them for two
  // seconds, ends. Whoever subscribes gets whole atlases or none.
  void drain();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace viewloom
