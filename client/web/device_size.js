// SPDX-License-Identifier: Apache-2.0
// How many px of the screen an element covers.

// onSize({width, height}), px, now and whenever it changes. Where the browser does not say it, CSS
// px times the scale are rounded.
export function watchDeviceSize(element, onSize) {
  const observer = new ResizeObserver(([entry]) => {
    const [box] = entry.devicePixelContentBoxSize ?? [];
    const scale = window.devicePixelRatio || 1;
    onSize({
      width: box?.inlineSize ?? Math.round(element.clientWidth * scale),
      height: box?.blockSize ?? Math.round(element.clientHeight * scale),
    });
  });
  try {
    observer.observe(element, {box: 'device-pixel-content-box'});
  } catch {
    observer.observe(element);
  }
}
