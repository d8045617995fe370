// SPDX-License-Identifier: Apache-2.0
// Colour with depth as a display: which kind of it, of how many px, and where its screen is.

// Values of the picker for what no preset names: the prefix, and the form as /ws takes it.
const kPrefix = 'rgbd:';
const kForms = {'color-depth': 'Colour beside depth', 'two-layers': 'Two layers in four quadrants'};
const kUsual = {width: 960, height: 540};  // px of a view, where nothing says
const kFields = ['width', 'height', 'screen_m'];

const byId = (id) => document.getElementById(id);

export class RgbdChoice {
  // onChange(parameters): as /ws takes them, null = the default
  constructor(onChange) {
    byId('rgbd').addEventListener('submit', (event) => {
      event.preventDefault();
      const fields = kFields.map((name) => [name, byId(`rgbd-${name}`).value || null]);
      onChange(Object.fromEntries(fields));
    });
  }

  // presets: those of this kind
  options(presets) {
    return [...presets.map(({name, device}) => new Option(device, name)),
      ...Object.entries(kForms).map(([form, text]) => new Option(text, kPrefix + form))];
  }

  // What the picker stands at; undefined: at a preset, or at a quilt.
  valueOf(parameters) {
    return parameters.has('rgbd') && !parameters.has('preset') ?
      kPrefix + parameters.get('rgbd') : undefined;
  }

  isForm(value) {
    return value.startsWith(kPrefix);
  }

  // Parameters for a value of the picker.
  chosen(value) {
    return {...kUsual, ...this.isForm(value) ?
      {rgbd: value.slice(kPrefix.length)} : {preset: value}};
  }

  // note: of the preset, if it is one
  show(isShown, parameters, note) {
    byId('rgbd').hidden = !isShown;
    for (const name of kFields) byId(`rgbd-${name}`).value = parameters.get(name) ?? '';
    byId('rgbd-note').textContent = note ?? '';
  }
}
