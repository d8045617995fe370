// SPDX-License-Identifier: Apache-2.0
// Which display is watched: a preset of any kind, a quilt of one's own, or colour with depth; which
// of its views are, and in how much detail.
import {keepInAddress, pageParameters} from './address.js';
import {allow} from './allowed.js';
import {kQuiltSteps} from './detail_steps.js';
import {put} from './display_document.js';
import {kUsualCone_rad} from './eye_rig.js';
import {RgbdChoice} from './rgbd_choice.js';
import {acceptedEncodings, withColor} from './video_choice.js';

// Fields of the form for a quilt of one's own, by the names of their inputs.
const kQuiltFields = {
  'columns': 'columns', 'rows': 'rows', 'width': 'size.width', 'height': 'size.height',
  'aspect': 'aspect',
};
const kStart = 0.25;          // detail of all views, at first
const kModes = ['look', 'single', 'quilt', 'panel', 'eye', 'rgbd'];
// Modes of displays that are no quilts: they have one picture, and nothing to weave.
const kWholeModes = ['quilt', 'single'];
const kSizes = {quilt: 'size', rgbd: 'view_size'};  // fields of kinds that have any size
const kFixedSize = 'This display always has the size of its panel.';

const byId = (id) => document.getElementById(id);

function group(label, options) {
  const element = document.createElement('optgroup');
  element.label = label;
  element.append(...options);
  return element;
}

export class DisplayChoice {
  #document = null;
  #steps = '';  // of detail, as text

  // `seen`: which views, 'all', 'eye' = the one where the eye stands, or 'middle' = that one with
  // its depth, as large as in the quilt.
  // autoDetail: says how much when that is automatic; around: where the eye stands, and how large
  // its picture is; frameOf(aspect): px of the screen that a view covers; onChange(): another
  // display
  constructor(autoDetail, around, frameOf, onChange) {
    this.autoDetail = autoDetail;
    this.around = around;
    this.frameOf = frameOf;
    this.onChange = onChange;
    this.seen = 'all';
    this.rgbd = new RgbdChoice((fields) => this.#choose('rgbd', fields, '1'));
    byId('preset').addEventListener('change', ({target}) => this.#pick(target.value));
    byId('detail').addEventListener('change', ({target}) => {
      keepInAddress({detail: target.value});
      this.onChange();
    });
    byId('custom').addEventListener('submit', (event) => {
      event.preventDefault();
      const quilt = {};
      for (const [name, path] of Object.entries(kQuiltFields)) {
        const value = byId(`custom-${name}`).valueAsNumber;
        if (value) put(quilt, path, value);
      }
      this.#choose('quilt', quilt, '1');
    });
  }

  // chosen: the DisplayDocument
  show(chosen) {
    this.#document = chosen;
    const ofKind = (wanted) => chosen.presets.filter(({kinds}) => kinds[0] === wanted);
    const options = (presets) => presets.map(({name, device}) => new Option(device, name));
    byId('preset').replaceChildren(
        group('Quilts', [...options(ofKind('quilt')), new Option('custom quilt', '')]),
        group('Elemental images', options(ofKind('integral'))),
        group('Colour with depth (RGBD, 2D+Z)', this.rgbd.options(ofKind('rgbd'))));
    for (const [name, path] of Object.entries(kQuiltFields)) {
      Object.assign(byId(`custom-${name}`), chosen.ranges[`quilt.${path}`]);  // min, max
    }
    byId('detail').value = pageParameters().get('detail') ?? (this.#ownSize() ? '1' : 'auto');
    if (byId('detail').selectedIndex < 0) byId('detail').value = 'auto';  // none of the choices
    this.#showFields();
  }

  get kind() { return this.#document.kind; }

  // Displays of other kinds are seen whole.
  get isQuilt() { return this.kind === 'quilt'; }

  // Why there are no others.
  get modesReason() {
    return `${byId('preset').selectedOptions[0]?.text ?? 'This display'} has one picture: this ` +
        'needs the views of a quilt.';
  }

  // The ways to look at it.
  get modes() { return this.isQuilt ? kModes : kWholeModes; }

  get isAutomatic() { return byId('detail').value === 'auto'; }

  // The request in the form of /ws: {stream, display, encoding, accepted}. Its views are those that
  // are seen, in their size.
  // To be sent whenever one of them, the room for them, or the automatic detail is another.
  asked(stream) {
    const display = this.#document.whole;
    const encoding = this.#document.encoding;
    if (this.isEye) {
      return {stream, ...this.#eyes(display, encoding), accepted: acceptedEncodings()};
    }
    this.#takeAll(display, encoding);
    return {stream, display, encoding: withColor(encoding, this.seen === 'all'),
      accepted: acceptedEncodings()};
  }

  // The same picture for the eyes in a headset.
  inHeadset(stream, eye_size, count) {
    const {quilt, focus_following_s, ...others} = this.#document.whole;
    const layout = count === 1 ? 'STEREO_LAYOUT_SINGLE' : 'STEREO_LAYOUT_SIDE_BY_SIDE';
    const display = {...others, stereo: {layout, tracked: true, eye_size}};
    const encoding = {...withColor(this.#document.encoding, false), with_depth: true,
      planes: 'BAND_ENCODING_COMPACT_DEPTH'};
    return {stream, display, encoding};
  }

  // All of the display, as somebody else is to watch it.
  elsewhere(stream) {
    return {stream, display: this.#document.whole, encoding: this.#document.encoding};
  }

  // Width of a view in full detail, px; 0 = not known.
  get fullWidth_px() {
    if (this.isEye) return this.around.fullWidth_px;
    const columns = this.isQuilt ? this.#value('columns') : 1;
    return columns && Math.floor(this.#full('width') / columns);
  }

  get #detail() {
    return this.isAutomatic ? this.autoDetail.detail : Number(byId('detail').value);
  }

  // Whether only the eye's own view is seen: of quilts, whose cone says where eyes can be.
  get isEye() {
    return this.seen === 'eye' && this.isQuilt && this.#total > 0 && this.#aspect > 0;
  }

  get #total() { return this.#value('view_count') || this.#value('columns') * this.#value('rows'); }

  // Angle of the cone that a quilt's views share; 0 = there is none.
  get cone_rad() {
    return this.isQuilt ? this.#value('view_cone_rad') || kUsualCone_rad : 0;
  }

  // One view for one viewer: {display, encoding}. Focus stays where it is, because it would move
  // the frame of the picture with it.
  #eyes({quilt, focus_following_s, ...others}, encoding) {
    const [, , width, height] = this.frameOf(this.#aspect);
    this.around.cone = {count: this.#total, cone_rad: this.cone_rad,
      depthiness: quilt.depthiness, convention: quilt.convention};
    const fixed = this.isAutomatic ? null : Number(byId('detail').value);
    const display = this.around.asked(quilt, others, {width, height}, fixed);
    if (this.around.late.isOn) {
      Object.assign(encoding, {with_depth: true, planes: 'BAND_ENCODING_COMPACT_DEPTH'});
    }
    return {display, encoding: withColor(encoding, false)};
  }

  #takeAll(display, encoding) {
    this.#offer(kQuiltSteps, kQuiltSteps.indexOf(kStart));
    const field = kSizes[this.kind];
    if (!field) return;  // panels have the size of their device
    const isMiddle = this.seen === 'middle' && this.isQuilt;
    const side = (name, count) => this.#full(name) && Math.max(1, Math.round(
        this.#full(name) * this.#detail / (isMiddle ? this.#value(count) : 1)));
    const size = {width: side('width', 'columns'), height: side('height', 'rows')};
    if (size.width && size.height) display[this.kind][field] = size;
    if (!isMiddle) return;
    Object.assign(display.quilt, {columns: 1, rows: 1});
    if (this.#value('aspect')) display.quilt.aspect = this.#value('aspect');
    delete display.quilt.view_count;
    encoding.with_depth = true;
  }

  // Automatic detail begins anew where its steps are others.
  #offer(steps, start) {
    const text = JSON.stringify(steps);
    if (text === this.#steps) return;
    this.#steps = text;
    // Through a lens the first picture may take many times longer.
    const isBlurred = this.#document.get('effects.lens') !== undefined;
    this.autoDetail.begin(steps, isBlurred ? steps.length - 1 : start);
  }

  // A number of the quilt, from the display or its preset; 0 where neither says it.
  #value(name) {
    return this.#document.get(`quilt.${name}`) ?? this.#document.preset?.layout?.[name] ?? 0;
  }

  get #aspect() {
    return this.#value('aspect') ||
        Math.floor(this.#full('width') / this.#value('columns')) /
        Math.floor(this.#full('height') / this.#value('rows'));
  }

  #ownSize() {
    return this.#document.get(`${this.kind}.${kSizes[this.kind]}`);
  }

  // A side of the whole quilt, or of a view, likewise.
  #full(side) {
    return this.#ownSize()?.[side] ?? this.#document.preset?.layout?.size[side] ?? 0;
  }

  // A quilt of one's own begins as the preset that was chosen before it.
  #pick(value) {
    if (this.rgbd.isForm(value)) {
      this.#choose('rgbd', this.rgbd.chosen(value), '1');
      return;
    }
    const preset = this.#document.presetOf(value);
    const kind = preset?.kinds[0] ?? 'quilt';
    if (kind === 'rgbd') this.#choose(kind, this.rgbd.chosen(value), '1');
    else if (kind !== 'quilt') this.#choose(kind, {preset: value}, '1');
    else if (preset) this.#choose('quilt', {preset: value});
    else this.#customise();
  }

  #customise() {
    const before = this.isQuilt && this.#document.preset || this.#document.presetOf('portrait');
    const {columns, rows, size, aspect} = before.layout;
    this.#choose('quilt', {columns, rows, size, aspect});
    byId('custom-columns').focus();
  }

  #choose(kind, fields, detail = null) {
    this.#document.choose(kind, fields);
    if (detail) {
      byId('detail').value = detail;
      keepInAddress({detail});
    }
    this.#showFields();
    this.onChange();
  }

  #showFields() {
    const chosen = this.#document;
    allow(byId('detail'), this.kind in kSizes ? '' : kFixedSize);
    byId('quilt-name').textContent = this.isQuilt ? 'Quilt' : 'Whole picture';
    byId('preset').value = chosen.get(`${this.kind}.preset`) ??
        (this.kind === 'rgbd' ? this.rgbd.valueOf(chosen.get('rgbd.form')) : '');
    this.rgbd.show(this.kind === 'rgbd' ? chosen.get('rgbd') : null, chosen.preset?.note);
    byId('custom').hidden = !this.isQuilt || byId('preset').value !== '';
    for (const [name, path] of Object.entries(kQuiltFields)) {
      byId(`custom-${name}`).value = chosen.get(`quilt.${path}`) ?? '';
    }
  }
}
