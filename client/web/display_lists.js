// SPDX-License-Identifier: Apache-2.0
// The lists beside the picture: a lens before every view, in focus at the focal plane; atlases
// between the frames of a stream; how much is spent on all of it.
import {allow, kNoPicture} from './allowed.js';

const kRate_hz = 60;
const kModes = {predict: 'TEMPORAL_MODE_PREDICT', interpolate: 'TEMPORAL_MODE_INTERPOLATE'};
const kQualities = {draft: 'QUALITY_DRAFT', best: 'QUALITY_BEST'};

const kSharp = 'This display is sharp all over: it has no focal plane.';

const nameOf = (words, value) => Object.keys(words).find((name) => words[name] === value);

// Each a select: the path of its field, which choice a value of the field is (added where there is
// no such option, `named` so), and the value that a choice stands for; null = the default.
const kLists = {
  lens: {
    path: 'effects.lens',
    chosen: (lens) => lens.automatic_aperture ? 'auto' : String(lens.aperture_radius_m),
    named: (choice) => `${choice} m`,
    value: (choice) => choice === 'auto' ? {automatic_aperture: true} :
      {aperture_radius_m: Number(choice)},
  },
  between: {
    path: 'effects.temporal',
    chosen: (temporal) => nameOf(kModes, temporal.mode) ?? 'predict',
    named: (choice) => choice,
    value: (choice) => ({output_rate_hz: kRate_hz, mode: kModes[choice]}),
  },
  effort: {
    path: 'quality',
    chosen: (quality) => nameOf(kQualities, quality),
    named: (choice) => choice,
    value: (choice) => kQualities[choice],
  },
};

export class DisplayLists {
  #chosen = null;

  // onChange(changes): of the display's fields by path; null = the default
  constructor(onChange) {
    allow(document.getElementById('lens'), kNoPicture);
    for (const [id, {path, value}] of Object.entries(kLists)) {
      document.getElementById(id).addEventListener('change', ({target}) => {
        const changes = {[path]: target.value ? value(target.value) : null};
        this.#chosen.set(changes);
        onChange(changes);
      });
    }
  }

  // DisplayDocument of the chosen display
  showChosen(chosen) {
    this.#chosen = chosen;
    for (const [id, list] of Object.entries(kLists)) {
      const field = chosen.get(list.path);
      const choice = field === undefined ? '' : list.chosen(field) ?? '';
      const select = document.getElementById(id);
      const isListed = [...select.options].some(({value}) => value === choice);
      if (!isListed) select.add(new Option(list.named(choice), choice));
      select.value = choice;
    }
  }

  // Shows the values of the newest atlas: colour with depth is sharp.
  show(layout) {
    const isSharp = !(layout.view_cone_rad > 0);
    allow(document.getElementById('lens'), isSharp ? kSharp : '');
  }
}
