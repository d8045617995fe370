// SPDX-License-Identifier: Apache-2.0
// Decodes atlases whose colour is H.264, by WebCodecs. Runs in the worker of decode_worker.js.
import {UploadTrial} from './upload_trial.js';
import {VideoPainter} from './video_painter.js';
import {VideoPlanes} from './video_planes.js';

// Ways to bring pictures to where they are drawn. Both are measured; the first one is the faster
// one without a GPU.
const kWays = {planes: VideoPlanes, texImage2D: VideoPainter};

const kPatience_ms = 8000;  // a decoder that gives nothing for as long hangs

// Frames in the order in which the decoder gives them, for one reader.
class FrameQueue {
  #frames = [];
  #wake = null;
  #failure = null;
  #isOver = false;

  constructor(patience_ms) {
    this.patience_ms = patience_ms;
  }

  push(frame) {
    if (this.#isOver) {
      frame.close();
      return;
    }
    this.#frames.push(frame);
    this.#wake?.();
  }

  fail(error) {
    this.#failure ??= error;
    this.#wake?.();
  }

  // The next frame; throws what failed.
  async next() {
    const timer = setTimeout(
        () => this.fail(new Error('the decoder gives no picture')), this.patience_ms);
    try {
      while (this.#frames.length === 0) {
        if (this.#failure) throw this.#failure;
        await new Promise((resolve) => { this.#wake = resolve; });
        this.#wake = null;
      }
      return this.#frames.shift();
    } finally {
      clearTimeout(timer);
    }
  }

  // Closes what is left, and what still comes.
  end() {
    this.#isOver = true;
    for (const frame of this.#frames.splice(0)) frame.close();
  }
}

function checkSize({visibleRect: {width, height}}, {picture_size}) {
  if (width === picture_size.width && height === picture_size.height) return;
  throw new Error(`a picture of ${width}x${height} px; expected are ${picture_size.width}x` +
                  `${picture_size.height} px`);
}

// Decoders in hardware keep other formats than I420, and reading them back is slow.
function wayFor(frame, trial) {
  if (trial.next === 'planes' && frame.format !== 'I420') trial.ruleOut('planes');
  return trial.next;
}

export class VideoAtlases {
  #decoder = null;
  #configuration = '';  // as text
  #frames = null;       // of the atlas that is being decoded
  #timestamp_us = 0;    // of the next picture
  #hardware = 'no-preference';
  #ways = {};           // those that were begun, by name
  #trial = new UploadTrial(Object.keys(kWays));

  // patience_ms: with a decoder that gives no picture
  constructor(patience_ms = kPatience_ms) {
    this.patience_ms = patience_ms;
  }

  // Name of the way that was measured to be the faster one; '' = not yet.
  get upload() { return this.#trial.kept; }

  // pictures: access units, Uint8Array each; layout: the AtlasLayout. One call at a time.
  // {bitmap} in the arrangement that the layout says, or {planes} of its stack. If a decoder fails,
  // one without hardware tries the same atlas. Rejects with what is wrong then; the next atlas
  // begins with a new decoder.
  async decode(pictures, layout) {
    try {
      return await this.#decodeOnce(pictures, layout);
    } catch (error) {
      if (this.#hardware === 'prefer-software') throw error;
      this.#hardware = 'prefer-software';
      return this.#decodeOnce(pictures, layout);
    }
  }

  async #decodeOnce(pictures, layout) {
    const frames = new FrameQueue(this.patience_ms);
    this.#frames = frames;
    try {
      this.#configure(layout.video);
      this.#feed(pictures, frames);
      return await this.#collect(frames, layout);
    } catch (error) {
      this.close();
      throw error;
    } finally {
      frames.end();
    }
  }

  // Takes planes back that nobody reads any more.
  recycle(planes) {
    this.#ways.planes?.recycle(planes);
  }

  close() {
    if (this.#decoder && this.#decoder.state !== 'closed') this.#decoder.close();
    this.#decoder = null;
    for (const way of Object.values(this.#ways)) way.close();
    this.#ways = {};
  }

  // Time until the next frame is the decoder's. All other time is the way's.
  async #collect(frames, layout) {
    let name = '';
    let way = null;
    let time_ms = 0;
    for (let index = 0; index < layout.video.picture_count; ++index) {
      const frame = await frames.next();
      const begun_ms = performance.now();
      try {
        checkSize(frame, layout.video);
        if (!way) {
          name = wayFor(frame, this.#trial);
          way = this.#ways[name] ??= new kWays[name]();
          way.begin(layout);
        }
        await way.put(index, frame);
      } finally {
        frame.close();
      }
      time_ms += performance.now() - begun_ms;
    }
    const begun_ms = performance.now();
    const made = await way.finish();
    this.#trial.note(name, time_ms + performance.now() - begun_ms);
    return made;
  }

  #configure({codec_string, picture_size}) {
    const configuration = {
      codec: codec_string, codedWidth: picture_size.width, codedHeight: picture_size.height,
      optimizeForLatency: true, hardwareAcceleration: this.#hardware,
    };
    const text = JSON.stringify(configuration);
    if (this.#decoder?.state === 'configured' && text === this.#configuration) return;
    if (!this.#decoder || this.#decoder.state === 'closed') {
      this.#decoder = new VideoDecoder({
        output: (frame) => this.#frames.push(frame),
        error: (error) => this.#frames.fail(error),
      });
    }
    this.#decoder.configure(configuration);
    this.#configuration = text;
  }

  #feed(pictures, frames) {
    pictures.forEach((data, index) => {
      this.#decoder.decode(new EncodedVideoChunk(
          {type: index === 0 ? 'key' : 'delta', timestamp: this.#timestamp_us++, data}));
    });
    // Decoders may keep pictures until they know that no more come.
    this.#decoder.flush().then(
        () => frames.fail(new Error('the decoder gave fewer pictures than came')),
        (error) => frames.fail(error));
  }
}
