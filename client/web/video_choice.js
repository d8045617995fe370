// SPDX-License-Identifier: Apache-2.0
// Whether colour comes as video or as JPEG: what the browser decodes, and what the server is told.
import {isOnLoopback} from './address.js';
import {notice} from './notice.js';

const kJpeg = 'BAND_ENCODING_JPEG';
const kVideo = 'BAND_ENCODING_H264';
// Main profile, as the server makes it: from the largest pictures down.
const kLevels = [
  {codec: 'avc1.4D4C33', level_max: 51, picture_size_max: {width: 4096, height: 2176}},
  {codec: 'avc1.4D4C28', level_max: 40, picture_size_max: {width: 1920, height: 1088}},
];

let video = null;      // AcceptedEncoding of H264; null = JPEG only
let isGivenUp = false;
let isChained = false;       // atlases are asked for that refer to each other
let isChainGivenUp = false;

async function isSupported({codec, picture_size_max: {width, height}}) {
  try {
    const {supported} = await VideoDecoder.isConfigSupported(
        {codec, codedWidth: width, codedHeight: height, optimizeForLatency: true});
    return supported;
  } catch {
    return false;
  }
}

// Asks the browser what it decodes. Before anything is asked of the server.
export async function findVideo() {
  // Browsers have neither over HTTP from another machine, and some have one of the two.
  if (!('VideoDecoder' in self) || !('OffscreenCanvas' in self)) return;
  for (const level of kLevels) {
    if (!await isSupported(level)) continue;
    const {level_max, picture_size_max} = level;
    video = {color: kVideo, picture_size_max, level_max};
    return;
  }
}

// AcceptedEncodings of proto OpenDisplay, the preferred one first. Video takes the server more time
// than JPEG, and pays where a network is between.
export function acceptedEncodings() {
  if (!video || isGivenUp) return [{color: kJpeg}];
  return isOnLoopback() ? [{color: kJpeg}, video] : [video, {color: kJpeg}];
}

// asked: AtlasEncoding as JSON; isWhole: all views of a display are asked for. Fewer have little
// in common that video could use, and depth comes beside JPEG alone.
export function withColor(asked, isWhole) {
  const {prediction, ...alone} = asked;
  const encoding = isChainGivenUp ? alone : asked;
  isChained = encoding.prediction === 'PREDICTION_ACROSS_ATLASES';
  const isOpen = encoding.color === undefined;
  if (!isOpen && encoding.color !== kVideo) return encoding;
  const mayBeVideo = video && !isGivenUp && isWhole && !encoding.with_depth;
  if (mayBeVideo || (isOpen && !video)) return encoding;
  return {...encoding, color: kJpeg};
}

// The browser fails at video, with a reason: if pictures refer to each other, each comes alone from
// now on, else JPEG. onChange(): to be asked for.
export function giveUpVideo(reason, onChange) {
  if (isGivenUp) return;
  if (isChained) {
    isChainGivenUp = true;
    notice(`This browser could not follow the video (${reason}). Each picture comes alone from ` +
           'now on.', 'bad');
    onChange();
    return;
  }
  isGivenUp = true;
  notice(`This browser could not show the video (${reason}). JPEG pictures come from now on.`,
         'bad');
  onChange();
}
