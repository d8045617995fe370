// SPDX-License-Identifier: Apache-2.0
// Decodes JPEG atlases away from the thread that draws.
self.onmessage = async ({data: blob}) => {
  try {
    const bitmap = await createImageBitmap(blob);
    self.postMessage({bitmap}, [bitmap]);
  } catch (error) {
    self.postMessage({error: String(error)});
  }
};
