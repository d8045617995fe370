// SPDX-License-Identifier: Apache-2.0
// How many px of the screen an element covers.

// onSize({width, height}), px, now and whenever it changes. CSS px times the scale say it but for
// rounding; the browser's own number counts where it is that, which emulated phones' is not.
export function watchDeviceSize(element, onSize) {
  const observer = new ResizeObserver(([entry]) => {
    const [box] = entry.devicePixelContentBoxSize ?? [];
    const scale = window.devicePixelRatio || 1;
    const side = (css_px, device_px) => {
      const scaled_px = css_px * scale;
      return Math.abs(device_px - scaled_px) <= 1 + scale ? device_px : Math.round(scaled_px);
    };
    onSize({
      width: side(element.clientWidth, box?.inlineSize),
      height: side(element.clientHeight, box?.blockSize),
    });
  });
  try {
    observer.observe(element, {box: 'device-pixel-content-box'});
  } catch {
    observer.observe(element);
  }
}
