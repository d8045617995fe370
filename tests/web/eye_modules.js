// SPDX-License-Identifier: Apache-2.0
// Checks of the page's modules about eyes: cameras, the rig, poses, clocks, compact depth.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';

import {unpackDepth} from './compact_depth.js';
import {EyePoses, latencyText} from './eye_poses.js';
import {EyeRig, placeInCone} from './eye_rig.js';
import {motionToPicture, ServerClock} from './server_clock.js';
import {cameraOf, cameraWithFov, clipFromSource, fovOf, rotate, seenAt, turn}
  from './view_camera.js';

const kSize = {width: 400, height: 300};
const kFov = {left: -0.5, right: 0.3, up: 0.4, down: -0.2};
const near = (actual, expected, error = 1e-9) => [actual].flat().forEach((value, index) =>
  assert.ok(Math.abs(value - [expected].flat()[index]) <= error, `${actual} is not ${expected}`));

// Px at which a camera sees a point.
function project({position, orientation, focal_px, principal_px}, point) {
  const [x, y, z, w] = orientation;
  const seen = rotate([-x, -y, -z, w], point.map((value, axis) => value - position[axis]));
  return {px: [principal_px[0] - focal_px[0] * seen[0] / seen[2],
    principal_px[1] + focal_px[1] * seen[1] / seen[2]], inv_z: -1 / seen[2]};
}

test('a turn about up moves what is ahead to the left', () => {
  near(rotate(turn([0, 1, 0], Math.PI / 2), [0, 0, -1]), [-1, 0, 0]);
});

test('tangents of a field of view come back from the camera that has it', () => {
  const camera = cameraWithFov({position: [0, 0, 0], orientation: [0, 0, 0, 1]}, kFov, kSize);
  near(Object.values(fovOf(camera, kSize)), Object.values(kFov));
});

test('a px with its depth is seen where another camera projects its point', () => {
  const pose = {position: [0.2, -0.1, 0.5], orientation: turn([0, 1, 0], 0.2)};
  const source = cameraWithFov(pose, kFov, kSize);
  const target = cameraWithFov(
      {position: [-0.1, 0.3, 0.2], orientation: turn([1, 0, 0], -0.1)}, kFov, kSize);
  const matrix = clipFromSource(source, target, kSize, 0.1);
  for (const point of [[0.1, 0.2, -2], [-0.4, 0.1, -9], [0.3, -0.3, -0.8]]) {
    const {px, inv_z} = project(source, point);
    near(seenAt(matrix, px, inv_z, kSize), project(target, point).px, 1e-6);
  }
  const ahead = {...target, position: [0, 0, -3], orientation: [0, 0, 0, 1]};
  const {px, inv_z} = project(source, [0, 0, -2]);
  const passed = clipFromSource(source, ahead, kSize, 0.1);
  assert.equal(seenAt(passed, px, inv_z, kSize), null, 'a point behind the camera');
});

test('depth runs from -w at the near distance to w at infinity', () => {
  const camera = cameraWithFov({position: [0, 0, 0], orientation: [0, 0, 0, 1]}, kFov, kSize);
  const matrix = clipFromSource(camera, camera, kSize, 0.5);
  const zOverW = (inv_z) => {
    const at = (row) => matrix[row] * 10 + matrix[4 + row] * 20 + matrix[8 + row] +
        matrix[12 + row] * inv_z;
    return at(2) / at(3);
  };
  near([zOverW(0), zOverW(2), zOverW(1)], [1, -1, 0]);
});

test('eyes stand in the cone as quilts place them', () => {
  const cone = {count: 48, cone_rad: 0.7};
  near(placeInCone(0.5, cone), 0);
  near(placeInCone(0, cone), Math.tan(0.7 * (0.5 / 48 - 0.5)));
  near(placeInCone(1, {...cone, convention: 'CAMERA_CONVENTION_CORE'}), Math.tan(0.35));
  near(placeInCone(1, {...cone, convention: 'CAMERA_CONVENTION_BRIDGE'}), 0.5 * Math.tan(0.7));
  near(placeInCone(0.5, {count: 1, cone_rad: 0}), 0);
});

// A rig before a window of 2 m x 1 m at 4 m.
function someRig() {
  const rig = new EyeRig();
  rig.cone = {count: 48, cone_rad: 0.7};
  assert.equal(rig.isKnown, false);
  rig.takeWindow({
    tile_size: {width: 200, height: 100}, focal_distance_m: 4, views: [{
      pose: {position: {x: 0, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 0, w: 1}},
      intrinsics: {focal_x_px: 400, focal_y_px: 400, principal_x_px: 100, principal_y_px: 50},
    }]});
  return rig;
}

test('wherever it stands in the cone, the eye frames the same rectangle', () => {
  const rig = someRig();
  for (const position of [0, 0.3, 1]) {
    rig.position = position;
    const camera = rig.camera(kSize);
    near(project(camera, [-1, 0.5, -4]).px, [0, 0], 1e-6);
    near(project(camera, [1, -0.5, -4]).px, [400, 300], 1e-6);
  }
});

test('an orbit and a pan keep the distance, a step changes it, and all can be undone', () => {
  const rig = someRig();
  const pivotAt = (point) => project(rig.camera(kSize), point);
  rig.orbit(0.3, 0.2);
  near(pivotAt([0, 0, -4]).px, [200, 150], 1e-6);
  near(pivotAt([0, 0, -4]).inv_z, 0.25);
  assert.ok(rig.eye.pose.position[0] > 0 && rig.eye.pose.position[1] > 0, 'to the right and up');
  rig.step(0.5);
  near(pivotAt([0, 0, -4]).inv_z, 0.5);
  rig.step(7);
  near(pivotAt([0, 0, -4]).inv_z, 2.5, 1e-6);
  rig.reset();
  rig.pan(0.25, 0);
  near(rig.eye.pose.position, [1, 0, 0]);
  rig.orbit(0, 9);
  assert.ok(rig.eye.pose.position[1] < 4, 'never over the top');
  rig.reset();
  assert.equal(rig.isMoved, false);
});

test('cameras of messages come back as they went', () => {
  const rig = someRig();
  rig.orbit(0.1, -0.2);
  const {pose, fov} = rig.message;
  assert.ok(Math.abs(pose.position.x) > 0.1);
  near(Math.tan(fov.angle_left_rad), rig.eye.fov.left);
  const camera = cameraOf({pose, intrinsics: {
    focal_x_px: 1, focal_y_px: 2, principal_x_px: 3, principal_y_px: 4}});
  near(camera.orientation, rig.eye.pose.orientation);
});

test('poses go once, come back with their note, and never as what is no number', () => {
  const sent = [];
  const poses = new EyePoses((message) => sent.push(message) > 0);
  assert.ok(poses.isFresh);
  assert.ok(poses.put([{pose: {position: {x: 1}}}], {view: 3}));
  assert.equal(poses.put([{pose: {position: {x: 1}}}], {view: 3}), false, 'the same again');
  assert.equal(poses.put([{pose: {position: {x: NaN}}}], {view: 4}), false);
  assert.equal(sent.length, 1);
  const {time_ns} = sent[0].eye_poses;
  const header = {eyes: {time_ns, latched_ns: '0', age_ns: 0}, sequence: 9,
    times: {trace_ns: 0, encode_ns: 0}};
  assert.equal(poses.noteOf(header).view, 3);
  assert.ok(poses.isNewest(header));
  assert.equal(poses.isNewest({}), false);
  poses.shown(header);
  assert.equal(sent[1].presented.sequence, '9');
  assert.equal(poses.latency, null, 'nobody knows the clock');
  poses.shown({...header, sequence: 10});
  assert.equal(sent.length, 2, 'of an eye that stands, further pictures answer no motion');
  poses.restart();
  assert.equal(poses.noteOf(header), undefined);
});

test('a closed connection takes no poses, and the next one gets them', () => {
  let isOpen = false;
  const poses = new EyePoses(() => isOpen);
  assert.equal(poses.put([{pose: {}}], {}), false);
  isOpen = true;
  assert.ok(poses.put([{pose: {}}], {}));
});

test('of several answers the quickest says how far the clock is ahead', () => {
  const clock = new ServerClock();
  assert.equal(clock.ahead_ns, null);
  assert.equal(clock.roundTrip_ms, null);
  const reply = (client, received, sent) => ({client_time_ns: String(client),
    server_received_ns: String(received), server_sent_ns: String(sent)});
  const ahead = 2n ** 60n;
  clock.add(reply(1000n, ahead + 9000n, ahead + 9000n), 9100n);
  clock.add(reply(20_000n, ahead + 20_100n, ahead + 20_300n), 20_400n);
  clock.add(reply(30_000n, ahead + 30_100n, ahead + 30_500n), 30_200n);  // impossible
  assert.equal(clock.ahead_ns, ahead);
  near(clock.roundTrip_ms, 0.0002, 1e-9);
});

test('parts of motion to picture add up', () => {
  const header = {eyes: {time_ns: '1000000', latched_ns: '7000000', age_ns: 2_000_000},
    times: {trace_ns: 5_000_000, encode_ns: 1_000_000}};
  const parts = motionToPicture(header, 20_000_000n, 1_000_000n);
  assert.deepEqual(parts, {total: 19, to_server: 3, waiting: 2, rendering: 6, back: 8});
  assert.equal(latencyText(parts), '19 ms: 3 to the server, 2 waiting, 6 rendering, 8 back');
  for (const ahead_ns of [-1_000_000_000n, 1_000_000_000n]) {
    const {total, ...others} = motionToPicture(header, 20_000_000n, ahead_ns);
    assert.equal(Object.values(others).reduce((sum, part) => sum + part), total);
    assert.ok(Object.values(others).every((part) => part >= 0), 'with a clock that is wrong');
  }
  assert.equal(motionToPicture(header, 20_000_000n, null), null);
  assert.equal(latencyText(null), '–');
});

test('compact depth is unpacked to the nearest surface of each block', async () => {
  const {bands, width, blocks} = JSON.parse(readFileSync('expected.json', 'utf8'));
  const packed = new Uint8Array(readFileSync('packed.bin'));
  const {inv_z, columns, rows} = await unpackDepth(packed, bands, width);
  assert.deepEqual([columns, rows], [blocks[0].length, blocks.length]);
  const nearest = Math.max(...blocks.flat());
  near([...inv_z], blocks.flat(), nearest / 4095);
  await assert.rejects(unpackDepth(packed, bands, width + 2), /compact depth has/);
});
