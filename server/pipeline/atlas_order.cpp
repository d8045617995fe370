// SPDX-License-Identifier: Apache-2.0
#include "pipeline/atlas_order.h"

#include "base/str_cat.h"
#include "engine/engines.h"
#include "pipeline/aim.h"

namespace viewloom {

std::string nameOf(const Payers& payers) {
  std::string names;
  for (const Payer& payer : payers) names += strCat(payer.name(), " ");
  return names;
}

AtlasOrder orderOf(const AtlasRun& run, size_t engine) {
  AtlasOrder order{.picture = run.picture,
                   .plan = run.plan,
                   .frames = {},
                   .strips = run.strips,
                   .planes = run.planes,
                   .is_for_eyes = run.isTracked(),
                   .picture_key = run.job.picture_key,
                   .payer = nameOf(run.claim.payers),
                   .note_work = nullptr};
  for (const ResidentStructure* structure : structuresOf(run.job)) {
    order.frames.push_back(structure->forms->of(engine));
  }
  return order;
}

}  // namespace viewloom
