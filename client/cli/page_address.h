// SPDX-License-Identifier: Apache-2.0
// The viewer page of a server, as a browser on this machine opens it.
#pragma once

#include <string>

namespace viewloom::cli {

// The URL of the page, which the server says as it listens. If it listens on all addresses, the
// page is at the host of `server`, the address by which this client reached it; at localhost for a
// unix socket. Empty stays empty.
std::string pageToOpen(const std::string& url, const std::string& server);

// " (on the server's own machine)" for a page at a loopback address of a server that may be
// elsewhere; else empty.
std::string pageRemark(const std::string& url, const std::string& server);

}  // namespace viewloom::cli
