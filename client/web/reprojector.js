// SPDX-License-Identifier: Apache-2.0
// Shows pictures with depth from where the eye is by now: late reprojection. What the newest
// picture does not show, older ones may.
import {GlProgram} from './gl_program.js';
import {makeTexture} from './gl_texture.js';
import {kSurfaceFragment, kSurfaceVertex} from './reprojection_shaders.js';
import {clipFromSource, distance, seenAt} from './view_camera.js';

const kKept = 3;             // pictures, with the newest
const kApart = 0.02;         // of the focal distance between eyes of kept pictures
const kTorn_px = 6;          // cells are 2 px wide
const kMargin = 0.3;         // of the picture's width: its edge goes on as far around it
const kUnseen_px = 1.5;      // motion of the nearest surface that tears nothing
const kNearest = 0.25;       // of the nearest surface's distance: nearer things are cut away

export class Reprojector {
  #gl;
  #program = null;
  #kept = [];  // the newest first: {atlas, cameras, picture, depth, inv_z_max}

  // gl: a WebGL2 context with a depth buffer. Throws an Error where shaders do not compile.
  constructor(gl) {
    this.#gl = gl;
    this.#program = new GlProgram(gl, kSurfaceFragment, kSurfaceVertex);
  }

  // Forgets all pictures: they show another stream or display.
  clear() {
    for (const kept of this.#kept) this.#free(kept);
    this.#kept = [];
  }

  get newest() { return this.#kept[0] ?? null; }

  // atlas: {bitmap, depth: {inv_z, columns, rows}, header}; cameras: of its views.
  take(atlas, cameras) {
    const gl = this.#gl;
    const before = this.#kept[0];
    const focal_m = atlas.header.layout.focal_distance_m || 1;
    // The one before stays if its eye stands apart from that of the next older one.
    const older = this.#kept[1];
    const isApart = (a, b) =>
      distance(a.cameras[0].position, b.cameras[0].position) > kApart * focal_m;
    if (before && older && !isApart(before, older)) this.#free(this.#kept.shift());
    while (this.#kept.length >= kKept) this.#free(this.#kept.pop());
    const picture = makeTexture(gl, gl.LINEAR);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, atlas.bitmap);
    const depth = makeTexture(gl, gl.NEAREST);
    const {inv_z, columns, rows} = atlas.depth;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, columns, rows, 0, gl.RED, gl.FLOAT, inv_z);
    let inv_z_max = 0;
    for (const value of inv_z) if (value > inv_z_max) inv_z_max = value;
    this.#kept.unshift({layout: atlas.header.layout, cameras, picture, depth, inv_z_max});
  }

  // Draws what `target` sees into the viewport {x, y, width, height} of the bound framebuffer.
  // view: whose pictures are used first; cameras of other views fill what it does not show.
  draw(target, viewport, view = 0) {
    const gl = this.#gl;
    const newest = this.#kept[0];
    gl.viewport(viewport.x, viewport.y, viewport.width, viewport.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(viewport.x, viewport.y, viewport.width, viewport.height);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (newest) {
      gl.useProgram(this.#program.program);
      // The newest as one skin without holes below all, and as far as it is seen above all.
      this.#surface(newest, view, target, viewport, 0);
      if (this.#moved_px(newest, view, target, viewport) > kUnseen_px) {
        for (const kept of this.#kept.slice(1).reverse()) {
          this.#over(kept, Math.min(view, kept.cameras.length - 1), target, viewport);
        }
        newest.cameras.forEach((_, other) => {
          if (other !== view) this.#over(newest, other, target, viewport);
        });
        this.#over(newest, view, target, viewport);
      }
    }
    gl.disable(gl.SCISSOR_TEST);
    gl.disable(gl.DEPTH_TEST);
  }

  #over(kept, view, target, viewport) {
    this.#gl.clear(this.#gl.DEPTH_BUFFER_BIT);
    this.#surface(kept, view, target, viewport, kTorn_px);
  }

  // The most that the nearest and the farthest surface move apart.
  #moved_px({cameras, layout, inv_z_max}, view, target, viewport) {
    const matrix = clipFromSource(cameras[view], target, viewport, 1);
    const {width, height} = layout.tile_size;
    let most = 0;
    for (const corner of [[0, 0], [width, 0], [0, height], [width, height],
                          [width / 2, height / 2]]) {
      const near = seenAt(matrix, corner, inv_z_max, viewport);
      const far = seenAt(matrix, corner, 0, viewport);
      if (!near || !far) return Infinity;
      most = Math.max(most, Math.hypot(near[0] - far[0], near[1] - far[1]));
    }
    return most;
  }

  #surface({layout, cameras, picture, depth, inv_z_max}, view, target, viewport, stretch_max_px) {
    const gl = this.#gl;
    const {program} = this.#program;
    const place = (name) => this.#program.place(name);
    const {width, height} = layout.tile_size;
    const column = view % layout.columns;
    const row = Math.floor(view / layout.columns);
    const first_px = [column * width, layout.padding_top_px + row * height];
    const blocks = [Math.ceil(width / 2), Math.ceil(height / 2)];
    const near_m = kNearest / Math.max(inv_z_max, 1e-6);
    const matrix = clipFromSource(cameras[view], target, viewport, near_m);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, picture);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, depth);
    gl.activeTexture(gl.TEXTURE0);
    gl.useProgram(program);
    gl.uniform1i(place('picture'), 0);
    gl.uniform1i(place('depth'), 1);
    gl.uniform2i(place('first_block'), ...first_px.map((side) => Math.floor(side / 2)));
    gl.uniform2i(place('blocks'), ...blocks);
    gl.uniform2f(place('tile_px'), width, height);
    gl.uniform2f(place('first_px'), ...first_px);
    gl.uniform2f(place('picture_px'), layout.size.width, layout.size.height);
    gl.uniformMatrix4fv(place('clip_from_source'), false, matrix);
    gl.uniform2f(place('target_px'), viewport.width, viewport.height);
    gl.uniform1f(place('stretch_max_px'), stretch_max_px * viewport.width / width);
    gl.uniform1f(place('margin_px'), stretch_max_px > 0 ? 0 : kMargin * width);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * (blocks[0] + 1) * (blocks[1] + 1));
  }

  #free({picture, depth}) {
    this.#gl.deleteTexture(picture);
    this.#gl.deleteTexture(depth);
  }
}

// Whether the browser draws with a GPU. On a CPU, reprojection takes longer than it hides.
export function isOnGpu(gl) {
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const renderer = String(gl.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
  return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer);
}
