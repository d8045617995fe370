// SPDX-License-Identifier: Apache-2.0
// How much the errors of a stack of views change from each view to the next.
#pragma once

#include <span>

#include "scoring/inner_part.h"

namespace viewloom::fidelity {

// got, truth: the same views, side by side in the order in which a viewer passes them; at least
// two. The mean over neighbouring views, pixels of the inner part and channels of
// |(got - truth) of the one view - (got - truth) of the next|, at the same pixel: what moves in
// the row slices through the stack of error pictures. An error that stays the same does not
// flicker; one that shows in one view alone counts twice. In 1/255 of the scored range.
double flicker(std::span<const ScoredImage> got, std::span<const ScoredImage> truth,
               const InnerPart& inner);

}  // namespace viewloom::fidelity
