// SPDX-License-Identifier: Apache-2.0
#include "load/server_metrics.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <sstream>
#include <stdexcept>

namespace viewloom::load {
namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;

struct HostPort {
  std::string host;
  std::string port;
};

HostPort parseUrl(const std::string& url) {
  constexpr std::string_view kScheme = "http://";
  const size_t colon = url.rfind(':');
  if (url.rfind(kScheme, 0) != 0 || colon < kScheme.size()) {
    throw std::runtime_error("no address of a web server: " + url);
  }
  const std::string port = url.substr(colon + 1, url.find('/', colon) - colon - 1);
  return {url.substr(kScheme.size(), colon - kScheme.size()), port};
}

}  // namespace

std::map<std::string, double> readServerMetrics(const std::string& url) {
  const HostPort address = parseUrl(url);
  boost::asio::io_context context;
  boost::beast::tcp_stream stream(context);
  stream.connect(tcp::resolver(context).resolve(address.host, address.port));
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
