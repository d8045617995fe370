// SPDX-License-Identifier: Apache-2.0
// Decodes atlases away from the thread that draws.
import {decoded, recycle} from './decoder.js';

self.onmessage = async ({data: job}) => {
  if (job.planes) {
    recycle(job.planes);
    return;
  }
  try {
    const made = await decoded(job);
    const moved = [made.bitmap ?? made.planes?.buffer].filter(Boolean);
    if (made.depth) moved.push(made.depth.inv_z.buffer);
    self.postMessage(made, moved);
  } catch (error) {
    self.postMessage({error: error.message});
  }
};
