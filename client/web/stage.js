// SPDX-License-Identifier: Apache-2.0
// Draws one view of the newest atlas, or the whole of it; or lets a painter draw. For a view that
// is not at hand it draws the nearest.
import {watchDeviceSize} from './device_size.js';
import {tileOrigin} from './tile_origin.js';
import {VideoCanvas} from './video_canvas.js';

// Half a pixel inside a tile, smoothing does not reach into its neighbours.
const kTileEdge_px = 0.5;
// Around the picture, of the canvas's shorter side; small windows have no room for it.
const kMarginShare = 0.025;
const small = matchMedia('(max-width: 760px), (max-height: 500px)');

// Which views of the display an atlas shows: from which on, and of how many. It shows all of them,
// or those that share a part of the cone.
export function shownViews({view_count, cone_begin, cone_end}) {
  const share = cone_end - cone_begin;
  const isPart = share > 0 && share < 1;
  const total = isPart ? Math.round(view_count / share) : view_count;
  return {isPart, total, first: isPart ? Math.round(cone_begin * total) : 0};
}

export class Stage {
  #atlas = null;
  #scheduled = false;
  #pictures = new VideoCanvas();  // draws them, of either kind

  // onDrawn(atlas); onResize(): its pictures have room for another number of px
  constructor(canvas, {onDrawn, onResize}) {
    this.canvas = canvas;
    this.onDrawn = onDrawn;
    this.onResize = onResize;
    this.context = canvas.getContext('2d', {alpha: false});
    this.position = 0.5;  // 0 = leftmost view, 1 = rightmost
    this.whole = false;
    this.single = null;    // the number of the one view shown, from 0, whatever the position
    this.painter = null;   // {draw(atlas)}: draws instead
    watchDeviceSize(canvas, (size_px) => this.#resize(size_px));
  }

  get layout() { return this.#atlas?.header.layout ?? null; }
  // Views of the whole display; 0 = there is no picture yet.
  get total() { return this.#atlas ? shownViews(this.layout).total : 0; }

  show(atlas) {
    this.#atlas?.release();
    this.#atlas = atlas;
    this.invalidate();
  }

  look(position) {
    this.position = Math.min(1, Math.max(0, position));
    if (!this.whole && this.single === null && !this.painter) this.invalidate();
  }

  invalidate() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => {
      this.#scheduled = false;
      this.#draw();
    });
  }

  // For callers that are called once a frame already.
  drawNow() { this.#draw(); }

  #resize({width, height}) {
    this.canvas.width = Math.max(1, width);
    this.canvas.height = Math.max(1, height);
    this.#draw();
    this.onResize();
  }

  #draw() {
    const isPart = this.#atlas !== null && shownViews(this.layout).isPart;
    if (this.painter) {
      if (!this.#atlas) return;
      if (!isPart) this.painter.draw(this.#atlas);  // else the picture before its own
      this.onDrawn(this.#atlas);
      return;
    }
    const {canvas, context} = this;
    context.fillStyle = '#0a0c10';
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (!this.#atlas) return;
    context.imageSmoothingQuality = 'high';
    if (this.whole && !isPart) this.#drawWhole();
    else this.#drawView();
    this.onDrawn(this.#atlas);
  }

  // The largest rectangle of an aspect that fits the canvas with a margin, in the middle.
  frame(aspect, marginShare = small.matches ? 0 : kMarginShare) {
    const margin = Math.round(Math.min(this.canvas.width, this.canvas.height) * marginShare);
    const width = this.canvas.width - 2 * margin;
    const height = this.canvas.height - 2 * margin;
    const w = Math.min(width, height * aspect);
    const h = w / aspect;
    return [(this.canvas.width - w) / 2, (this.canvas.height - h) / 2, w, h].map(Math.round);
  }

  #drawWhole() {
    const {width, height} = this.layout.size;
    // A display that takes the whole picture has no room for a margin.
    const marginShare = document.fullscreenElement ? 0 : undefined;
    this.#pictures.draw(this.context, this.#atlas, [0, 0, width, height],
                        this.frame(width / height, marginShare));
    delete this.canvas.dataset.view;
  }

  #drawView() {
    const {view_count} = this.layout;
    const {first, total} = shownViews(this.layout);
    // The nearest of those at hand.
    const atHand = (view) => Math.min(view_count - 1, Math.max(0, view - first));
    const exact = atHand(this.position * (total - 1));
    const nearest = this.single === null ? Math.round(exact) : atHand(this.single);
    this.#drawTile(nearest);
    this.canvas.dataset.view = first + nearest;
  }

  #drawTile(view) {
    const {layout, context} = this;
    const {x, y} = tileOrigin(layout, view);
    const {width, height} = layout.tile_size;
    const source = [x + kTileEdge_px, y + kTileEdge_px, width - 2 * kTileEdge_px,
      height - 2 * kTileEdge_px];
    this.#pictures.draw(context, this.#atlas, source, this.frame(layout.aspect));
  }
}
