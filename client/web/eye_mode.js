// SPDX-License-Identifier: Apache-2.0
// Lenticular simulator: what an eye sees of the woven panel, from where it is dragged to.
import {allow} from './allowed.js';
import {parseCalibration} from './calibration.js';
import {kSamplePanels} from './sample_panels.js';

const kMetresPerInch = 0.0254;
// The panel's height fills 14 degrees at the distance it is made for: the vendor's default camera.
const kFieldOfView_rad = 14 * Math.PI / 180;
const kReach = 0.75;  // cones to either side of the middle that the eye can be dragged to
const kKeyStep = 1 / 96;  // of a cone

const byId = (id) => document.getElementById(id);

export class EyeMode {
  #position = 0;  // in cones from the middle, at the distance that the panel is made for
  #own = () => null;

  // ownCalibration(): the device's, or null; onChange(): another picture
  constructor(weaver, ownCalibration, onChange) {
    this.weaver = weaver;
    this.#own = ownCalibration;
    this.onChange = onChange;
    const canvas = weaver.canvas;
    canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener('pointermove', (event) => {
      if (event.pointerType !== 'mouse' && event.buttons === 0) return;
      const box = canvas.getBoundingClientRect();
      this.#move(2 * kReach * ((event.clientX - box.left) / box.width - 0.5));
    });
    canvas.addEventListener('keydown', (event) => this.#key(event));
    for (const id of ['eye-position', 'eye-distance', 'eye-blur', 'eye-zoom', 'eye-bare']) {
      byId(id).addEventListener('input', () => this.#read());
    }
    byId('eye-panel').addEventListener('change', () => this.onChange());
    this.#read();
  }

  // Throws an Error with one sentence where the browser cannot weave.
  async enter() {
    const names = kSamplePanels.map(({name}, index) => new Option(name, index));
    const own = this.#own();
    if (own) names.unshift(new Option(`own: ${own.serial || 'visual.json'}`, 'own'));
    const before = byId('eye-panel').value;
    byId('eye-panel').replaceChildren(...names);
    if (names.some(({value}) => value === before)) byId('eye-panel').value = before;
    await this.weaver.prepare();
    this.#read();
  }

  resize(canvas_px) {
    this.canvas_px = canvas_px;
  }

  draw(atlas) {
    const {canvas} = this.weaver;
    const {width, height} = this.canvas_px;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    const calibration = this.#calibration();
    this.weaver.calibration = calibration;
    const {screen_px} = calibration;
    const fit = Math.max(screen_px.width / width, screen_px.height / height);
    this.weaver.drawEye(atlas, {
      eye: this.#eye(calibration),
      blur: byId('eye-blur').valueAsNumber,
      panel_px_per_px: fit / byId('eye-zoom').valueAsNumber,
      is_bare: byId('eye-bare').checked,
    });
  }

  // One for each choice: the weaver knows by it whether the panel is another.
  #calibration() {
    const chosen = byId('eye-panel').value;
    if (chosen === 'own') return this.#own();
    const sample = kSamplePanels[Number(chosen)];
    return sample.calibration ??= parseCalibration(sample.text);
  }

  // The view coordinate that goes to the eye from the panel's middle, and its change per px. Made
  // for distance D, coordinate s of any lens goes to x = (2 s - 1) D tan(cone / 2). A ray from X
  // on the panel to an eye at E in the distance r D is at X + (E - X) / r there.
  #eye({screen_px, dpi, view_cone_deg}) {
    const metres_per_px = kMetresPerInch / dpi;
    const distance_m = screen_px.height * metres_per_px / 2 / Math.tan(kFieldOfView_rad / 2);
    const cone_m = 2 * distance_m * Math.tan(view_cone_deg * Math.PI / 360);
    const ratio = byId('eye-distance').valueAsNumber;
    return [0.5 + this.#position, metres_per_px / cone_m * (1 - 1 / ratio)];
  }

  #key(event) {
    const steps = {ArrowLeft: -1, ArrowRight: 1, PageDown: -8, PageUp: 8}[event.key];
    const ends = {Home: -0.5, End: 0.5}[event.key];
    if (steps === undefined && ends === undefined) return;
    event.preventDefault();
    this.#move(ends ?? this.#position + steps * kKeyStep);
  }

  #move(position) {
    byId('eye-position').valueAsNumber = position;
    this.#read();
  }

  #read() {
    const isBare = byId('eye-bare').checked;
    for (const id of ['eye-position', 'eye-distance', 'eye-blur']) {
      allow(byId(id), isBare ? 'Without the lens, the panel looks the same from everywhere.' : '');
    }
    this.#position = byId('eye-position').valueAsNumber;
    const position = `${(100 * this.#position).toFixed(0)} %`;
    byId('eye-position').setAttribute('aria-valuetext', `${position} of the cone from its middle`);
    byId('eye-distance').setAttribute(
        'aria-valuetext', `${byId('eye-distance').value} of the designed distance`);
    byId('eye-position-value').textContent = position;
    byId('eye-distance-value').textContent = `${byId('eye-distance').valueAsNumber.toFixed(2)} ×`;
    byId('eye-blur-value').textContent = `${(100 * byId('eye-blur').valueAsNumber).toFixed(1)} %`;
    byId('eye-zoom-value').textContent = `${byId('eye-zoom').value} ×`;
    this.onChange();
  }
}
