// SPDX-License-Identifier: Apache-2.0
// A whole server with a publisher that stays.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <semaphore>
#include <utility>

#include "e2e/service_fixture.h"

namespace viewloom::test {

// The stream "scene" is there, and has no frame yet.
class PublishedStreamFixture : public ServiceFixture {
 protected:
  void SetUp() override {
    ServiceFixture::SetUp();
    if (IsSkipped()) return;
    PublisherCallbacks callbacks;
    callbacks.on_accepted = [this](const v1::PublishAccepted&) { accepted_.release(); };
    publisher_.emplace(makeChannel(service_->grpcAddress()),
                       PublisherOptions{.stream = "scene", .session_id = "", .backoff = {}},
                       std::move(callbacks));
    // Before that, nobody can open a display of the stream.
    ASSERT_TRUE(accepted_.try_acquire_for(kGiveUpAfter));
  }
  void TearDown() override {
    publisher_.reset();
    ServiceFixture::TearDown();
  }

  void publish(double time_s) { publisher_->offer(syntheticWireFrame({160, 90}, 2, time_s)); }

 private:
  std::counting_semaphore<> accepted_{0};
  std::optional<Publisher> publisher_;
};

}  // namespace viewloom::test
