// SPDX-License-Identifier: Apache-2.0
// Checks of eye_size.js against a server whose speed is known, in simulated time.
import assert from 'node:assert/strict';
import {test} from 'node:test';

import {EyeSize} from './eye_size.js';

const kRoom = {width: 1280, height: 720};
const kTick_ms = 16;

// server: {full_ms: for a picture of kRoom, fixed_ms: for any}; frames_hz: of a stream that moves
// by itself until frames_ms; motion: [[begin_ms, end_ms, name]] of the eye, which moves each
// move_ms; lost_ms: when the connection breaks. Returns the pictures shown and the sizes asked for,
// {time_ms, height}.
function simulate({full_ms, fixed_ms = 5, frames_hz = 0, frames_ms = Infinity, motion = [],
  move_ms = kTick_ms, lost_ms = Infinity, room = kRoom}, until_ms) {
  const shown = [];
  const asked = [];
  let now_ms = 0;
  const size = new EyeSize(() => asked.push({time_ms: now_ms, height: size.size.height}));
  size.fit(room);
  let making = null;
  let frame = 1;
  let shownFrame = 0;
  let isMoved = true;
  let sizeShown = 0;
  for (; now_ms < until_ms; now_ms += kTick_ms) {
    const moved = motion.find(([begin, end]) => now_ms >= begin && now_ms < end);
    if (moved && now_ms % move_ms < kTick_ms) {
      size.noteMoved(now_ms, moved[2] ?? 'free');
      isMoved = true;
    }
    if (now_ms <= lost_ms && lost_ms < now_ms + kTick_ms) size.restart();
    if (frames_hz) frame = 1 + Math.floor(Math.min(now_ms, frames_ms) * frames_hz / 1000);
    const {width, height} = size.size;
    if (!making && (isMoved || frame !== shownFrame || height !== sizeShown)) {
      const ms = fixed_ms + full_ms * width * height / (kRoom.width * kRoom.height);
      making = {frame, width, height, ms, end_ms: now_ms + ms};
      isMoved = false;
    }
    if (making && now_ms >= making.end_ms) {
      shown.push({time_ms: now_ms, height: making.height});
      shownFrame = making.frame;
      sizeShown = making.height;
      size.noteShown({frame_number: String(making.frame), layout: {tile_size: making},
        times: {trace_ns: (making.ms - fixed_ms) * 1e6, encode_ns: 0}}, now_ms);
      making = null;
    }
    if (now_ms % 96 < kTick_ms) size.look(now_ms);
  }
  return {shown, asked};
}

const between = (pictures, begin_ms, end_ms) =>
  pictures.filter(({time_ms}) => time_ms >= begin_ms && time_ms < end_ms);

test('a server that is fast enough is asked for the whole canvas, always', () => {
  const {shown, asked} = simulate({full_ms: 60, motion: [[500, 4000]]}, 5000);
  assert.deepEqual(asked, []);
  assert.ok(between(shown, 500, 4000).length >= 10 * 3.5);
});

test('an eye that goes sideways gets twenty a second, and one that goes anywhere ten', () => {
  const motion = [[1000, 9000, 'sideways'], [11_000, 16_000, 'free'], [18_000, 20_000, 'sideways']];
  const {shown, asked} = simulate({full_ms: 55, motion}, 22_000);
  assert.ok(between(shown, 3000, 9000).length >= 6 * 19);
  const heightsFrom = (begin_ms, end_ms) =>
    new Set(between(shown, begin_ms, end_ms).map(({height}) => height));
  assert.deepEqual([...heightsFrom(11_500, 16_000)], [720], 'ten come of the whole canvas');
  assert.ok(between(shown, 18_300, 19_300).length >= 19, 'sideways has the size that it had');
  assert.ok(Math.min(...asked.map(({height}) => height)) >= 360);
});

test('moves that come seldom are no sign of a slow server', () => {
  for (const move_ms of [128, 256]) {
    const {asked} = simulate({full_ms: 40, move_ms, motion: [[500, 9000, 'sideways']]}, 10_000);
    assert.deepEqual(asked, [], `a move each ${move_ms} ms`);
  }
});

test('a slow one gives ten a second of a moving eye, and a sharp one within a second', () => {
  for (const full_ms of [130, 250, 300]) {
    const {shown} = simulate({full_ms, motion: [[1000, 6000], [8000, 12000]]}, 14_000);
    assert.equal(shown[0].height, 720, 'the first is sharp');
    const heights = shown.map(({height}) => height);
    assert.ok(Math.min(...heights) >= 360);
    assert.ok(between(shown, 3000, 6000).length >= 3 * 9.5, `full_ms ${full_ms}`);
    const sharp = shown.find(({time_ms, height}) => time_ms >= 6000 && height === 720);
    assert.ok(sharp.time_ms - 6000 <= 1000, `sharp after ${sharp.time_ms - 6000} ms`);
    // The next motion begins with the size that this one found.
    assert.ok(between(shown, 8300, 9300).length >= 9);
  }
});

test('no picture is lower than 360 px, however slow the server is', () => {
  const {shown} = simulate({full_ms: 3000, motion: [[1000, 20_000]]}, 20_000);
  assert.equal(Math.min(...shown.map(({height}) => height)), 360);
  const {asked} = simulate({full_ms: 3000, motion: [[1000, 20_000]],
    room: {width: 400, height: 300}}, 20_000);
  assert.deepEqual(asked, [], 'a canvas that is lower already');
});

test('a scene that moves by itself is as fast as it is published, or ten a second', () => {
  const {shown} = simulate({full_ms: 200, frames_hz: 15}, 10_000);
  assert.ok(between(shown, 5000, 10_000).length >= 5 * 9.5);
  const slow = simulate({full_ms: 150, frames_hz: 4}, 10_000);
  assert.deepEqual(slow.asked.filter(({height}) => height < 720), []);
});

test('a scene whose whole pictures take a second becomes as fast as smaller ones allow', () => {
  const {shown} = simulate({full_ms: 1000, frames_hz: 15}, 12_000);
  assert.ok(between(shown, 8000, 12_000).length >= 4 * 3.5);
  assert.equal(Math.min(...shown.map(({height}) => height)), 360);
});

test('an eye that stands before a moving scene has the size of that motion', () => {
  const {shown} = simulate(
      {full_ms: 55, frames_hz: 15, motion: [[1000, 5000, 'sideways']]}, 8000);
  assert.ok(between(shown, 2500, 5000).length >= 2.5 * 19);
  const sharp = shown.find(({time_ms, height}) => time_ms >= 5000 && height === 720);
  assert.ok(sharp.time_ms - 5000 <= 1000, `sharp after ${sharp.time_ms - 5000} ms`);
  assert.ok(between(shown, 6000, 8000).every(({height}) => height === 720));
});

test('a scene that ends is sharp within a second', () => {
  const {shown} = simulate({full_ms: 250, frames_hz: 15, frames_ms: 6000}, 8000);
  assert.ok(between(shown, 5000, 6000).every(({height}) => height < 720));
  const sharp = shown.find(({time_ms, height}) => time_ms >= 6000 && height === 720);
  assert.ok(sharp.time_ms - 6000 <= 1000, `sharp after ${sharp.time_ms - 6000} ms`);
});

test('another connection begins with the whole canvas, also in the middle of a motion', () => {
  const {asked} = simulate({full_ms: 300, motion: [[1000, 4000]], lost_ms: 4016}, 5000);
  assert.ok(asked.some(({height}) => height < 720));
  const [first] = between(asked, 4016, 5000);
  assert.deepEqual(first, {time_ms: 4016, height: 720});
});

test('more is tried again while it moves, not at once, and seldom in vain', () => {
  const {asked} = simulate({full_ms: 130, motion: [[500, 30_000]]}, 30_000);
  assert.ok(asked.length <= 6, `${asked.length} changes`);
});
