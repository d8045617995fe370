// SPDX-License-Identifier: Apache-2.0
// Decodes atlases whose colour is H.264, by WebCodecs. Runs in the worker of decode_worker.js.
import {PictureDecoder} from './picture_decoder.js';
import {UploadTrial} from './upload_trial.js';
import {VideoPainter} from './video_painter.js';
import {VideoPlanes} from './video_planes.js';

// Ways to bring pictures to where they are drawn. Both are measured; the first one is the faster
// one without a GPU.
const kWays = {planes: VideoPlanes, texImage2D: VideoPainter};

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
  #decoder;
  #sequence = 0;  // of the last atlas, if the next one may refer to it; 0 = none
  #hardware = 'no-preference';
  #ways = {};  // those that were begun, by name
  #trial = new UploadTrial(Object.keys(kWays));

  // patience_ms: with a decoder that gives no picture
  constructor(patience_ms) {
    this.#decoder = new PictureDecoder(patience_ms);
  }

  // Name of the way that was measured to be the faster one; '' = not yet.
  get upload() { return this.#trial.kept; }

  // pictures: access units, Uint8Array each, in the order in which they came; layout: the
  // AtlasLayout; link: {sequence, reference} of chained video; isBackward: the last picture came
  // first; isShown: false where only the next atlas needs it. One call at a time.
  // {bitmap} in the arrangement that the layout says, {planes} of its stack, or {} of one that is
  // not shown. If a decoder fails, one without hardware tries the same atlas, unless it refers to
  // another. Rejects with what is wrong then; the next atlas begins with a new decoder.
  async decode(pictures, layout, {link = null, isBackward = false, isShown = true} = {}) {
    const job = {pictures, layout, link, isBackward, isShown};
    try {
      return await this.#decodeOnce(job);
    } catch (error) {
      if (this.#hardware === 'prefer-software' || link?.reference) throw error;
      this.#hardware = 'prefer-software';
      return this.#decodeOnce(job);
    }
  }

  async #decodeOnce({pictures, layout, link, isBackward, isShown}) {
    try {
      this.#begin(pictures, layout.video, link);
      return isShown ? await this.#collect(layout, isBackward) : await this.#follow(layout);
    } catch (error) {
      this.close();
      throw error;
    } finally {
      this.#decoder.end();
    }
  }

  // Takes planes back that nobody reads any more.
  recycle(planes) {
    this.#ways.planes?.recycle(planes);
  }

  close() {
    this.#decoder.close();
    this.#sequence = 0;
    for (const way of Object.values(this.#ways)) way.close();
    this.#ways = {};
  }

  #begin(pictures, {codec_string, picture_size}, link) {
    const reference = link?.reference ?? 0;
    if (reference !== 0 && reference !== this.#sequence) {
      throw new Error(`it refers to atlas ${reference}, which was not decoded before it`);
    }
    this.#sequence = link?.sequence ?? 0;
    this.#decoder.begin({
      codec: codec_string, codedWidth: picture_size.width, codedHeight: picture_size.height,
      optimizeForLatency: true, hardwareAcceleration: this.#hardware,
    });
    pictures.forEach(
        (data, place) => this.#decoder.feed(data, place === 0 && reference === 0));
    if (link) this.#decoder.expectAll();
    else this.#decoder.flush();
  }

  async #follow({video}) {
    for (let place = 0; place < video.picture_count; ++place) {
      const frame = await this.#decoder.next();
      frame.close();
    }
    return {};
  }

  // Time until the next frame is the decoder's. All other time is the way's.
  async #collect(layout, isBackward) {
    const {picture_count} = layout.video;
    let name = '';
    let way = null;
    let time_ms = 0;
    for (let place = 0; place < picture_count; ++place) {
      const frame = await this.#decoder.next();
      const begun_ms = performance.now();
      try {
        checkSize(frame, layout.video);
        if (!way) {
          name = wayFor(frame, this.#trial);
          way = this.#ways[name] ??= new kWays[name]();
          way.begin(layout);
        }
        await way.put(isBackward ? picture_count - 1 - place : place, frame);
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
}
