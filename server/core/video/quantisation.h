// SPDX-License-Identifier: Apache-2.0
// Quantisation (QP) of H.264 in encoders of viewloom. Each step of 6 doubles the error.
#pragma once

#include <cstdint>

namespace viewloom {

// Finest quantisation. Below 18, OpenH264 2.3.1 writes past its buffers where a picture is noise:
// it expects no more than 384 bytes a macroblock (tests/tried.md).
inline constexpr uint32_t kVideoQpMin = 20;
// The same of OpenH264 with variable length on several threads: they have no check of their own,
// and write past their buffers at 20.
inline constexpr uint32_t kThreadedQpMin = 24;
// Coarsest quantisation that H.264 has.
inline constexpr uint32_t kVideoQpMax = 51;

}  // namespace viewloom
