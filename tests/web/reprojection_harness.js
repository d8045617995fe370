// SPDX-License-Identifier: Apache-2.0
// For reprojection_test.py: fetches pictures over /ws and shows them from elsewhere, without the
// page.
import {decoded, parseAtlasMessage} from './decoder.js';
import {Reprojector} from './reprojector.js';
import {cameraOf, fovOf, cameraWithFov} from './view_camera.js';

const canvas = new OffscreenCanvas(1, 1);
const gl = canvas.getContext('webgl2', {antialias: false, depth: true});
let reprojector = new Reprojector(gl);
let socket = null;
let next = null;

// layout: of StereoDisplay; size: of an eye.
window.open_eyes = (layout, width, height) => new Promise((resolve) => {
  socket?.close();
  reprojector.clear();
  const display = {stereo: {layout, tracked: true, eye_size: {width, height}}};
  const encoding = {with_depth: true, planes: 'BAND_ENCODING_COMPACT_DEPTH'};
  socket = new WebSocket(`ws://${location.host}/ws?stream=rays&display=${
    encodeURIComponent(JSON.stringify(display))}&encoding=${
    encodeURIComponent(JSON.stringify(encoding))}`);
  socket.binaryType = 'arraybuffer';
  socket.onmessage = async ({data}) => {
    const atlas = parseAtlasMessage(data);
    const {header} = atlas;
    const made = await decoded({...atlas, bands: header.depth_bands, layout: header.layout});
    socket.send(JSON.stringify({shown: header.delivery}));
    resolve();
    next?.({...atlas, ...made});
  };
});

// The picture of these eyes (Cameras of the protocol) is what is shown from now on. Its bytes.
window.see = async (eyes) => {
  const atlas = await new Promise((resolve) => {
    next = resolve;
    socket.send(JSON.stringify({eye_poses: {time_ns: '1', eyes}}));
  });
  next = null;
  reprojector.take(atlas, atlas.header.layout.views.map(cameraOf));
  return {jpeg: atlas.header.jpeg_bytes, depth: atlas.header.depth_bytes};
};

window.forget = () => reprojector.clear();

const base64 = (bytes) => {
  let text = '';
  for (let at = 0; at < bytes.length; at += 4096) {
    text += String.fromCharCode(...bytes.subarray(at, at + 4096));
  }
  return btoa(text);
};

// RGBA, bottom row first, of what a camera of the layout's form sees.
window.show_from = (view, {width, height}, index = 0) => {
  Object.assign(canvas, {width, height});
  const camera = cameraOf(view);
  const begin_ms = performance.now();
  reprojector.draw(cameraWithFov(camera, fovOf(camera, {width, height}), {width, height}),
      {x: 0, y: 0, width, height}, index);
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  return {pixels: base64(pixels), ms: performance.now() - begin_ms};
};
window.isReady = true;
