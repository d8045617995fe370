// SPDX-License-Identifier: Apache-2.0
// Shows one stream in a window, from the first atlas to the key that ends it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/status.h"
#include "calibration/calibration.h"
#include "lib/channel.h"
#include "lib/retry_loop.h"
#include "show/show_settings.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::show {

struct SessionOptions {
  std::string stream;
  v1::Display display;  // of every mode but kNative
  v1::AtlasEncoding encoding;
  std::optional<Calibration> calibration;
  std::string eye_file;  // of EyeFeed, for a tracked display; "" = the eyes are the display's own
  ShowSettings settings;
  // The settings' mode is kNative until the server has been asked which suits a panel; what came
  // of it is said.
  bool is_mode_open = false;
  std::optional<int> monitor;
  bool is_windowed = false;
};

// Called from any thread.
struct SessionCallbacks {
  std::function<bool()> is_interrupted;
  std::function<void(const std::string&)> say;  // a line for the user
  OnConnection on_connection;
};

// Returns when the user ends it: OK. INVALID_ARGUMENT: no such monitor, px that are no px of the
// panel, or eyes that cannot be read; FAILED_PRECONDITION: no screen; else what the server ended
// the call with. Where the server does not interlace, quilts are woven here instead. Main thread.
// server: its address, which says what encoding suits the way to it.
absl::Status showStream(std::shared_ptr<grpc::Channel> channel, const std::string& server,
                        const SessionOptions& options, const SessionCallbacks& callbacks);

}  // namespace viewloom::show
