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

// Decoders of chained video: each picture of the stack is a stream of its own.
class Chain {
  #decoders = [];
  #sequence = 0;  // of the last atlas; 0 = none

  constructor(patience_ms) {
    this.patience_ms = patience_ms;
  }

  // pictures: access units of the atlas `sequence`, which refers to the atlas `reference`; 0 = to
  // none. The decoders, one of each picture, which have begun with them.
  begin(pictures, {sequence, reference}, configuration) {
    if (reference !== 0 && reference !== this.#sequence) {
      throw new Error(`it refers to atlas ${reference}, which was not decoded before it`);
    }
    this.#sequence = sequence;
    while (this.#decoders.length > pictures.length) this.#decoders.pop().close();
    return pictures.map((data, index) => {
      const decoder = this.#decoders[index] ??= new PictureDecoder(this.patience_ms);
      decoder.begin(configuration);
      decoder.feed(data, reference === 0);
      decoder.expectAll();
      return decoder;
    });
  }

  end() {
    for (const decoder of this.#decoders) decoder.end();
  }

  close() {
    for (const decoder of this.#decoders) decoder.close();
    this.#decoders = [];
    this.#sequence = 0;
  }
}

export class VideoAtlases {
  #alone;  // decoder of atlases that need no other
  #chain;
  #hardware = 'no-preference';
  #ways = {};  // those that were begun, by name
  #trial = new UploadTrial(Object.keys(kWays));

  // patience_ms: with a decoder that gives no picture
  constructor(patience_ms) {
    this.#alone = new PictureDecoder(patience_ms);
    this.#chain = new Chain(patience_ms);
  }

  // Name of the way that was measured to be the faster one; '' = not yet.
  get upload() { return this.#trial.kept; }

  // pictures: access units, Uint8Array each; layout: the AtlasLayout; link: {sequence, reference}
  // of chained video; isShown: false where only the next atlas needs it. One call at a time.
  // {bitmap} in the arrangement that the layout says, {planes} of its stack, or {} of one that is
  // not shown. If a decoder fails, one without hardware tries the same atlas, unless it refers to
  // another. Rejects with what is wrong then; the next atlas begins with a new decoder.
  async decode(pictures, layout, {link = null, isShown = true} = {}) {
    const job = {pictures, layout, link, isShown};
    try {
      return await this.#decodeOnce(job);
    } catch (error) {
      if (this.#hardware === 'prefer-software' || link?.reference) throw error;
      this.#hardware = 'prefer-software';
      return this.#decodeOnce(job);
    }
  }

  async #decodeOnce({pictures, layout, link, isShown}) {
    try {
      const next = this.#begin(pictures, layout.video, link);
      return isShown ? await this.#collect(next, layout) : await this.#follow(next, layout);
    } catch (error) {
      this.close();
      throw error;
    } finally {
      this.#alone.end();
      this.#chain.end();
    }
  }

  // Takes planes back that nobody reads any more.
  recycle(planes) {
    this.#ways.planes?.recycle(planes);
  }

  close() {
    this.#alone.close();
    this.#chain.close();
    for (const way of Object.values(this.#ways)) way.close();
    this.#ways = {};
  }

  // A function that gives the frame of each picture, in their order.
  #begin(pictures, {codec_string, picture_size}, link) {
    const configuration = {
      codec: codec_string, codedWidth: picture_size.width, codedHeight: picture_size.height,
      optimizeForLatency: true, hardwareAcceleration: this.#hardware,
    };
    if (link) {
      const decoders = this.#chain.begin(pictures, link, configuration);
      return (index) => decoders[index].next();
    }
    this.#alone.begin(configuration);
    pictures.forEach((data, index) => this.#alone.feed(data, index === 0));
    this.#alone.flush();
    return () => this.#alone.next();
  }

  async #follow(next, {video}) {
    for (let index = 0; index < video.picture_count; ++index) {
      const frame = await next(index);
      frame.close();
    }
    return {};
  }

  // Time until the next frame is the decoder's. All other time is the way's.
  async #collect(next, layout) {
    let name = '';
    let way = null;
    let time_ms = 0;
    for (let index = 0; index < layout.video.picture_count; ++index) {
      const frame = await next(index);
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
}
