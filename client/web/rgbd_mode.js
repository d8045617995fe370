// SPDX-License-Identifier: Apache-2.0
// Colour beside depth: the middle view alone, its depth white where it is near.

const kGround = '#0a0c10';

const byId = (id) => document.getElementById(id);

// inv_z: Float32Array in 1/m, 0 = infinitely far; what is no number is black.
// {canvas, near_m, far_m}
function paintDepth(inv_z, {width, height}) {
  let [low, high] = [Infinity, 0];
  for (const value of inv_z) {
    if (value > high) high = value;
    if (value < low) low = value;
  }
  const scale = high > low ? 255 / (high - low) : 0;
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);  // bytes R, G, B, A, also where A comes first
  inv_z.forEach((value, index) => {
    const level = Math.round((value - low) * scale) || 0;
    pixels[index] = 0xff000000 | level << 16 | level << 8 | level;
  });
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d').putImageData(image, 0, 0);
  return {canvas, near_m: 1 / high, far_m: 1 / low};
}

const metres = (distance_m) => Number.isFinite(distance_m) ? `${distance_m.toFixed(2)} m` : '∞';

export class RgbdMode {
  #painted = {};  // {atlas, canvas}: depth is painted once an atlas

  constructor(stage) {
    this.stage = stage;
  }

  enter() {
    this.stage.painter = this;
  }

  draw(atlas) {
    const {canvas, context} = this.stage;
    context.fillStyle = kGround;
    context.fillRect(0, 0, canvas.width, canvas.height);
    delete canvas.dataset.view;
    if (!atlas.depth.length) return;  // one of the display before
    if (this.#painted.atlas !== atlas) {
      const painted = paintDepth(atlas.depth, atlas.header.layout.size);
      this.#painted = {atlas, canvas: painted.canvas};
      byId('rgbd-range').textContent =
          `white: ${metres(painted.near_m)}, black: ${metres(painted.far_m)}`;
    }
    const [left, top, width, height] = this.stage.frame(2 * atlas.header.layout.aspect);
    context.drawImage(atlas.bitmap, left, top, width / 2, height);
    context.drawImage(this.#painted.canvas, left + width / 2, top, width / 2, height);
  }
}
