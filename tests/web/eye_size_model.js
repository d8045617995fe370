// SPDX-License-Identifier: Apache-2.0
// Checks of eye_size.js against a server whose speed is known, in simulated time.
import assert from 'node:assert/strict';
import {test} from 'node:test';

import {EyeSize} from './eye_size.js';
import {PixelCost} from './pixel_cost.js';

const kRoom = {width: 1280, height: 720};
const kTick_ms = 16;

// A server, and the line to it.
// full_ms: for a picture of kRoom; fixed_ms: for any; flat_ms: the same as a part of tracing;
// kernels: [[from_ms, ms]] of what it does first, once; line_ms: latency there and back; way_ms: of
// the bytes of kRoom.
class Server {
  static usual = {fixed_ms: 5, flat_ms: 0, line_ms: 0, way_ms: 0};
  #wanted = [];   // {time_ms: when it comes, frame, width, height}, oldest first
  #making = null;
  #ready = null;  // made, and not sent yet
  #way = [];      // sent: {..., sent_ms, here_ms}
  #lineFree_ms = 0;
  #acks = [];     // {time_ms, sent_ms}
  #underWay = 0;
  #shown_ns = 0;

  constructor(machine) {
    Object.assign(this, Server.usual, machine);
    this.kernels = [...machine.kernels ?? []];
  }

  ask(wanted, now_ms) {
    this.#wanted.push({...wanted, time_ms: now_ms + this.line_ms / 2});
  }

  // Pictures that have come.
  run(now_ms) {
    while (this.#acks[0]?.time_ms <= now_ms) {
      this.#shown_ns = (now_ms - this.#acks.shift().sent_ms) * 1e6;
      this.#underWay--;
    }
    if (this.#making?.end_ms <= now_ms) {
      this.#ready = this.#making;
      this.#making = null;
    }
    if (this.#ready && this.#underWay < 2) this.#send(now_ms);
    if (!this.#making && this.#wanted[0]?.time_ms <= now_ms) this.#begin(now_ms);
    const come = this.#way.filter(({here_ms}) => here_ms <= now_ms);
    this.#way = this.#way.filter(({here_ms}) => here_ms > now_ms);
    for (const {sent_ms} of come) this.#acks.push({time_ms: now_ms + this.line_ms / 2, sent_ms});
    return come;
  }

  #share({width, height}) { return width * height / (kRoom.width * kRoom.height); }

  #begin(now_ms) {
    let newest = null;
    while (this.#wanted[0]?.time_ms <= now_ms) newest = this.#wanted.shift();
    const kernels_ms = this.kernels[0]?.[0] <= now_ms ? this.kernels.shift()[1] : 0;
    const trace_ms = this.flat_ms + this.full_ms * this.#share(newest) + kernels_ms;
    this.#making = {...newest, trace_ms, end_ms: now_ms + this.fixed_ms + trace_ms};
  }

  #send(now_ms) {
    const begin_ms = Math.max(now_ms, this.#lineFree_ms);
    this.#lineFree_ms = begin_ms + this.way_ms * this.#share(this.#ready);
    this.#way.push({...this.#ready, sent_ms: now_ms, shown_ns: this.#shown_ns,
      here_ms: this.#lineFree_ms + this.line_ms / 2});
    this.#underWay++;
    this.#ready = null;
  }
}

// machine: of a Server; frames_hz: of a stream that moves by itself until frames_ms; motion:
// [[begin_ms, end_ms, name]] of the eye, which moves each move_ms; lost_ms: when the connection
// breaks. Returns the pictures shown and the sizes asked for, {time_ms, height}.
function simulate({frames_hz = 0, frames_ms = Infinity, motion = [], move_ms = kTick_ms,
  lost_ms = Infinity, room = kRoom, ...machine}, until_ms) {
  const shown = [];
  const asked = [];
  let now_ms = 0;
  const size = new EyeSize(() => asked.push({time_ms: now_ms, height: size.size.height}));
  size.fit(room);
  const server = new Server(machine);
  let askedBefore = '';
  for (; now_ms < until_ms; now_ms += kTick_ms) {
    const moved = motion.find(([begin, end]) => now_ms >= begin && now_ms < end);
    const isMoved = moved && now_ms % move_ms < kTick_ms;
    if (isMoved) size.noteMoved(now_ms, moved[2] ?? 'free');
    if (now_ms <= lost_ms && lost_ms < now_ms + kTick_ms) size.restart();
    const frame = frames_hz ? 1 + Math.floor(Math.min(now_ms, frames_ms) * frames_hz / 1000) : 1;
    const wanted = {frame, ...size.size};
    if (isMoved || JSON.stringify(wanted) !== askedBefore) server.ask(wanted, now_ms);
    askedBefore = JSON.stringify(wanted);
    for (const {frame: number, width, height, trace_ms, shown_ns} of server.run(now_ms)) {
      shown.push({time_ms: now_ms, height});
      size.noteShown({frame_number: String(number), layout: {tile_size: {width, height}}, shown_ns,
        times: {trace_ns: trace_ms * 1e6, encode_ns: 0}}, now_ms, server.line_ms);
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

const kSideways = [[1000, 9000, 'sideways']];
// How long anything but the whole canvas was asked for, ms.
function reduced_ms(asked, until_ms) {
  return asked.reduce((sum, {time_ms, height}, index) =>
    height === 720 ? sum : sum + (asked[index + 1]?.time_ms ?? until_ms) - time_ms, 0);
}

test('a line that is far away is no reason for smaller pictures', () => {
  for (const line_ms of [200, 400, 900]) {
    const {shown, asked} = simulate({full_ms: 20, line_ms, motion: kSideways}, 10_000);
    assert.deepEqual(asked, [], `${line_ms} ms there and back`);
    assert.ok(between(shown, 2500, 9000).length >= 6.5 * 2000 / (line_ms + 40) * 0.8);
  }
});

test('a line that is slow gets smaller pictures, and a sharp one within a second', () => {
  for (const [line_ms, rate_hz] of [[20, 17], [100, 9.5]]) {
    const {shown} = simulate({full_ms: 20, line_ms, way_ms: 150, motion: kSideways}, 12_000);
    assert.ok(between(shown, 4000, 9000).length >= 5 * rate_hz, `${line_ms} ms there and back`);
    const sharp = shown.find(({time_ms, height}) => time_ms >= 9000 && height === 720);
    assert.ok(sharp.time_ms - 9000 <= 1000, `sharp after ${sharp.time_ms - 9000} ms`);
  }
});

test('a server that waits for its kernels is not asked for less', () => {
  const {asked} = simulate({full_ms: 20, kernels: [[0, 3000], [4500, 2500]],
    motion: [[4000, 9000, 'free']]}, 10_000);
  assert.deepEqual(asked, []);
});

test('a size that does not help is given back, and not tried again soon', () => {
  for (const machine of [
    {full_ms: 2, flat_ms: 120}, {full_ms: 2, flat_ms: 500}, {full_ms: 40, line_ms: 240}]) {
    const {shown, asked} = simulate({...machine, motion: [[1000, 31_000, 'sideways']]}, 32_000);
    assert.ok(reduced_ms(asked, 32_000) <= 3000, JSON.stringify(asked));
    assert.ok(between(shown, 10_000, 30_000).every(({height}) => height === 720));
  }
});

test('a publisher who is slow is no reason for smaller pictures', () => {
  for (const frames_hz of [0.7, 1, 2, 3, 5]) {
    const {asked} = simulate({full_ms: 90, frames_hz}, 20_000);
    assert.deepEqual(asked, [], `${frames_hz} frames a second`);
  }
});

test('a scene of few frames is sharp within a second of its last one', () => {
  for (const frames_hz of [1, 2, 4, 8]) {
    const {shown} = simulate({full_ms: 300, frames_hz, frames_ms: 6000,
      motion: [[1000, 3000, 'sideways']]}, 8000);
    const last_ms = 1000 * Math.floor(6 * frames_hz) / frames_hz;
    const sharp = shown.find(({time_ms, height}) => time_ms >= last_ms && height === 720);
    assert.ok(sharp.time_ms - last_ms <= 1000 + 300, `${frames_hz} frames a second`);
  }
});

test('sizes of a canvas that is long gone are forgotten', () => {
  const cost = new PixelCost();
  for (let pixels = 1; pixels <= 100; ++pixels) cost.note(pixels, 10, pixels);
  cost.note(1000, 10, 60_050);
  assert.deepEqual([49, 50, 100, 1000].map((pixels) => cost.count(pixels)), [0, 1, 1, 1]);
});
