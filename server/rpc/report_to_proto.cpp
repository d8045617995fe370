// SPDX-License-Identifier: Apache-2.0
#include "rpc/report_to_proto.h"

#include "base/check.h"

namespace viewloom {
namespace {

v1::FrameOutcome outcomeToProto(FrameOutcome outcome) {
  switch (outcome) {
    case FrameOutcome::kTraced:
      return v1::FRAME_OUTCOME_TRACED;
    case FrameOutcome::kBuiltWithoutDisplay:
      return v1::FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY;
    case FrameOutcome::kReplaced:
      return v1::FRAME_OUTCOME_REPLACED;
    case FrameOutcome::kRefused:
      return v1::FRAME_OUTCOME_REFUSED;
    case FrameOutcome::kUnchanged:
      return v1::FRAME_OUTCOME_UNCHANGED;
  }
  VIEWLOOM_CHECK(false && "unknown FrameOutcome");
  return v1::FRAME_OUTCOME_UNSPECIFIED;
}

}  // namespace

v1::PublishAccepted limitsToProto(const FrameLimits& limits) {
  v1::PublishAccepted proto;
  proto.set_frame_bytes_max(limits.frame_bytes_max);
  proto.set_plane_side_px_max(limits.plane_side_px_max);
  proto.set_layer_count_max(limits.layer_count_max);
  proto.set_source_count_max(limits.source_count_max);
  return proto;
}

v1::Coverage coverageToProto(const Coverage& coverage) {
  v1::Coverage proto;
  const auto all = static_cast<double>(coverage.rayCount());
  if (all == 0) return proto;
  proto.set_hit(static_cast<double>(coverage.hit) / all);
  proto.set_hit_assumed(static_cast<double>(coverage.hit_assumed) / all);
  proto.set_hidden(static_cast<double>(coverage.hidden) / all);
  proto.set_outside(static_cast<double>(coverage.outside) / all);
  proto.set_empty(static_cast<double>(coverage.empty) / all);
  return proto;
}

v1::ReflectionShares reflectionsToProto(const ReflectionCounts& counts) {
  v1::ReflectionShares proto;
  const auto all = static_cast<double>(counts.rayCount());
  if (all == 0) return proto;
  proto.set_hit(static_cast<double>(counts.hit) / all);
  proto.set_assumed(static_cast<double>(counts.assumed) / all);
  proto.set_back(static_cast<double>(counts.back) / all);
  proto.set_cube(static_cast<double>(counts.cube) / all);
  proto.set_environment(static_cast<double>(counts.environment) / all);
  proto.set_bent(static_cast<double>(counts.bent) / all);
  return proto;
}

v1::StageTimes timesToProto(const StageTimes& times) {
  v1::StageTimes proto;
  proto.set_receive_ns(times.receive_ns);
  proto.set_decode_ns(times.decode_ns);
  proto.set_upload_ns(times.upload_ns);
  proto.set_build_ns(times.build_ns);
  proto.set_retime_ns(times.retime_ns);
  proto.set_wait_ns(times.wait_ns);
  proto.set_trace_ns(times.trace_ns);
  proto.set_encode_ns(times.encode_ns);
  proto.set_total_ns(times.total_ns);
  return proto;
}

v1::DepthBudget budgetToProto(const DepthBudget& budget) {
  v1::DepthBudget proto;
  proto.set_disparity_max_px(budget.disparity_max_px);
  proto.set_beyond_fusing_share(budget.beyond_fusing_share);
  proto.set_beyond_ghosting_share(budget.beyond_ghosting_share);
  proto.set_suggested_focal_distance_m(budget.suggested_focal_distance_m);
  proto.set_suggested_view_cone_rad(budget.suggested_view_cone_rad);
  return proto;
}

v1::ViewsOutside outsideToProto(const ViewsOutside& views) {
  v1::ViewsOutside proto;
  proto.set_first_view(views.first_view);
  proto.set_last_view(views.last_view);
  proto.set_share(views.share);
  return proto;
}

v1::SourceStats statsToProto(const SourceStats& stats) {
  v1::SourceStats proto;
  proto.set_depth_step(stats.depth_step);
  proto.set_noise_sigma(stats.noise_sigma);
  proto.set_connection_tolerance(stats.connection_tolerance);
  proto.set_bad_samples_count(stats.bad_samples_count);
  proto.set_unsorted_columns_count(stats.unsorted_columns_count);
  proto.set_bad_normals_count(stats.bad_normals_count);
  proto.set_bad_motions_count(stats.bad_motions_count);
  proto.set_inv_z_min(stats.inv_z_min);
  proto.set_inv_z_max(stats.inv_z_max);
  return proto;
}

v1::FrameReport reportToProto(const FrameReport& report) {
  v1::FrameReport proto;
  proto.set_number(report.number);
  proto.set_outcome(outcomeToProto(report.outcome));
  proto.set_reason(report.reason);
  proto.set_note(report.note);
  for (const DisplayReport& display : report.displays) {
    v1::DisplayReport& entry = *proto.add_displays();
    entry.set_display_id(display.display_id);
    *entry.mutable_coverage() = coverageToProto(display.coverage);
    *entry.mutable_times() = timesToProto(display.times);
  }
  const bool built = report.outcome == FrameOutcome::kTraced ||
                     report.outcome == FrameOutcome::kBuiltWithoutDisplay ||
                     report.outcome == FrameOutcome::kUnchanged;
  if (built) *proto.mutable_stats() = statsToProto(report.stats);
  return proto;
}

}  // namespace viewloom
