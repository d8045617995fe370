// SPDX-License-Identifier: Apache-2.0
// Colour with depth as a display: which kind of it, of how many px, and where its screen is.

// Values of the picker for what no preset names: the prefix, and the form as in proto.
const kPrefix = 'rgbd:';
const kUsualForm = 'RGBD_FORM_COLOR_DEPTH';
const kForms = {
  [kUsualForm]: 'Colour beside depth', 'RGBD_FORM_TWO_LAYERS': 'Two layers in four quadrants',
};
const kUsual_px = {width: 960, height: 540};  // a view, where nothing says

const byId = (id) => document.getElementById(id);

export class RgbdChoice {
  #fields = {};

  // onChange(fields): of an RgbdDisplay
  constructor(onChange) {
    byId('rgbd').addEventListener('submit', (event) => {
      event.preventDefault();
      const [width, height, screen_m] =
          ['width', 'height', 'screen_m'].map((name) => byId(`rgbd-${name}`).valueAsNumber);
      const {screen_m: _, ...fields} = this.#fields;
      if (screen_m) fields.screen_m = screen_m;
      onChange({...fields, view_size: {width, height}});
    });
  }

  // presets: those of this kind
  options(presets) {
    return [...presets.map(({name, device}) => new Option(device, name)),
      ...Object.entries(kForms).map(([form, text]) => new Option(text, kPrefix + form))];
  }

  // Value of the picker where no preset is named.
  valueOf(form) {
    return kPrefix + (form ?? kUsualForm);
  }

  isForm(value) {
    return value.startsWith(kPrefix);
  }

  // Fields for a value of the picker.
  chosen(value) {
    const named = this.isForm(value) ? {form: value.slice(kPrefix.length)} : {preset: value};
    return {...named, view_size: kUsual_px};
  }

  // fields: of the RgbdDisplay, null = another kind; note: of the preset, if it is one
  show(fields, note) {
    byId('rgbd').hidden = fields === null;
    this.#fields = fields ?? {};
    const {view_size, screen_m} = this.#fields;
    byId('rgbd-width').value = view_size?.width ?? '';
    byId('rgbd-height').value = view_size?.height ?? '';
    byId('rgbd-screen_m').value = screen_m ?? '';
    byId('rgbd-note').textContent = note ?? '';
  }
}
