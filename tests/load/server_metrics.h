// SPDX-License-Identifier: Apache-2.0
// Reads what a server offers to Prometheus.
#pragma once

#include <map>
#include <string>

namespace viewloom::load {

// Series to value, the series as written: viewloom_replaced_total{hand_over="decode"}. `url` is
// that of the server's page, "http://127.0.0.1:8080/". Throws std::exception when it does not
// answer.
std::map<std::string, double> readServerMetrics(const std::string& url);

}  // namespace viewloom::load
