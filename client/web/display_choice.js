// SPDX-License-Identifier: Apache-2.0
// Which display is watched: a preset, a quilt of one's own, or colour with depth, and in how much
// detail.
import {keepInAddress, pageParameters, watchedParameters} from './address.js';
import {RgbdChoice} from './rgbd_choice.js';

const kDefaultPreset = 'portrait';
const kQuiltFields = ['columns', 'rows', 'width', 'height', 'aspect'];
const kMiddle = {columns: 1, rows: 1, depth: 1};
const kNone = Object.fromEntries(
    [...kQuiltFields, 'preset', 'cone_deg', 'focus_m', 'rgbd', 'near_m', 'far_m', 'screen_m',
      'depth_side', 'black_near'].map((name) => [name, null]));

const byId = (id) => document.getElementById(id);

function group(label, options) {
  const element = document.createElement('optgroup');
  element.label = label;
  element.append(...options);
  return element;
}

export class DisplayChoice {
  #presets = [];
  #isMiddle = false;

  // autoDetail: says how much when that is automatic; onChange(): another display
  constructor(autoDetail, onChange) {
    this.autoDetail = autoDetail;
    this.onChange = onChange;
    this.rgbd = new RgbdChoice((parameters) => {
      byId('detail').value = '1';
      this.#keep({...parameters, detail: '1'});
    });
    byId('preset').addEventListener('change', ({target}) => this.#choose(target.value));
    byId('detail').addEventListener('change', ({target}) => {
      this.#keep({detail: target.value});
    });
    byId('custom').addEventListener('submit', (event) => {
      event.preventDefault();
      const fields = kQuiltFields.map((name) => [name, byId(`custom-${name}`).value || null]);
      byId('detail').value = '1';
      this.#keep({...kNone, ...Object.fromEntries(fields), detail: '1'});
    });
  }

  // presets: as /api/presets lists them
  show(presets) {
    this.#presets = presets;
    const parameters = pageParameters();
    const ofKind = (wanted) => presets.filter(({kind}) => kind === wanted);
    const quilts = ofKind('quilt').map(({name, device}) => new Option(device, name));
    byId('preset').replaceChildren(
        group('Quilts', [...quilts, new Option('custom quilt', '')]),
        group('Colour with depth (RGBD, 2D+Z)', this.rgbd.options(ofKind('rgbd'))));
    const standard = parameters.has('columns') ? '' : kDefaultPreset;
    byId('preset').value = parameters.get('preset') ?? this.rgbd.valueOf(parameters) ?? standard;
    byId('detail').value = parameters.get('detail') ?? (parameters.has('width') ? '1' : 'auto');
    if (byId('detail').selectedIndex < 0) byId('detail').value = 'auto';  // none of the choices
    this.#showFields();
  }

  // Whether it is colour with depth, and no quilt.
  get isRgbd() {
    return this.rgbd.isForm(byId('preset').value) || this.#preset()?.kind === 'rgbd';
  }

  get isAutomatic() { return byId('detail').value === 'auto'; }

  // The middle view alone, as large as in the quilt, with its depth.
  set isMiddle(isMiddle) {
    if (this.#isMiddle === isMiddle) return;
    this.#isMiddle = isMiddle;
    this.onChange();
  }

  // Width and height of the picture: the address's or the preset's, times the detail.
  size() {
    const parameters = pageParameters();
    const chosen = byId('detail').value;
    const detail = chosen === 'auto' ? this.autoDetail.detail : Number(chosen);
    const size = {};
    for (const [side, count] of [['width', 'columns'], ['height', 'rows']]) {
      const full_px = Number(parameters.get(side) ?? this.#preset()?.size?.[side]);
      const tiles = this.#isMiddle ? this.#value(count) : 1;
      if (full_px) size[side] = Math.max(1, Math.round(full_px * detail / tiles));
    }
    return size;
  }

  // As /ws takes them.
  parameters(stream) {
    const parameters = watchedParameters();
    parameters.set('stream', stream);
    if (this.#isMiddle) {
      const aspect = this.#value('aspect');
      if (aspect) parameters.set('aspect', aspect);
      parameters.delete('preset');
      for (const [name, value] of Object.entries(kMiddle)) parameters.set(name, value);
    } else if (this.#preset()) {
      parameters.set('preset', this.#preset().name);
    }
    for (const [side, length_px] of Object.entries(this.size())) parameters.set(side, length_px);
    return parameters;
  }

  // Of the quilt, by the address or the preset; 0 where neither says it.
  #value(name) {
    return Number(pageParameters().get(name) ?? this.#preset()?.[name] ?? 0);
  }

  #preset() {
    return this.#presets.find(({name}) => name === byId('preset').value);
  }

  // A quilt of one's own begins as the preset that was chosen before it.
  #choose(name) {
    if (this.isRgbd) {
      byId('detail').value = '1';
      this.#keep({...kNone, focus_follow_s: null, ...this.rgbd.chosen(name), detail: '1'});
      return;
    }
    if (name) {
      this.#keep({...kNone, preset: name});
      return;
    }
    const quilt = (wanted) => this.#presets.find((one) => one.kind === 'quilt' &&
                                                          one.name === wanted);
    const before = quilt(pageParameters().get('preset')) ?? quilt(kDefaultPreset);
    const {columns, rows, size, aspect} = before;
    this.#keep({...kNone, columns, rows, ...size, aspect});
    byId('custom-columns').focus();
  }

  #keep(changes) {
    keepInAddress(changes);
    this.#showFields();
    this.onChange();
  }

  #showFields() {
    this.rgbd.show(this.isRgbd, pageParameters(), this.#preset()?.note);
    byId('custom').hidden = byId('preset').value !== '';
    for (const name of kQuiltFields) {
      byId(`custom-${name}`).value = pageParameters().get(name) ?? '';
    }
  }
}
