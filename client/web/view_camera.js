// SPDX-License-Identifier: Apache-2.0
// Cameras and poses as the protocol has them: metres, +x right, +y up, -z forward; quaternions
// [x, y, z, w]; px of an image from its top left corner.

export function multiply([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

// Rotates a vector.
export function rotate([x, y, z, w], [vx, vy, vz]) {
  const [cx, cy, cz] = [
    y * vz - z * vy + w * vx, z * vx - x * vz + w * vy, x * vy - y * vx + w * vz,
  ];
  return [
    vx + 2 * (y * cz - z * cy), vy + 2 * (z * cx - x * cz), vz + 2 * (x * cy - y * cx),
  ];
}

export const inverse = ([x, y, z, w]) => [-x, -y, -z, w];

// About an axis of length 1.
export function turn([x, y, z], angle_rad) {
  const sine = Math.sin(angle_rad / 2);
  return [x * sine, y * sine, z * sine, Math.cos(angle_rad / 2)];
}

export const add = (a, b) => a.map((value, axis) => value + b[axis]);
export const subtract = (a, b) => a.map((value, axis) => value - b[axis]);
export const distance = (a, b) => Math.hypot(...subtract(a, b));

// A view of a layout: {position, orientation, focal_px: [x, y], principal_px: [x, y]}.
export function cameraOf({pose: {position, orientation}, intrinsics}) {
  return {
    position: [position.x, position.y, position.z],
    orientation: [orientation.x, orientation.y, orientation.z, orientation.w],
    focal_px: [intrinsics.focal_x_px, intrinsics.focal_y_px],
    principal_px: [intrinsics.principal_x_px, intrinsics.principal_y_px],
  };
}

// fov: {left, right, up, down}, tangents of the angles from the axis, right and up positive.
export function cameraWithFov({position, orientation}, {left, right, up, down}, {width, height}) {
  const focal_px = [width / (right - left), height / (up - down)];
  return {
    position, orientation, focal_px,
    principal_px: [-left * focal_px[0], up * focal_px[1]],
  };
}

// The same tangents of a camera whose image has that size.
export function fovOf({focal_px, principal_px}, {width, height}) {
  return {
    left: -principal_px[0] / focal_px[0],
    right: (width - principal_px[0]) / focal_px[0],
    up: principal_px[1] / focal_px[1],
    down: (principal_px[1] - height) / focal_px[1],
  };
}

// A Camera of the protocol. fov: as above.
export function cameraMessage({position, orientation}, {left, right, up, down}) {
  const [x, y, z] = position;
  const [qx, qy, qz, qw] = orientation;
  return {
    pose: {position: {x, y, z}, orientation: {x: qx, y: qy, z: qz, w: qw}},
    fov: {
      angle_left_rad: Math.atan(left), angle_right_rad: Math.atan(right),
      angle_up_rad: Math.atan(up), angle_down_rad: Math.atan(down),
    },
  };
}

// Where a surface that `source` sees at px (u, v), at 1/Z, is seen by `target`:
// matrix * (u, v, 1, 1/Z) = (x, y, z, w), in clip coordinates of an image of target_px, z = w at
// infinity and -w at the distance near_m. Column by column, as WebGL takes it.
export function clipFromSource(source, target, target_px, near_m) {
  const back = inverse(target.orientation);
  const toTarget = (vector) => rotate(back, vector);
  const [fx, fy] = source.focal_px;
  const [px, py] = source.principal_px;
  // Columns of the target's view coordinates: of u, v, 1 and 1/Z.
  const columns = [
    toTarget(rotate(source.orientation, [1 / fx, 0, 0])),
    toTarget(rotate(source.orientation, [0, -1 / fy, 0])),
    toTarget(rotate(source.orientation, [-px / fx, py / fy, -1])),
    toTarget(subtract(source.position, target.position)),
  ];
  const {width, height} = target_px;
  const [gx, gy] = target.focal_px;
  const [qx, qy] = target.principal_px;
  return columns.flatMap(([x, y, z], column) => {
    const w = -z;
    return [
      2 * gx / width * x + (2 * qx / width - 1) * w,
      2 * gy / height * y + (1 - 2 * qy / height) * w,
      column === 3 ? w - 2 * near_m : w,
      w,
    ];
  });
}

// Where px (u, v) at 1/Z is in the target's image, px; null behind it.
export function seenAt(matrix, [u, v], inv_z, {width, height}) {
  const at = (row) =>
    matrix[row] * u + matrix[4 + row] * v + matrix[8 + row] + matrix[12 + row] * inv_z;
  const w = at(3);
  if (w <= 0) return null;
  return [(at(0) / w + 1) / 2 * width, (1 - at(1) / w) / 2 * height];
}
