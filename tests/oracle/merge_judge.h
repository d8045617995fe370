// SPDX-License-Identifier: Apache-2.0
// Says whether what several sources were merged to differs from the oracle's answer: only where no
// moved ray, surface or tolerance could excuse it.
#pragma once

#include <string>
#include <vector>

#include "oracle/judge.h"
#include "oracle/several_sources.h"

namespace viewloom::oracle {

// Thread-safety: none.
class MergeJudge {
 public:
  MergeJudge(std::vector<PosedSource> sources, double output_px);

  // `ray`: in the world, its direction one metre along the view's axis long.
  void consider(const ViewRay& ray, const MergedAnswer& tested, const std::string& where);
  const Verdict& verdict() const { return verdict_; }

 private:
  std::vector<SourceAnswer> answersTo(const ViewRay& ray) const;
  std::vector<SourceAnswer> answersOfMoved(size_t source, const ViewRay& ray,
                                           const std::vector<double>& view_inv_zs) const;
  std::vector<std::vector<SourceAnswer>> answersNearby(const ViewRay& ray,
                                                       const MergedAnswer& tested) const;

  const std::vector<PosedSource> sources_;
  const double output_px_;
  Verdict verdict_;
};

}  // namespace viewloom::oracle
