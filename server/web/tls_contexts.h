// SPDX-License-Identifier: Apache-2.0
// OpenSSL's settings of new connections, made anew when the certificate changes.
#pragma once

#include <functional>
#include <memory>

#include "tls/tls_material.h"
#include "web/asio.h"

namespace viewloom {

// Thread-safety: none; one thread accepts connections.
class TlsContexts {
 public:
  // `material` gives what new connections are to use; it never gives null.
  explicit TlsContexts(std::function<TlsMaterialPtr()> material);

  // TLS 1.2 or 1.3, for servers. It stays the same until the material changes. Throws
  // std::bad_alloc or boost::system::system_error when there is no memory for another; the next
  // call tries again.
  std::shared_ptr<ssl::context> current();

 private:
  const std::function<TlsMaterialPtr()> material_;
  TlsMaterialPtr used_;
  std::shared_ptr<ssl::context> context_;
};

}  // namespace viewloom
