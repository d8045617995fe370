// SPDX-License-Identifier: Apache-2.0
// The lists beside the picture: a lens before every view, in focus at the focal plane; atlases
// between the frames of a stream; how much is spent on all of it.
import {keepInAddress, pageParameters} from './address.js';

const kRate_hz = '60';

// Each a select: what of it the parameters choose, which it adds where it has no such option
// (`named` so), and the parameters of /ws that a choice stands for; null = the default.
const kLists = {
  lens: {
    chosen: (parameters) => parameters.get('aperture_m'),
    named: (value) => `${value} m`,
    changes: (value) => ({aperture_m: value || null}),
  },
  between: {
    chosen: (parameters) => parameters.has('rate_hz') && (parameters.get('between') ?? 'predict'),
    named: (value) => value,
    changes: (value) => ({rate_hz: value && kRate_hz || null, between: value || null}),
  },
  effort: {
    chosen: (parameters) => parameters.get('effort'),
    named: (value) => value,
    changes: (value) => ({effort: value || null}),
  },
};

function connect(select, {chosen, named, changes}, onChange) {
  const value = chosen(pageParameters());
  if (value) {
    const isListed = [...select.options].some((option) => option.value === value);
    if (!isListed) select.add(new Option(named(value), value));
    select.value = value;
  }
  select.addEventListener('change', () => {
    const parameters = changes(select.value);
    keepInAddress(parameters);
    onChange(parameters);
  });
}

export class DisplayLists {
  // onChange(parameters): of /ws; null = the default
  constructor(onChange) {
    for (const [id, list] of Object.entries(kLists)) {
      connect(document.getElementById(id), list, onChange);
    }
  }

  // What the newest atlas was made with: colour with depth is sharp.
  show(layout) {
    document.getElementById('lens').disabled = !(layout.view_cone_rad > 0);
  }
}
