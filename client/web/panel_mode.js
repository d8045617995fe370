// SPDX-License-Identifier: Apache-2.0
// Panel mode: the picture woven for a calibrated panel, px by px, and whether it gets there.
import {allow} from './allowed.js';
import {askPanels} from './bridge_panels.js';
import {parseCalibration} from './calibration.js';
import {checkPanel} from './panel_check.js';

const kStored = 'viewloom.calibration';  // of the browser's storage: the file's text

const byId = (id) => document.getElementById(id);
const root = document.documentElement;

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
    document.addEventListener('dragover', (event) => {
      event.preventDefault();
      root.dataset.drag = 'over';
    });
    document.addEventListener('dragleave', () => { delete root.dataset.drag; });
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      delete root.dataset.drag;
      this.#read(event.dataTransfer.files[0]);
    });
    byId('ask-bridge').addEventListener('click', () => this.#askBridge());
    byId('bridge-panel').addEventListener('change', ({target}) => {
      this.#take(target.value, target.selectedOptions[0].text);
      byId('drop').hidden = true;
    });
    byId('other-panel').addEventListener('click', () => {
      byId('drop').hidden = !byId('drop').hidden;
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
    byId('drop').hidden = this.calibration !== null;
  }

  async #read(file) {
    if (!file) return;
    try {
      this.#take(await file.text(), file.name);
    } catch {
      this.#refuse(`${file.name}: cannot be read; copy it to this machine first`);
    }
  }

  // The panels that Bridge knows; the first is taken, and the others can be.
  async #askBridge() {
    allow(byId('ask-bridge'), 'Bridge is being asked.');
    try {
      const panels = await askPanels();
      byId('bridge-panel').replaceChildren(
          ...panels.map(({name, calibration}) => new Option(name, calibration)));
      byId('bridge-panel').hidden = panels.length === 1;
      this.#take(panels[0].calibration, panels[0].name);
    } catch (error) {
      this.#refuse(error.message);
    }
    allow(byId('ask-bridge'), '');
  }

  // text: of a visual.json; name: where it comes from
  #take(text, name) {
    try {
      this.calibration = parseCalibration(text);
      this.#refusal = '';
      try {
        localStorage.setItem(kStored, text);
      } catch {
        // no storage: the file is asked for again after a reload
      }
      byId('drop').hidden = byId('bridge-panel').hidden;
    } catch (error) {
      this.#refuse(`${name}: ${error.message}`);
      return;
    }
    this.#check();
    this.onChange();
  }

  #refuse(sentence) {
    this.#refusal = sentence;
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
