// SPDX-License-Identifier: Apache-2.0
// The newest good certificate of the server: its files are read again when they change.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "tls/tls_material.h"

namespace viewloom {

// Holds what was read last without an error. Thread-safety: current() may be called from any
// thread, look() from one.
class TlsStore {
 public:
  using WallClock = std::function<int64_t()>;  // seconds since 1970

  // Reads the files. Throws std::runtime_error, with the remedy, when they are not good.
  TlsStore(TlsFiles files, WallClock now_s);

  TlsMaterialPtr current() const;

  // Outcome of one look: nothing new, new files that are in use from now on, or new files that are
  // not good (INVALID_ARGUMENT), so that the older ones stay in use. Each change is told once.
  // Files that are not good are read again at each look: the process may have lacked descriptors,
  // or the day of a certificate comes.
  enum class Found : uint8_t { kNothing, kTaken };
  absl::StatusOr<Found> look();

 private:
  // For each file: device, inode, size, time of the last change in ns. A file that is missing has
  // zeros.
  using Signature = std::array<std::array<int64_t, 4>, 3>;
  Signature signature() const;

  const TlsFiles files_;
  const WallClock now_s_;
  mutable std::mutex mutex_;  // of current_
  TlsMaterialPtr current_;
  Signature judged_;
  Signature seen_;           // at the last look
  bool is_refused_ = false;  // those of judged_ were not good
};

// Looks at the files every two seconds, and logs what it finds. A certificate that ends within two
// weeks is logged once a day. Thread-safety: all methods may be called from any thread.
class TlsWatch {
 public:
  // Told what each look found, and when the certificate in use ends (seconds since 1970).
  using OnLook = std::function<void(const absl::StatusOr<TlsStore::Found>& found, int64_t end_s)>;

  // Throws std::runtime_error as TlsStore. `on_look` is called once here, later by the watch's own
  // thread.
  TlsWatch(TlsFiles files, OnLook on_look);

  TlsMaterialPtr current() const { return store_.current(); }

 private:
  void tell(const absl::StatusOr<TlsStore::Found>& found);

  TlsStore store_;
  const OnLook on_look_;
  std::optional<int64_t> reminded_s_;
  std::jthread thread_;  // the last member: it uses the others
};

}  // namespace viewloom
