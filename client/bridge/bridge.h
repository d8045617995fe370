// SPDX-License-Identifier: Apache-2.0
// Looking Glass Bridge, told over its HTTP interface which quilt to show.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"
#include "bridge/http_request.h"

namespace viewloom::bridge {

struct QuiltShape {
  uint32_t columns = 0;
  uint32_t rows = 0;
  uint32_t width_px = 0;  // of the whole
  uint32_t height_px = 0;
  double aspect = 0;  // of a view
};

// A quilt by its address, with all that a player has to know of it.
struct AddressedQuilt {
  std::string uri;
  uint32_t columns = 0;
  uint32_t rows = 0;
  uint32_t view_count = 0;
  double aspect = 0;
};

struct BridgeDisplay {
  int index = 0;
  std::string name;                         // hardware id, as LKG-P02283
  std::optional<QuiltShape> default_quilt;  // what the device says it wants
};

// Bridge takes PUT and JSON, and answers everything else with 200 and an empty body. Statuses say
// what came and what to do: UNAVAILABLE where nobody listens, DEADLINE_EXCEEDED, CANCELLED,
// FAILED_PRECONDITION for answers that no Bridge gives. Thread-safety: none; one owner.
class Bridge {
 public:
  Bridge(HttpAddress address, Patience patience);
  // Leaves the orchestration, if it was entered; within 0.3 s if the caller has given up.
  ~Bridge();
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  // First.
  absl::Status enter();
  // The light-field displays; FAILED_PRECONDITION when there is none.
  absl::StatusOr<std::vector<BridgeDisplay>> displays();
  // Makes the display show the quilt. Two playlists take turns, so that what stands is shown until
  // the next one is there.
  absl::Status play(const AddressedQuilt& quilt, int display_index);

 private:
  // The payload's value.
  absl::StatusOr<nlohmann::json> call(const std::string& endpoint, nlohmann::json arguments,
                                      const Patience& patience);
  absl::Status checkedCall(const std::string& endpoint, const nlohmann::json& arguments);
  std::string asked(const std::string& endpoint) const;

  const HttpAddress address_;
  const Patience patience_;
  std::string orchestration_;  // empty before enter()
  uint64_t play_count_ = 0;
};

}  // namespace viewloom::bridge
