// SPDX-License-Identifier: Apache-2.0
// For video_test.py and page_video.py: decodes atlases by the page's modules, without the page.
import {parseCalibration} from './calibration.js';
import {Decoder, parseAtlasMessage} from './decoder.js';
import {kSamplePanels} from './sample_panels.js';
import {VideoAtlases} from './video_atlas.js';
import {VideoCanvas} from './video_canvas.js';
import {VideoTextures} from './video_textures.js';
import {Weaver} from './weaver.js';

const messages = new Map();  // by path
const failures = [];
const opened = {frames: 0, closed: 0};

// Counts frames that the decoder gives on this thread, and those that are closed.
const close = VideoFrame.prototype.close;
VideoFrame.prototype.close = function closeCounted() {
  opened.closed += this.codedWidth > 0 ? 1 : 0;
  close.call(this);
};
const OriginalDecoder = VideoDecoder;
window.VideoDecoder = class extends OriginalDecoder {
  constructor({output, error}) {
    super({error, output: (frame) => {
      ++opened.frames;
      output(frame);
    }});
  }
};

async function messageOf(path) {
  if (!messages.has(path)) messages.set(path, await (await fetch(path)).arrayBuffer());
  return parseAtlasMessage(messages.get(path).slice(0));
}

const base64 = (bytes) => {
  let text = '';
  for (let at = 0; at < bytes.length; at += 4096) {
    text += String.fromCharCode(...bytes.subarray(at, at + 4096));
  }
  return btoa(text);
};

// RGBA, top row first, of a part of an atlas in a canvas of some size.
function drawn(atlas, source, width, height) {
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext('2d', {alpha: false});
  context.imageSmoothingQuality = 'high';
  new VideoCanvas().draw(context, atlas, source, [0, 0, width, height]);
  return base64(new Uint8Array(context.getImageData(0, 0, width, height).data.buffer));
}

const waiting = new Map();  // by sequence
const decoder = new Decoder(
    (atlas) => waiting.get(atlas)?.(atlas), (atlas) => waiting.get(atlas)?.(null),
    (reason) => failures.push(reason));

const inWorker = (atlas) => new Promise((resolve) => {
  waiting.set(atlas, resolve);
  decoder.decode(atlas);
});

const own = new VideoAtlases();

// Decodes on this thread in a way: planes come first, and bitmaps from texImage2D then.
async function decodedAs(way, path) {
  const atlases = new VideoAtlases();
  for (;;) {
    const atlas = await messageOf(path);
    Object.assign(atlas, await atlases.decode(atlas.pictures, atlas.header.layout));
    if (way === 'planes' || atlas.bitmap) {
      atlases.close();
      return atlas;
    }
  }
}

// The whole of an atlas, as it was coded.
window.picture = async (path, kind) => {
  const atlas = kind === 'jpeg' ? await inWorker(await messageOf(path)) :
    await decodedAs(kind, path);
  const {width, height} = atlas.header.layout.size;
  return drawn(atlas, [0, 0, width, height], width, height);
};

window.part = async (path, kind, source, width, height) =>
  drawn(await decodedAs(kind, path), source, width, height);

// RGBA, top row first, of the panel that an atlas is woven for.
window.woven = async (path, kind, width, height) => {
  const weaver = new Weaver(document.getElementById('woven'));
  Object.assign(weaver.canvas, {width, height});
  weaver.calibration = parseCalibration(kSamplePanels[0].text);
  await weaver.prepare();
  weaver.drawPanel(await decodedAs(kind, path));
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext('2d');
  context.drawImage(weaver.canvas, 0, 0);
  return base64(new Uint8Array(context.getImageData(0, 0, width, height).data.buffer));
};

// Decodes on this thread, again and again. How many frames came, and how many were closed.
window.repeat = async (paths, count) => {
  Object.assign(opened, {frames: 0, closed: 0});
  const errors = [];
  for (let i = 0; i < count; ++i) {
    const atlas = await messageOf(paths[i % paths.length]);
    try {
      (await own.decode(atlas.pictures, atlas.header.layout)).bitmap?.close();
    } catch (error) {
      errors.push(error.message);
    }
  }
  await new Promise((resolve) => { setTimeout(resolve, 100); });
  return {...opened, errors, upload: own.upload};
};

// Decodes on this thread by a decoder that hangs; why it was given up.
window.hang = async (path) => {
  const decoding = window.VideoDecoder;
  window.VideoDecoder = class {
    state = 'unconfigured';
    configure() { this.state = 'configured'; }
    decode() {}
    flush() { return new Promise(() => {}); }
    close() { this.state = 'closed'; }
  };
  const atlas = await messageOf(path);
  const decode = new VideoAtlases(300).decode(atlas.pictures, atlas.header.layout);
  const reason = await decode.then(() => '', (error) => error.message);
  window.VideoDecoder = decoding;
  return reason;
};

// An atlas of a chain, decoded in the worker behind those before it.
window.followed = async (path) => {
  const atlas = await inWorker(await messageOf(path));
  const {width, height} = atlas.header.layout.size;
  return drawn(atlas, [0, 0, width, height], width, height);
};

// All of them at once, to the worker: the sequence of each that was decoded, null of one dropped.
window.burst = async (paths) => {
  const atlases = await Promise.all(paths.map(messageOf));
  const made = await Promise.all(atlases.map(inWorker));
  return {shown: made.map((atlas) => atlas?.header.sequence ?? null), failures};
};

// Times in ms of decoding in the worker and uploading on this thread, one atlas after the other;
// and the rate in Hz while the next atlas is decoded during the upload.
const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
const quilt = gl.createTexture();
const target = gl.createFramebuffer();
const planes = new VideoTextures(gl);
// Stands in for a program, of which VideoTextures sets uniforms.
const noProgram = {set() {}, place: () => null};

function upload(atlas) {
  const begun_ms = performance.now();
  if (atlas.planes) {
    planes.use(atlas, noProgram);
  } else {
    gl.bindTexture(gl.TEXTURE_2D, quilt);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, atlas.bitmap);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, quilt, 0);
  }
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  atlas.release();
  return performance.now() - begun_ms;
}

window.measure = async (paths, count) => {
  const times = [];
  for (let i = 0; i < count; ++i) {
    const atlas = await messageOf(paths[i % paths.length]);
    const begun_ms = performance.now();
    const made = await inWorker(atlas);
    const decode_ms = performance.now() - begun_ms;
    times.push({decode_ms, upload_ms: upload(made), upload: made.upload ?? ''});
  }
  const begun_ms = performance.now();
  let next = inWorker(await messageOf(paths[0]));
  for (let i = 1; i <= count; ++i) {
    const made = await next;
    next = inWorker(await messageOf(paths[i % paths.length]));
    upload(made);
  }
  const rate_hz = 1000 * count / (performance.now() - begun_ms);
  (await next).release();
  return {times, rate_hz};
};
window.isReady = true;
