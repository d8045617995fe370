// SPDX-License-Identifier: Apache-2.0
// Publishes one small frame, a ball before a wall, and holds it until Ctrl-C.
//   node publish_frame.js --stream demo
import {once} from 'node:events';

import {connect, printable, run} from './command_line.js';

const kSize_px = {width: 320, height: 180};
const kHalfHeight_rad = 0.3;
const kBallRadius_px = 50;
const kBall = {rgb: [220, 40, 30], depth_m: 1.5};
const kWall = {rgb: [30, 60, 210], depth_m: 3};
const kChunkBytesMax = 1 << 20;

// RGB8 and binary32 metres, packed, top row first.
function makePlanes() {
  const {width, height} = kSize_px;
  const color = Buffer.alloc(width * height * 3);
  const depth = Buffer.alloc(width * height * 4);
  for (let i = 0; i < width * height; ++i) {
    const x = i % width + 0.5 - width / 2;
    const y = Math.floor(i / width) + 0.5 - height / 2;
    const seen = Math.hypot(x, y) < kBallRadius_px ? kBall : kWall;
    color.set(seen.rgb, i * 3);
    depth.writeFloatLE(seen.depth_m, i * 4);
  }
  return {color, depth};
}

function makeHeader({color, depth}) {
  const half_width_rad = Math.atan(Math.tan(kHalfHeight_rad) * kSize_px.width / kSize_px.height);
  const fov = {angle_left_rad: -half_width_rad, angle_right_rad: half_width_rad,
               angle_up_rad: kHalfHeight_rad, angle_down_rad: -kHalfHeight_rad};
  const planes = [
    {kind: 'PLANE_KIND_COLOR', encoding: 'PLANE_ENCODING_RGB8', size: kSize_px,
     bytes_count: color.length},
    {kind: 'PLANE_KIND_DEPTH', encoding: 'PLANE_ENCODING_DEPTH_F32', size: kSize_px,
     depth: {meaning: 'DEPTH_MEANING_PLANAR'}, bytes_count: depth.length},
  ];
  return {number: 1, capture_time_ns: String(BigInt(Date.now()) * 1_000_000n),
          sources: [{camera: {fov}, layers: [{planes}]}]};
}

// Waits where the connection is slower than the program.
async function write(call, message) {
  if (!call.write(message)) await once(call, 'drain');
}

async function writeFrame(call) {
  const planes = makePlanes();
  await write(call, {header: makeHeader(planes)});
  for (const [plane_index, bytes] of [planes.color, planes.depth].entries()) {
    for (let offset = 0; offset < bytes.length; offset += kChunkBytesMax) {
      const data = bytes.subarray(offset, offset + kChunkBytesMax);
      await write(call, {chunk: {plane_index, offset_bytes: offset, data}});
    }
  }
}

run({}, async (options) => {
  const client = connect('IngestService', options);
  const call = client.PublishFrames();
  process.once('SIGINT', () => call.end());
  await write(call, {settings: {stream: options.stream}});
  const writing = writeFrame(call);
  for await (const {message, report} of call) {
    if (message === 'report') {
      console.log(
          printable(`frame ${report.number}: ${report.outcome} ${report.reason}`.trimEnd()));
    }
  }
  await writing;
  client.close();
});
