// SPDX-License-Identifier: Apache-2.0
// Depth as the server packs it for reprojection: BAND_ENCODING_COMPACT_DEPTH of proto/web.md.

const kStepBytes = 4;

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Undoes the prediction. residuals: low bytes, then high bytes. Writes 1/Z to `inv_z`.
function unpredict(residuals, step, columns, rows, inv_z) {
  const count = columns * rows;
  if (residuals.length !== 2 * count) {
    throw new Error(`compact depth has ${residuals.length} bytes instead of ${2 * count}`);
  }
  let above = new Uint16Array(columns);
  let newest = new Uint16Array(columns);
  for (let row = 0, at = 0; row < rows; ++row) {
    let left = 0;
    let aboveLeft = 0;
    for (let x = 0; x < columns; ++x, ++at) {
      const written = residuals[at] | residuals[count + at] << 8;
      const residual = (written >> 1) ^ -(written & 1);
      const over = above[x];
      left = (residual + left + over - aboveLeft) & 0xffff;
      aboveLeft = over;
      newest[x] = left;
      inv_z[at] = left * step;
    }
    [above, newest] = [newest, above];
  }
}

// bytes: Uint8Array of all bands; bands: [{first_row, row_count, bytes}], rows in px, from the top
// down; width_px: of the atlas. {inv_z: Float32Array in 1/m, columns, rows}: a sample a block of
// 2 x 2 px.
export async function unpackDepth(bytes, bands, width_px) {
  const columns = Math.ceil(width_px / 2);
  const rowsOf = ({row_count}) => Math.ceil(row_count / 2);
  const rows = bands.reduce((sum, band) => sum + rowsOf(band), 0);
  const inv_z = new Float32Array(columns * rows);
  let begin = 0;
  await Promise.all(bands.map(async (band) => {
    const part = bytes.subarray(begin, begin + band.bytes);
    begin += band.bytes;
    const step = new DataView(part.buffer, part.byteOffset).getFloat32(0, true);
    const at = columns * Math.ceil(band.first_row / 2);
    const samples = inv_z.subarray(at, at + columns * rowsOf(band));
    unpredict(await inflated(part.subarray(kStepBytes)), step, columns, rowsOf(band), samples);
  }));
  return {inv_z, columns, rows};
}
