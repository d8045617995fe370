// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.h"

#include <csignal>

namespace viewloom::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void onSignal(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catchInterrupts() {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  // A file that reaches the largest size allowed is a failed write, not the end of the command.
  std::signal(SIGXFSZ, SIG_IGN);
}

void leaveInterrupts() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool isInterrupted() {
  return interrupted != 0;
}

}  // namespace viewloom::cli
