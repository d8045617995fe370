// SPDX-License-Identifier: Apache-2.0
// Frames as clients are told of them → proto: accepted limits, and measurements. These are
// coverage, stage times, depth statistics and budget, and the report of a frame.
#pragma once

#include "display/depth_budget.h"
#include "display/views_outside.h"
#include "frame/frame_sink.h"
#include "frame/limits.h"
#include "frame/stage_times.h"
#include "viewloom/v1/atlas.pb.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

v1::PublishAccepted limitsToProto(const FrameLimits& limits);

// Shares of all rays; all zero when there were none.
v1::Coverage coverageToProto(const Coverage& coverage);
v1::ReflectionShares reflectionsToProto(const ReflectionCounts& counts);
v1::StageTimes timesToProto(const StageTimes& times);
v1::DepthBudget budgetToProto(const DepthBudget& budget);
v1::ViewsOutside outsideToProto(const ViewsOutside& views);
v1::SourceStats statsToProto(const SourceStats& stats);
v1::FrameReport reportToProto(const FrameReport& report);

}  // namespace viewloom
