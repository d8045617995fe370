// SPDX-License-Identifier: Apache-2.0
// Whether the scene's depth suits the display: shown where the server says it with its atlases.
import {allow} from './allowed.js';

const kDegPerRad = 180 / Math.PI;
const kSameShare = 0.005;  // less is not seen

const byId = (id) => document.getElementById(id);
const isNear = (a, b) => Math.abs(a / b - 1) < kSameShare;
const percent = (share) => `${(100 * share).toFixed(1)} %`;

export class DepthBudget {
  #suggested = {};

  // onTake({focal_distance_m, view_cone_rad}): the suggestion shall be followed
  constructor(onTake) {
    byId('budget-take').addEventListener('click', () => onTake(this.#suggested));
  }

  // budget: depth_budget of an atlas's header, or undefined; layout: its own
  show(budget, layout) {
    byId('budget').hidden = !budget;
    if (!budget) return;
    const focus_m = budget.suggested_focal_distance_m;
    const cone_deg = budget.suggested_view_cone_rad * kDegPerRad;
    const ghosting = budget.beyond_ghosting_share;
    const unfused = Math.max(0, budget.beyond_fusing_share - ghosting);
    const shares = {fuses: 1 - unfused - ghosting, unfused, ghosts: ghosting};
    for (const [part, share] of Object.entries(shares)) {
      byId(`budget-${part}`).style.width = `${100 * share}%`;
    }
    byId('budget-disparity').textContent = `${budget.disparity_max_px.toFixed(1)} px`;
    byId('budget-fusing').textContent = percent(budget.beyond_fusing_share);
    byId('budget-ghosting').textContent = percent(ghosting);
    byId('budget-take').textContent =
        `Take focus ${focus_m.toFixed(2)} m, cone ${cone_deg.toFixed(0)}°`;
    const isTaken = isNear(focus_m, layout.focal_distance_m) &&
        isNear(budget.suggested_view_cone_rad, layout.view_cone_rad);
    allow(byId('budget-take'), isTaken ? 'Focus and cone are as suggested.' : '');
    this.#suggested = {
      focal_distance_m: Number(focus_m.toPrecision(4)),
      view_cone_rad: Number(budget.suggested_view_cone_rad.toPrecision(4)),
    };
  }
}
