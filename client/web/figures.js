// SPDX-License-Identifier: Apache-2.0
// The live figures: rate, latency by stage, drops, how rays ended.
import {Chart, spanText} from './chart.js';
import {latencyText} from './eye_poses.js';
import {shownViews} from './stage.js';
import {Stillness} from './stillness.js';

const kRateWindow_ms = 3000;
const kSmoothing = 0.25;  // weight of the newest atlas in a running mean
const kHistoryCount = 120;     // atlases in a chart
const kSecondsCount = 60;      // of rate and drops
const kTick_ms = 1000;
const kRefresh_ms = 250;
const kLongLatency_ms = 10_000;  // from here on in seconds
const kMsPerNs = 1e-6;
// Scales of charts, in words.
const kMinute = {unit: '', begin: '1 min ago'};
const kHistory = `${kHistoryCount} pictures ago`;

// Meaning of each bar, in the order in which an atlas meets them.
const kStages = [
  ['receive', 'receiving', 'the frame arrives at the server'],
  ['decode', 'unpacking', 'its colour and depth are unpacked'],
  ['retime', 'motion', 'things that move are set to the time shown'],
  ['upload', 'to the GPU', 'they are copied to the graphics device'],
  ['build', 'surfaces', 'surfaces are made of them'],
  ['wait', 'waiting', 'other work goes first'],
  ['trace', 'views', 'the views are drawn'],
  ['encode', 'JPEG', 'the picture is compressed'],
  ['mailbox', 'for this page', 'the picture waits until this page is ready for it'],
  ['delivery', 'to the screen', 'network and browser, and the way back'],
  ['browser', 'unpacking here', 'the browser decodes the picture; a part of the line above'],
];
// Stages that follow each other from the frame's first byte to the picture: what is stacked.
const kStacked = kStages.slice(0, -1).map(([stage]) => stage);
const stageColor = (index) => `hsl(${165 + 24 * index} 55% 58%)`;
const kAnswers = [
  ['hit', 'seen by the source'], ['hit_assumed', 'seen past an edge'],
  ['hidden', 'hidden, filled in'], ['outside', 'past the source’s edge'], ['empty', 'background'],
];

const byId = (id) => document.getElementById(id);

function element(tag, properties = {}, parent = null) {
  const made = Object.assign(document.createElement(tag), properties);
  parent?.append(made);
  return made;
}

// Rate of arrivals, per second: by the gaps between them, or by the time since the newest when that
// is longer.
function rateOf(arrivals, now_ms) {
  if (arrivals.length < 2) return 0;
  const [first, last] = [arrivals[0].time_ms, arrivals.at(-1).time_ms];
  return (arrivals.length - 1) * 1000 / Math.max(last - first, now_ms - last);
}

function milliseconds(value) {
  return value >= 100 ? value.toFixed(0) : value.toFixed(1);
}

// With the quantisation that the server has chosen, and its second rung for slow lines.
function videoText({video_qp, reference_sequence, encoding}) {
  const chosen = video_qp ? `, QP ${video_qp}` : '';
  const rung = encoding?.video_rung > 1 ? ', second rung' : '';
  return ` of H.264${chosen}${rung}${reference_sequence ? ', chained' : ''}`;
}

export class Figures {
  #arrivals = [];  // {time_ms}, oldest first
  #means = {};     // ms
  #charts = {};
  #dropsBefore = 0;  // at the last tick
  #newest = null;
  #bars = {};
  #shares = {};
  #facts = {};
  #drops = 0;
  #motion = null;
  #stillness = new Stillness();
  #isOver = false;  // the publisher is gone

  constructor() {
    for (const [index, [stage, label, title]] of kStages.entries()) {
      const name = element('dt', {textContent: label, title}, byId('stages'));
      if (kStacked[index]) name.style.setProperty('--own', stageColor(index));
      const meter = element('meter', {min: 0, max: 1, value: 0}, element('dd', {}, byId('stages')));
      meter.setAttribute('aria-label', title);
      const value = element('dd', {className: 'value', textContent: '–'}, byId('stages'));
      this.#bars[stage] = {meter, value};
    }
    for (const [answer, label] of kAnswers) {
      const part = element('i', {}, byId('coverage-bar'));
      const name = element('dt', {textContent: label}, byId('coverage'));
      name.dataset.answer = part.dataset.answer = answer;
      this.#shares[answer] = {part, value: element('dd', {textContent: '–'}, byId('coverage'))};
    }
    for (const fact of ['Picture', 'Frame', 'Time', 'Views', 'Size', 'A view', 'Data',
                        'Data rate', 'Motion to picture', 'Skipped']) {
      element('dt', {textContent: fact}, byId('facts'));
      this.#facts[fact] = element('dd', {textContent: '–'}, byId('facts'));
    }
    this.#makeCharts();
    setInterval(() => this.#refresh(), kRefresh_ms);
    setInterval(() => this.#tick(), kTick_ms);
  }

  #makeCharts() {
    const firsts = (samples) => samples.map(([value]) => value);
    const sums = (samples) =>
        samples.map((values) => values.reduce((sum, value) => sum + value, 0));
    this.#charts = {
      rate: {colors: ['--accent'], count: kSecondsCount, ...kMinute, describe: (samples) =>
        `Pictures a second, over ${samples.length} s: ${spanText(firsts(samples), 1)}`},
      latency: {colors: kStacked.map((_, index) => stageColor(index)), count: kHistoryCount,
                unit: ' ms', begin: kHistory, describe: (samples) =>
                  `Latency of the last ${samples.length} pictures, ms: ` +
                      spanText(sums(samples), 0)},
      drops: {colors: ['--second'], count: kSecondsCount, ...kMinute, describe: (samples) =>
        `Pictures skipped for newer ones each second, over ${samples.length} s: ` +
            spanText(firsts(samples), 0)},
      coverage: {colors: ['--accent', '--second', '--warm', '--bad', '--empty'],
                 count: kHistoryCount, highest: 100, unit: ' %', begin: kHistory,
                 describe: (samples) => 'What the picture is made of, now: ' +
                     kAnswers.map(([, label], index) =>
                         `${label} ${samples.at(-1)[index].toFixed(1)} %`).join('; ')},
    };
    for (const [name, options] of Object.entries(this.#charts)) {
      this.#charts[name] = new Chart(byId(`chart-${name}`), options);
    }
  }

  clear() {
    this.#arrivals = [];
    this.#means = {};
    this.#drops = this.#dropsBefore = 0;
    this.#newest = null;
    this.#stillness.clear();
    this.#isOver = false;
    for (const chart of Object.values(this.#charts)) chart.clear();
  }

  // The browser was too slow for an atlas it had received.
  noteDropped() {
    this.#drops++;
  }

  // From now on all pictures are other views of one frame.
  set isOver(isOver) {
    this.#isOver = isOver;
  }

  noteArrived() {
    this.#arrivals.push({time_ms: performance.now()});
  }

  // latency: of the eye (eye_poses.js), or null
  noteMotion(latency) {
    this.#motion = latency;
  }

  noteShown(atlas) {
    const {times, mailbox_ns, shown_ns} = atlas.header;
    const figures = {
      mailbox: mailbox_ns * kMsPerNs, delivery: shown_ns * kMsPerNs, browser: atlas.decode_ms,
      total: times.total_ns * kMsPerNs,
    };
    for (const [stage] of kStages) {
      if (`${stage}_ns` in times) figures[stage] = times[`${stage}_ns`] * kMsPerNs;
    }
    // A picture that stood before it was asked for has no latency.
    const isNew = this.#stillness.note(atlas.header, performance.now());
    if (isNew) figures.latency = figures.total + figures.mailbox + figures.delivery;
    for (const [name, value] of Object.entries(figures)) {
      const before = this.#means[name] ?? value;
      this.#means[name] = before + (value - before) * kSmoothing;
    }
    if (isNew) this.#charts.latency.push(kStacked.map((stage) => figures[stage] ?? 0));
    this.#charts.coverage.push(kAnswers.map(([answer]) => 100 * atlas.header.coverage[answer]));
    this.#newest = atlas;
  }

  #refresh() {
    if (!this.#newest) return;
    const rate_hz = this.#rate_hz();
    this.#refreshHeadline(rate_hz);
    this.#refreshStages();
    this.#refreshCoverage();
    this.#refreshFacts(rate_hz);
    for (const chart of Object.values(this.#charts)) chart.draw();
  }

  #rate_hz() {
    const now_ms = performance.now();
    // A slow server's newest two count however old they are.
    this.#arrivals = this.#arrivals.filter(({time_ms}, index, all) =>
        now_ms - time_ms < kRateWindow_ms || index >= all.length - 2);
    return rateOf(this.#arrivals, now_ms);
  }

  // By the server for this viewer, and by the browser.
  #dropCount() {
    return this.#newest.header.dropped_count + this.#drops;
  }

  #tick() {
    if (!this.#newest) return;
    const drops = this.#dropCount();
    this.#charts.rate.push([this.#rate_hz()]);
    // Another connection counts from 0 again.
    this.#charts.drops.push([Math.max(0, drops - this.#dropsBefore)]);
    this.#dropsBefore = drops;
  }

  #refreshHeadline(rate_hz) {
    const {latency} = this.#means;
    const isStill = this.#isOver || this.#stillness.isStill(performance.now());
    const isLong = latency >= kLongLatency_ms;
    const unit = isLong ? 's' : 'ms';
    const amount = latency === undefined ? '–' : (isLong ? latency / 1000 : latency)
        .toFixed(isLong ? 1 : 0);
    const rate = rate_hz.toFixed(rate_hz < 1 ? 2 : 1);
    byId('rate').textContent = isStill ? '–' : rate;
    byId('latency').textContent = isStill ? 'still' : amount;
    byId('latency-unit').textContent = isStill ? 'no newer picture' : `${unit} latency`;
    const moving = latency === undefined ? '' : `${rate}/s, ${amount} ${unit}`;
    byId('brief').textContent = isStill ? 'still' : moving;
  }

  #refreshStages() {
    const longest = Math.max(1, ...kStages.map(([stage]) => this.#means[stage] ?? 0));
    for (const [stage] of kStages) {
      const {meter, value} = this.#bars[stage];
      const mean = this.#means[stage];
      meter.value = (mean ?? 0) / longest;
      value.textContent = mean === undefined ? '–' : milliseconds(mean);
    }
  }

  #refreshCoverage() {
    for (const [answer] of kAnswers) {
      const share = this.#newest.header.coverage[answer];
      this.#shares[answer].part.style.width = `${100 * share}%`;
      this.#shares[answer].value.textContent = (100 * share).toFixed(share < 0.1 ? 2 : 1);
    }
  }

  #refreshFacts(rate_hz) {
    const {header, bytes, pictures} = this.#newest;
    const {layout} = header;
    const {isPart, total} = shownViews(layout);
    const facts = {
      'Picture': header.sequence,
      'Frame': header.frame_number,
      'Time': header.timing,
      'Views': isPart ? `${layout.view_count} of ${total}, around the eye` :
        `${layout.columns} × ${layout.rows} = ${layout.view_count}`,
      'Size': `${layout.size.width} × ${layout.size.height} px`,
      'A view': `${layout.tile_size.width} × ${layout.tile_size.height} px`,
      'Data': `${(bytes / 1e6).toFixed(2)} MB${pictures.length > 0 ? videoText(header) : ''}`,
      'Motion to picture': latencyText(this.#motion),
      'Data rate': `${(rate_hz * bytes * 8 / 1e6).toFixed(1)} Mbit/s`,
      'Skipped': `${this.#dropCount()} for newer pictures`,
    };
    for (const [fact, value] of Object.entries(facts)) this.#facts[fact].textContent = value;
  }
}
