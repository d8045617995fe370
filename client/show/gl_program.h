// SPDX-License-Identifier: Apache-2.0
// A vertex and a fragment shader, linked, and values for their uniforms.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/status.h"

namespace viewloom::show {

// Thread-safety: main thread, with the context that it was made in.
class GlProgram {
 public:
  // INTERNAL with the driver's message when it takes a shader for wrong.
  static absl::StatusOr<GlProgram> make(std::string_view vertex, std::string_view fragment,
                                        bool is_gles);
  ~GlProgram();
  GlProgram(GlProgram&& other) noexcept;
  GlProgram& operator=(GlProgram&&) = delete;

  // Draws follow with this program; set() speaks of the one used last.
  void use() const;
  void set(const char* name, uint32_t value) const;
  void set(const char* name, std::span<const uint32_t> values) const;
  void set(const char* name, std::array<uint32_t, 2> value) const;
  void set(const char* name, float value) const;
  void set(const char* name, std::array<float, 2> value) const;
  void set(const char* name, std::array<float, 4> value) const;

 private:
  explicit GlProgram(uint32_t program) : program_(program) {}
  int locationOf(const char* name) const;

  uint32_t program_ = 0;
};

}  // namespace viewloom::show
