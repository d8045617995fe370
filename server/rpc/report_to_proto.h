// SPDX-License-Identifier: Apache-2.0
// What was measured → proto: coverage, stage times, depth statistics and budget, the report of a
// frame.
#pragma once

#include "display/depth_budget.h"
#include "display/views_outside.h"
#include "frame/frame_sink.h"
#include "frame/stage_times.h"
#include "viewloom/v1/atlas.pb.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// Shares of all rays; all zero when there were none.
v1::Coverage coverageToProto(const Coverage& coverage);
v1::ReflectionShares reflectionsToProto(const ReflectionCounts& counts);
v1::StageTimes timesToProto(const StageTimes& times);
v1::DepthBudget budgetToProto(const DepthBudget& budget);
v1::ViewsOutside outsideToProto(const ViewsOutside& views);
v1::SourceStats statsToProto(const SourceStats& stats);
v1::FrameReport reportToProto(const FrameReport& report);

}  // namespace viewloom
