// SPDX-License-Identifier: Apache-2.0
// The label over a picture that has less detail than there is room for.

const kFullShare = 0.97;  // of the full width; the rest is rounding

// width_px: of a view as it came; full_px: in full detail; isAutomatic: by the page's own choice
export function labelReduced(width_px, full_px, isAutomatic) {
  const label = document.getElementById('reduced');
  const isReduced = width_px < kFullShare * full_px;
  label.hidden = !isReduced;
  if (!isReduced) return;
  const why = isAutomatic ? 'Reduced detail for now' : 'Reduced detail, as chosen';
  const text = `${why}: ${width_px} of ${full_px} px wide`;
  if (label.textContent !== text) label.textContent = text;
}
