// SPDX-License-Identifier: Apache-2.0
// Watches one quilt of a stream and saves it as a JPEG, whose name tells its layout.
//   node watch_quilt.js --stream demo --preset portrait --out quilt
import {writeFile} from 'node:fs/promises';

import {connect, run} from './command_line.js';

// One atlas: its layout, its header, and its bands joined, which are one JPEG file. Only its end
// makes it whole: one that is abandoned, or that another header follows, is discarded.
async function receiveQuilt(client, stream, display) {
  const call = client.StreamAtlases();
  call.write({open: {stream, display, count: 1}});
  call.end();
  let layout;
  let header;
  let bands = [];
  for await (const {message, ...body} of call) {
    if (message === 'layout') {
      layout = body.layout;
    } else if (message === 'header') {
      header = body.header;
      bands = [];
    } else if (message === 'band' && body.band.plane === 'ATLAS_PLANE_COLOR') {
      bands.push(body.band.data);
    } else if (message === 'abandoned') {
      header = undefined;
      bands = [];
    } else if (message === 'end' && header?.sequence === body.end.sequence) {
      return {layout, header, jpeg: Buffer.concat(bands)};
    }
  }
  throw new Error('the server ended before an atlas was whole');
}

const kOptions = {
  preset: {type: 'string', default: 'portrait'},
  out: {type: 'string', default: 'quilt'},
};

run(kOptions, async (options) => {
  const client = connect('DisplayService', options);
  const {layout, header, jpeg} =
      await receiveQuilt(client, options.stream, {preset: options.preset});
  client.close();
  const file = `${options.out}${layout.suffix}.jpg`;
  await writeFile(file, jpeg);
  const {columns, rows, tile_size: tile, view_count: views, order} = layout;
  console.log(`frame ${header.frame_number}: ${columns}x${rows} tiles, ${views} views of ` +
              `${tile.width}x${tile.height} px, ${order}; wrote ${file}`);
});
