// SPDX-License-Identifier: Apache-2.0
// Decodes atlases away from the thread that draws.
import {decoded} from './decoder.js';

self.onmessage = async ({data: job}) => {
  try {
    const made = await decoded(job);
    const moved = made.depth ? [made.bitmap, made.depth.inv_z.buffer] : [made.bitmap];
    self.postMessage(made, moved);
  } catch (error) {
    self.postMessage({error: String(error)});
  }
};
