// SPDX-License-Identifier: Apache-2.0
// Panel mode: the picture woven for a calibrated panel, px by px, and whether it gets there.
import {parseCalibration} from './calibration.js';
import {checkPanel} from './panel_check.js';

const kStored = 'viewloom.calibration';  // of the browser's storage: the file's text

const byId = (id) => document.getElementById(id);

export class PanelMode {
  #refusal = '';  // of a file
  #lack = '';     // of the browser
  #canvas_px = {width: 0, height: 0};
  #layout = null;
  #isOn = false;
  #isPrepared = false;

  // onChange(): another picture
  constructor(weaver, onChange) {
    this.weaver = weaver;
    this.onChange = onChange;
    this.calibration = null;
    byId('calibration').addEventListener('change', ({target}) => this.#read(target.files[0]));
    document.addEventListener('dragover', (event) => event.preventDefault());
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      this.#read(event.dataTransfer.files[0]);
    });
    document.addEventListener('fullscreenchange', () => this.#check());
    this.#restore();
  }

  async enter() {
    this.#isOn = true;
    await this.#prepare();
    this.#check();
  }

  leave() {
    this.#isOn = false;
  }

  resize(canvas_px) {
    this.#canvas_px = canvas_px;
    if (this.#isOn) this.#check();
  }

  draw(atlas) {
    const {canvas} = this.weaver;
    const {width, height} = this.#canvas_px;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    this.weaver.calibration = this.calibration;
    const isNew = this.#layout?.suffix !== atlas.header.layout.suffix;
    this.#layout = atlas.header.layout;
    if (isNew) this.#check();
    this.weaver.drawPanel(atlas);
  }

  async #prepare() {
    try {
      await this.weaver.prepare();
      this.#isPrepared = true;
    } catch (error) {
      this.#lack = error.message;
    }
  }

  #restore() {
    try {
      const text = localStorage.getItem(kStored);
      if (text) this.calibration = parseCalibration(text);
    } catch {
      // no storage, or what is in it is of no use: the file is asked for
    }
  }

  async #read(file) {
    if (!file) return;
    try {
      const text = await file.text();
      this.calibration = parseCalibration(text);
      this.#refusal = '';
      try {
        localStorage.setItem(kStored, text);
      } catch {
        // no storage: the file is asked for again after a reload
      }
    } catch (error) {
      this.#refusal = `${file.name}: ${error.message}`;
    }
    this.#check();
    this.onChange();
  }

  #check() {
    const problem = this.#lack || this.#refusal;
    const found = problem ? {ok: false, text: problem} : checkPanel({
      calibration: this.calibration,
      layout: this.#layout,
      canvas_px: this.#canvas_px,
      isFullScreen: document.fullscreenElement !== null,
      scale: window.devicePixelRatio || 1,
      side_max_px: this.#isPrepared ? this.weaver.side_max_px : Infinity,
    });
    const shown = byId('panel-state');
    shown.dataset.ok = found.ok;
    if (shown.textContent !== found.text) shown.textContent = found.text;
  }
}
