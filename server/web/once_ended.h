// SPDX-License-Identifier: Apache-2.0
// How coroutines end that nobody awaits.
#pragma once

#include <exception>
#include <functional>
#include <utility>

#include "admission/request_boundary.h"

namespace viewloom {

// The end of a coroutine that nobody awaits. Where an exception left it, what it served ends, by
// the call that is given; others go on.
class OnceEnded {
 public:
  explicit OnceEnded(std::function<void()> give_up = [] {}) : give_up_(std::move(give_up)) {}

  void operator()(const std::exception_ptr& error) const {
    if (!error) return;
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& thrown) {
      noteThrown("a connection", thrown);
      give_up_();
    }
  }

 private:
  std::function<void()> give_up_;
};

}  // namespace viewloom
