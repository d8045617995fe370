// SPDX-License-Identifier: Apache-2.0
// A canvas of its own in which pictures with depth are shown from where the eye is by now; or
// nothing, where the browser would take too long for that.
import {pageParameters} from './address.js';
import {isOnGpu, Reprojector} from './reprojector.js';

const kSlow_ms = 34;    // from one frame to the next: too slow to hide anything
const kSlowCount = 30;  // of such in a row

export class LatePicture {
  #canvas = document.createElement('canvas');
  #reprojector = null;
  #slow = 0;

  // asked: the page's parameter `reprojection`, 'on' or 'off'; else where there is a GPU. onOff():
  // it was on, and is not any more
  constructor(asked = pageParameters().get('reprojection'), onOff = () => {}) {
    this.onOff = onOff;
    if (asked === 'off') return;
    const gl = this.#canvas.getContext('webgl2', {alpha: false, antialias: false, depth: true});
    if (!gl || (asked !== 'on' && !isOnGpu(gl))) return;
    this.isForced = asked === 'on';
    try {
      this.#reprojector = new Reprojector(gl);
    } catch (error) {
      console.warn(`no late reprojection: ${error.message}`);
    }
    this.#canvas.addEventListener('webglcontextlost', () => this.#end());
  }

  // Whether pictures shall come with depth.
  get isOn() { return this.#reprojector !== null; }

  clear() { this.#reprojector?.clear(); }

  take(atlas, cameras) {
    if (atlas.depth.columns) this.#reprojector?.take(atlas, cameras);
  }

  // The canvas, with what `camera` sees of the pictures in {width, height} px; null = nothing.
  draw(camera, size_px) {
    if (!this.#reprojector?.newest) return null;
    const {width, height} = size_px;
    const canvas = this.#canvas;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    this.#reprojector.draw(camera, {x: 0, y: 0, width, height});
    return canvas;
  }

  // Time from one frame to the next, while pictures are drawn in each. A browser that cannot keep
  // the pace goes without from now on.
  notePace(taken_ms) {
    if (this.isForced || !this.isOn) return;
    this.#slow = taken_ms > kSlow_ms ? this.#slow + 1 : 0;
    if (this.#slow < kSlowCount) return;
    this.clear();
    this.#end();
  }

  #end() {
    if (!this.isOn) return;
    this.#reprojector = null;
    this.onOff();
  }
}
