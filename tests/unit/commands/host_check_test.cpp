// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "commands/doctor_checks.h"

namespace viewloom::host_check_test {
namespace {

std::string coresOf(const Processors& processors) {
  const Finding cores = checkHost(processors).front();
  EXPECT_EQ(cores.subject, "host");
  EXPECT_EQ(cores.verdict, Verdict::kFine);
  return cores.what;
}

TEST(CheckHost, countsCores) {
  EXPECT_EQ(coresOf({.allowed_count = 1, .quota = {}}), "1 core");
  EXPECT_EQ(coresOf({.allowed_count = 16, .quota = {}}), "16 cores");
  EXPECT_EQ(coresOf({.allowed_count = 16, .quota = 16}), "16 cores");
}

TEST(CheckHost, namesTheQuotaOfACgroup) {
  EXPECT_EQ(coresOf({.allowed_count = 16, .quota = 2}), "2 of 16 cores, limited by a cgroup");
  EXPECT_EQ(coresOf({.allowed_count = 1, .quota = 0.5}), "0.5 of 1 core, limited by a cgroup");
}

}  // namespace
}  // namespace viewloom::host_check_test
