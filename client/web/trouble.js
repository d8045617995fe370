// SPDX-License-Identifier: Apache-2.0
// Reasons why the page shows no picture, with the ways out, in place of the picture.
import {addressWith, pageParameters} from './address.js';

const byId = (id) => document.getElementById(id);
let retry = null;

byId('trouble-again').addEventListener('click', () => retry?.());

// title, text: sentences; ways: [{text, changes}], links to this page with another address, as
// keepInAddress() takes the changes; again(): tries once more, null = that would change nothing
export function showTrouble({title, text, ways = [], again = null}) {
  retry = again;
  byId('trouble-title').textContent = title;
  byId('trouble-text').textContent = text;
  byId('trouble-again').hidden = again === null;
  byId('trouble-ways').replaceChildren(...ways.map(({text: name, changes}) => {
    const link = document.createElement('a');
    link.href = addressWith(changes);
    link.textContent = name;
    const item = document.createElement('li');
    item.append(link);
    return item;
  }));
  byId('trouble').hidden = false;
}

export function endTrouble() {
  byId('trouble').hidden = true;
}

// An address that says no display: an Error, with `ways` where there are some.
export function badAddress({message, ways}) {
  const nothing = Object.fromEntries([...pageParameters().keys()].map((name) => [name, null]));
  return {
    title: 'This address shows nothing', text: message,
    ways: ways ?? [{text: 'Open the page without it', changes: nothing}],
  };
}

// others: names of the streams that are there; again(): looks once more, null = that goes on
export function missingStream(name, others, again) {
  const looks = again ? 'It did not come.' : 'It is looked for during one minute.';
  const start = `Start it with: viewloom publish --synthetic --stream ${name}`;
  return {
    title: `There is no stream "${name}"`,
    text: `${looks} ${others.length > 0 ? 'These streams are there:' : start}`,
    ways: others.map((text) => ({text, changes: {stream: text}})),
    again,
  };
}
