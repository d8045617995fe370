// SPDX-License-Identifier: Apache-2.0
// Constants that kernels are specialised to, by constant_id: one list for C++ and GLSL. A constant
// means the same in every kernel that has it. ComputePass checks that a kernel is given what it
// has.
#ifndef VIEWLOOM_SHADERS_SHARED_KERNEL_CONSTANTS_H_
#define VIEWLOOM_SHADERS_SHARED_KERNEL_CONSTANTS_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

// bool: the structure is larger than a texel binding, and divided by layer
VIEWLOOM_ABI_CONST uint kIdReadsByAddress = 0u;
// bool: what is written is larger than a storage binding
VIEWLOOM_ABI_CONST uint kIdWritesByAddress = 1u;
VIEWLOOM_ABI_CONST uint kIdWanted = 2u;               // uint: kWant... flags
VIEWLOOM_ABI_CONST uint kIdColorFormat = 3u;          // uint: kColor... of what is read
VIEWLOOM_ABI_CONST uint kIdColorIsScaled = 4u;        // bool: it has another size than depth
VIEWLOOM_ABI_CONST uint kIdRays = 5u;                 // uint: kRaysOf..., who makes them
VIEWLOOM_ABI_CONST uint kIdThroughLens = 6u;          // bool
VIEWLOOM_ABI_CONST uint kIdIsCubeFace = 7u;           // bool: the structure is one
VIEWLOOM_ABI_CONST uint kIdPixelsPerInvocation = 8u;  // uint: of a run
// bool: neighbouring invocations are neighbouring views
VIEWLOOM_ABI_CONST uint kIdLanesAreViews = 9u;
VIEWLOOM_ABI_CONST uint kIdRaysArePlain = 10u;     // bool: see raysArePlain()
VIEWLOOM_ABI_CONST uint kIdEyesInPlane = 11u;      // bool: see eyesAreInPlane()
VIEWLOOM_ABI_CONST uint kIdIsOneOfSeveral = 12u;   // bool: structures that are asked
VIEWLOOM_ABI_CONST uint kIdShownBeside = 13u;      // uint: kShows... flags of some tile
VIEWLOOM_ABI_CONST uint kIdIsOfBlocks = 14u;       // bool: px of blocks that are listed
VIEWLOOM_ABI_CONST uint kIdListsHidden = 15u;      // bool: px whose ray ends behind something
VIEWLOOM_ABI_CONST uint kIdRaysOfHidden = 16u;     // uint: of listed px, the mean of so many
VIEWLOOM_ABI_CONST uint kIdListsUnfinished = 17u;  // bool: runs that go on in groups of their own
VIEWLOOM_ABI_CONST uint kIdIsExact = 18u;          // bool: rays that may be hidden are walked
VIEWLOOM_ABI_CONST uint kIdIsAlongY = 19u;         // bool: means along the columns, else the rows
VIEWLOOM_ABI_CONST uint kIdTapCount = 20u;         // int: samples to each side
VIEWLOOM_ABI_CONST uint kIdStripPx = 21u;  // int: px of an invocation, a power of two, at most 32
VIEWLOOM_ABI_CONST uint kIdIs420 = 22u;    // bool: chroma of 4:2:0, else 4:4:4
VIEWLOOM_ABI_CONST uint kIdLayerCount = 23u;      // uint
VIEWLOOM_ABI_CONST uint kIdSampleType = 24u;      // uint: kDepthSample..., of all layers
VIEWLOOM_ABI_CONST uint kIdHasRayDistance = 25u;  // bool: some layer states distances along rays
// From here on: constants of kernels outside the product.
VIEWLOOM_ABI_CONST uint kIdFree = 40u;

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_KERNEL_CONSTANTS_H_
