// SPDX-License-Identifier: Apache-2.0
// Says which views look past the source, where the server says it with its atlases.
import {shownViews} from './stage.js';

const byId = (id) => document.getElementById(id);

// Never less than it is: 0.4 % is 1 %.
const percent = (share) => `${Math.ceil(100 * share - 1e-9)} %`;

// runs: views_outside of an atlas's header; layout: its own
function sentence(runs, layout) {
  const {total, first} = shownViews(layout);
  if (total === 1) return `It looks past the image of the source by ${percent(runs[0].share)}.`;
  const parts = runs.map(({first_view, last_view, share}) => {
    const which = first_view === last_view ? `view ${first + first_view}` :
        `views ${first + first_view}–${first + last_view}`;
    return `${which} by ${percent(share)}`;
  });
  return `Past the image of the source look ${parts.join(', ')}.`;
}

export class ViewsOutside {
  show(runs, layout) {
    const none = !runs || runs.length === 0;
    byId('outside').hidden = none;
    const text = none ? '' : sentence(runs, layout);
    // Screen readers speak of what is written, so nothing is written twice.
    if (byId('outside-text').textContent !== text) byId('outside-text').textContent = text;
  }
}
