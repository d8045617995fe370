// SPDX-License-Identifier: Apache-2.0
// Which display is watched: a preset of any kind, a quilt of one's own, or colour with depth; which
// of its views are, and in how much detail.
import {keepInAddress, pageParameters, watchedParameters} from './address.js';
import {eyeSteps, kQuiltSteps} from './detail_steps.js';
import {RgbdChoice} from './rgbd_choice.js';

const kDefaultPreset = 'portrait';
const kQuiltFields = ['columns', 'rows', 'width', 'height', 'aspect'];
// Views around the eye: as many as cost little, fewer where that is too much.
const kAroundEye = {look: [5, 3, 1], blend: [5, 3], single: [1]};
const kStart = 0.25;          // detail of all views, at first
const kWidthStep_px = 32;     // viewers of nearly one size share a display
const kWidthMax_px = 2048;
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
  #steps = '';  // of detail, as text

  // `seen`: which views, 'all', 'look' or 'blend' = a few around the eye, 'single', or 'middle' =
  // that one with its depth, as large as in the quilt.
  // autoDetail: says how much when that is automatic; eyeViews: which views there are around the
  // eye; frameOf(aspect): px of the screen that a view covers; onChange(): another display
  constructor(autoDetail, eyeViews, frameOf, onChange) {
    this.autoDetail = autoDetail;
    this.eyeViews = eyeViews;
    this.frameOf = frameOf;
    this.onChange = onChange;
    this.seen = 'all';
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
        group('Elemental images', ofKind('integral').map(({name, device}) =>
          new Option(device, name))),
        group('Colour with depth (RGBD, 2D+Z)', this.rgbd.options(ofKind('rgbd'))));
    const standard = parameters.has('columns') ? '' : kDefaultPreset;
    byId('preset').value = parameters.get('preset') ?? this.rgbd.valueOf(parameters) ?? standard;
    byId('detail').value = parameters.get('detail') ?? (parameters.has('width') ? '1' : 'auto');
    if (byId('detail').selectedIndex < 0) byId('detail').value = 'auto';  // none of the choices
    this.#showFields();
  }

  // 'quilt', 'integral' for elemental images, or 'rgbd' for colour with depth.
  get kind() {
    return this.rgbd.isForm(byId('preset').value) ? 'rgbd' : this.#preset()?.kind ?? 'quilt';
  }

  // Displays of other kinds are seen whole.
  get isQuilt() { return this.kind === 'quilt'; }

  get isAutomatic() { return byId('detail').value === 'auto'; }

  // As /ws takes it: which views, and how large; null = the default. To be sent whenever one of
  // them, the room for them, or the automatic detail is another.
  views() {
    const few = this.#viewsAroundEye();
    if (few) return few;
    this.#offer(kQuiltSteps, kQuiltSteps.findIndex(({detail}) => detail === kStart));
    const views = {cone_begin: null, cone_end: null, depth: pageParameters().get('depth')};
    for (const name of kQuiltFields) views[name] = pageParameters().get(name);
    const isMiddle = this.seen === 'middle' && this.isQuilt;
    for (const [side, count] of [['width', 'columns'], ['height', 'rows']]) {
      const full_px = this.#full(side);
      const tiles = isMiddle ? this.#value(count) : 1;
      if (full_px) views[side] = Math.max(1, Math.round(full_px * this.#detail / tiles));
    }
    if (isMiddle) {
      Object.assign(views, {columns: 1, rows: 1, depth: 1, aspect: this.#value('aspect') || null});
    }
    return views;
  }

  // The same with all of the display in it, as somebody else is to watch it.
  elsewhere(parameters) {
    const whole = new URLSearchParams(parameters);
    for (const name of [...kQuiltFields, 'cone_begin', 'cone_end', 'depth']) {
      const value = pageParameters().get(name);
      if (value === null) whole.delete(name);
      else whole.set(name, value);
    }
    return whole;
  }

  // As /ws takes them.
  parameters(stream) {
    const parameters = watchedParameters();
    parameters.set('stream', stream);
    if (this.#preset()) parameters.set('preset', this.#preset().name);
    for (const [name, value] of Object.entries(this.views())) {
      if (value === null) parameters.delete(name);
      else parameters.set(name, value);
    }
    return parameters;
  }

  // Width of a view in full detail, px; 0 = not known.
  get fullWidth_px() {
    const around = this.#aroundEye();
    const columns = this.isQuilt ? this.#value('columns') : 1;
    return around ? around.width_px : columns && Math.floor(this.#full('width') / columns);
  }

  get #detail() {
    return this.isAutomatic ? this.autoDetail.detail : Number(byId('detail').value);
  }

  // Where only views around the eye are seen: how many there are, and how large one is.
  #aroundEye() {
    const total = this.#value('columns') * this.#value('rows');
    const aspect = this.#value('aspect') ||
        Math.floor(this.#full('width') / this.#value('columns')) /
        Math.floor(this.#full('height') / this.#value('rows'));
    if (!(this.seen in kAroundEye) || !this.isQuilt || !total || !(aspect > 0)) return null;
    const covered_px = this.frameOf(aspect)[2];
    const width_px = Math.ceil(covered_px / kWidthStep_px) * kWidthStep_px;
    return {total, aspect, width_px: Math.min(kWidthMax_px, Math.max(kWidthStep_px, width_px))};
  }

  #viewsAroundEye() {
    const around = this.#aroundEye();
    if (!around) return null;
    const {total, aspect, width_px} = around;
    const counts = kAroundEye[this.seen];
    this.#offer(eyeSteps(counts, width_px), counts.length - 1);
    const wanted = this.isAutomatic ? this.autoDetail.views : counts[0];
    const count = Math.min(wanted, total);
    if (this.eyeViews.total !== total || this.eyeViews.count !== count) {
      this.eyeViews.spread(total, count);
    }
    const width = Math.max(1, Math.round(width_px * this.#detail));
    const height = Math.max(1, Math.round(width / aspect));
    return {columns: count, rows: 1, width: count * width, height, aspect, depth: null,
      ...this.eyeViews.part};
  }

  // Automatic detail begins anew where its steps are others.
  #offer(steps, start) {
    const text = JSON.stringify(steps);
    if (text === this.#steps) return;
    this.#steps = text;
    // Through a lens the first picture may take many times longer.
    this.autoDetail.begin(steps, pageParameters().has('aperture_m') ? steps.length - 1 : start);
  }

  // Of the quilt, by the address or the preset; 0 where neither says it.
  #value(name) {
    return Number(pageParameters().get(name) ?? this.#preset()?.[name] ?? 0);
  }

  // A side of the whole quilt, likewise.
  #full(side) {
    return Number(pageParameters().get(side) ?? this.#preset()?.size?.[side] ?? 0);
  }

  #preset() {
    return this.#presets.find(({name}) => name === byId('preset').value);
  }

  // A quilt of one's own begins as the preset that was chosen before it.
  #choose(name) {
    if (!this.isQuilt) {
      byId('detail').value = '1';
      // Elemental images have the size of their device.
      const chosen = this.kind === 'integral' ? {preset: name} : this.rgbd.chosen(name);
      this.#keep({...kNone, focus_follow_s: null, ...chosen, detail: '1'});
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
    this.rgbd.show(this.kind === 'rgbd', pageParameters(), this.#preset()?.note);
    byId('custom').hidden = byId('preset').value !== '';
    for (const name of kQuiltFields) {
      byId(`custom-${name}`).value = pageParameters().get(name) ?? '';
    }
  }
}
