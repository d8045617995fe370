// SPDX-License-Identifier: Apache-2.0
#include "load/server_metrics.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/host_port.h"

namespace viewloom::load {
namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;

// The address in "http://HOST:PORT/...".
HostPort parseUrl(const std::string& url) {
  constexpr std::string_view kScheme = "http://";
  if (url.starts_with(kScheme)) {
    const std::string_view rest = std::string_view(url).substr(kScheme.size());
    const std::optional<HostPort> parsed = parseHostPort(rest.substr(0, rest.find('/')));
    if (parsed && parsed->port) return *parsed;
  }
  throw std::runtime_error("no address of a web server: " + url);
}

}  // namespace

std::map<std::string, double> readServerMetrics(const std::string& url) {
  const HostPort address = parseUrl(url);
  boost::asio::io_context context;
  boost::beast::tcp_stream stream(context);
  stream.connect(tcp::resolver(context).resolve(address.host, std::to_string(*address.port)));
  http::request<http::empty_body> request(http::verb::get, "/metrics", 11);
  request.set(http::field::host, address.host);
  request.keep_alive(false);
  http::write(stream, request);
  boost::beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(stream, buffer, response);

  std::map<std::string, double> values;
  std::istringstream lines(response.body());
  for (std::string line; std::getline(lines, line);) {
    const size_t space = line.rfind(' ');
    if (line.empty() || line.front() == '#' || space == std::string::npos) continue;
    values[line.substr(0, space)] = std::stod(line.substr(space + 1));
  }
  return values;
}

}  // namespace viewloom::load
