# SPDX-License-Identifier: Apache-2.0
"""Faults of a page that can be computed in the browser: expressions that give lists of them, each
fault as text. An empty list is a good page."""

# Elements that show something or take something.
_SHOWN = """
  const isUnseen = (e) => e.matches('#modes input, option') ||
      getComputedStyle(e).clipPath === 'inset(50%)';  // for screen readers alone
  const shown = [...document.querySelectorAll('body *')].filter(e =>
      e.checkVisibility({opacityProperty: true, visibilityProperty: true}) && !isUnseen(e));
  const nameOf = (e) => e.id || `${e.tagName} ${e.textContent.trim().slice(0, 30)}`;
  const hasText = (e) => [...e.childNodes].some(
      n => n.nodeType === Node.TEXT_NODE && n.textContent.trim());
"""

# Texts and controls that lie over each other.
OVERLAPS = """(() => {""" + _SHOWN + """
  // Some texts lie over the picture, and over what stands in its place.
  const parts = shown.filter(e => !e.closest('#notice, #reduced') &&
      (hasText(e) || e.matches('input, select, textarea, .chart')));
  const boxes = parts.map(e => [e, e.getBoundingClientRect()]);
  const found = [];
  boxes.forEach(([a, p], index) => {
    for (const [b, q] of boxes.slice(index + 1)) {
      if (a.contains(b) || b.contains(a)) continue;
      const width = Math.min(p.right, q.right) - Math.max(p.left, q.left);
      const height = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
      if (width > 1 && height > 1) found.push(`${nameOf(a)} and ${nameOf(b)}`);
    }
  });
  return found;
})()"""

# Elements that reach out of the window to a side, and texts that are cut off.
OUTSIDE = """(() => {""" + _SHOWN + """
  const found = shown.filter(e => {
    const box = e.getBoundingClientRect();
    return box.width > 0 && (box.left < -0.5 || box.right > innerWidth + 0.5);
  }).map(e => `${nameOf(e)} is outside`);
  const cut = shown.filter(e => hasText(e) && !e.matches('select, textarea') &&
      e.clientWidth > 0 && e.scrollWidth > e.clientWidth + 1);
  found.push(...cut.map(e => `${nameOf(e)} is cut`));
  if (document.documentElement.scrollWidth > innerWidth) found.push('the page scrolls to a side');
  return found;
})()"""

# Texts below the contrast of Web Content Accessibility Guidelines 2 (AA, small text), with it. Each
# is held against the grounds that lie under it, mixed as far as they let through.
LOW_CONTRASTS = """(() => {""" + _SHOWN + """
  const least = 4.5;
  const typed = ':is(input, select, textarea):not([type=range], [type=checkbox], [type=radio])';
  const channels = (color) => {
    const [r, g, b, a = 1] = color.match(/[\\d.]+/g).map(Number);
    return [r, g, b, a];
  };
  const mixed = (over, under) => [0, 1, 2].map(i => over[i] * over[3] + under[i] * (1 - over[3]));
  const groundOf = (e) => {
    if (!e) return channels(getComputedStyle(document.documentElement).backgroundColor);
    const own = channels(getComputedStyle(e).backgroundColor);
    return own[3] === 1 ? own : mixed(own, groundOf(e.parentElement));
  };
  const opacityOf = (e) => e ? getComputedStyle(e).opacity * opacityOf(e.parentElement) : 1;
  const linear = (code) => code <= 10 ? code / 3294 : ((code / 255 + 0.055) / 1.055) ** 2.4;
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const contrast = (e, part) => {
    const ground = groundOf(e);
    const text = channels(getComputedStyle(e, part).color);
    text[3] *= opacityOf(e);
    const [dark, light] = [mixed(text, ground), ground].map(luminance).sort((a, b) => a - b);
    return (light + 0.05) / (dark + 0.05);
  };
  const texts = shown.filter(e => hasText(e) || e.matches(typed))
      .map(e => [e, contrast(e, null)]);
  texts.push(...shown.filter(e => e.placeholder).map(e => [e, contrast(e, '::placeholder')]));
  return texts.filter(([, ratio]) => ratio < least)
      .map(([e, ratio]) => `${nameOf(e)}: ${ratio.toFixed(2)}`);
})()"""

# Controls that are switched off without saying why.
UNREASONED = """(() => {""" + _SHOWN + """
  return [...document.querySelectorAll(':is(button, select, input, textarea):disabled')]
      .filter(e => e.closest('fieldset') || shown.includes(e))
      .filter(e => !e.title || e.ariaDescription !== e.title).map(nameOf);
})()"""
