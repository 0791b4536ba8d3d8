// Widgets: creates the control for a property from its OSCQuery attributes and keeps it up to date.
'use strict';

const widgets = (() => {
  const RESET = 'M3 3v4h4M3.4 7A5.2 5.2 0 1 1 3 9.5';
  const AXES = ['x', 'y', 'z', 'w'];

  function element(kind, name, text) {
    const created = document.createElement(kind);
    if (name) created.className = name;
    if (text !== undefined) created.textContent = text;
    return created;
  }

  function icon(path) {
    const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    svg.setAttribute('viewBox', '0 0 16 16');
    svg.setAttribute('aria-hidden', 'true');
    const shape = document.createElementNS('http://www.w3.org/2000/svg', 'path');
    shape.setAttribute('d', path);
    svg.append(shape);
    return svg;
  }

  // name(): the unescaped name of a node; label(): the same with spaces instead of underscores for properties
  const name = (path) => decodeURIComponent(path.slice(path.lastIndexOf('/') + 1));
  const label = (node) => (node.CONTENTS ? name(node.FULL_PATH) : name(node.FULL_PATH).replace(/_/g, ' '));
  const sentenceCase = (text) => text.charAt(0).toUpperCase() + text.slice(1);
  const flat = (values) => (values || []).flat();
  // true if the difference exceeds the rounding of 32-bit floats in OSC messages
  const differs = (a, b) => a !== b && !(Math.abs(a - b) <= 1e-6 * Math.max(Math.abs(a), Math.abs(b)));

  // convert hue, saturation, brightness (0 .. 1) to #rrggbb and back
  function toHex([h, s, b]) {
    const channel = (n) => {
      const k = (n + 6 * h) % 6;
      return Math.round(255 * (b - b * s * Math.max(0, Math.min(k, 4 - k, 1)))).toString(16).padStart(2, '0');
    };
    return '#' + channel(5) + channel(3) + channel(1);
  }
  function fromHex(hex) {
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
    const max = Math.max(r, g, b);
    const span = max - Math.min(r, g, b);
    if (span === 0) return [0, 0, max];
    const sector = max === r ? ((g - b) / span + 6) % 6 : max === g ? (b - r) / span + 2 : (r - g) / span + 4;
    return [sector / 6, span / max, max];
  }

  // Each kind of control is a function (node, box, changed) that adds its elements to `box` and returns {show(values),
  // dragging()}. It calls changed(values) on user input.
  function toggles(node, box, changed) {
    const names = node.TYPE.length > 1 ? AXES : [''];
    const boxes = [...node.TYPE].map((tag, i) => {
      const wrap = element('label', 'toggle');
      const input = element('input');
      input.type = 'checkbox';
      input.setAttribute('aria-label', label(node) + (names[i] ? ' ' + names[i] : ''));
      wrap.append(input, element('span', '', names[i]));
      box.append(wrap);
      input.addEventListener('change', () => changed(boxes.map((b) => b.checked)));
      return input;
    });
    return { show: (values) => boxes.forEach((b, i) => { b.checked = Boolean(values[i]); }) };
  }

  function choice(node, box, changed) {
    const select = element('select');
    select.setAttribute('aria-label', label(node));
    for (const word of node.RANGE[0].VALS) select.append(new Option(word, word));
    box.append(select);
    select.addEventListener('change', () => changed([select.value]));
    return { show: (values) => { select.value = values[0]; } };
  }

  function color(node, box, changed) {
    const input = element('input');
    input.type = 'color';
    input.setAttribute('aria-label', label(node));
    box.append(input);
    input.addEventListener('input', () => changed(fromHex(input.value)));
    return { show: (values) => { input.value = toHex(values); } };
  }

  function numbers(node, box, changed) {
    const tags = [...node.TYPE.replace(/[[\]]/g, '')];
    const ranges = flat(node.RANGE);
    const typical = flat(node.DEFAULT_VALUE || node.VALUE);
    let release = () => {};
    const list = tags.map((tag, i) => {
      const range = ranges[i] || {};
      const options = {
        min: range.MIN === undefined ? -Infinity : range.MIN, max: range.MAX === undefined ? Infinity : range.MAX,
        typical: typical[i] || 0, whole: tag !== 'f', label: label(node) + (tags.length > 1 ? ' ' + AXES[i] : ''),
      };
      const bar = bars.make(options, () => changed(list.map((b) => b.value)));
      bar.release = () => release();
      if (tags.length > 1) bar.box.prepend(element('b', '', AXES[i]));
      box.append(bar.box);
      return bar;
    });
    return {
      show: (values) => list.forEach((b, i) => b.show(values[i])),
      dragging: () => list.some((b) => b.dragging),
      onRelease(done) { release = done; },
    };
  }

  function readout(node, box) {
    const output = element('output', 'readout' + (label(node) === 'error' ? ' fault' : ''));
    box.append(output);
    const text = (v) => (typeof v === 'number' ? bars.format(v, node.TYPE === 'i' || node.TYPE === 'h') : v === true ? 'yes' : v === false ? 'no' : String(v));
    return { show: (values) => { output.textContent = values.map(text).join('  '); } };
  }

  function action(node, box) {
    const press = element('button', '', sentenceCase(label(node)));
    const fields = [...node.TYPE].filter((tag) => tag === 'f').map((tag, i) => {
      const field = element('input', 'number');
      field.type = 'number';
      field.step = 'any';
      field.value = 0;
      field.setAttribute('aria-label', label(node) + ' ' + AXES[i]);
      box.append(field);
      return field;
    });
    box.append(press);
    press.addEventListener('click', () => link.send(node.FULL_PATH, node.TYPE, fields.map((f) => Number(f.value))));
    return { show() {} };
  }

  function kind(node) {
    if (node.ACCESS === 2) return action;
    if (node.ACCESS === 1) return readout;
    if (/^T+$/.test(node.TYPE)) return toggles;
    if (node.TYPE === 's') return node.RANGE ? choice : readout;
    if (node.EXTENDED_TYPE && node.EXTENDED_TYPE[0] === 'hue') return color;
    return numbers;
  }

  function tooltip(node) {
    const range = flat(node.RANGE)[0];
    const unit = flat(node.UNIT)[0];
    const limits = range && range.MIN !== undefined && range.MAX !== undefined ? range.MIN + ' .. ' + range.MAX : '';
    return [node.DOC || node.DESCRIPTION, [limits, unit].filter(Boolean).join(' '), node.FULL_PATH].filter(Boolean).join('\n');
  }

  // Creates the row of a property and returns {element, free()}. User input is sent at most once per animation frame,
  // only the latest value. Values received while the user drags are shown after the release.
  function row(node, withPath) {
    const box = element('div', 'row');
    if (node.ACCESS !== 1) box.dataset.address = node.FULL_PATH;
    const title = element('span', 'name');
    title.title = tooltip(node);
    title.append(element('span', 'label', label(node)));
    const unit = flat(node.UNIT)[0];
    if (unit) title.append(element('span', 'unit', unit));
    const widget = element('div', 'widget');
    box.append(title, widget);
    let unsent = null;
    let deferred = null;
    let frame = 0;
    const standard = node.DEFAULT_VALUE && flat(node.DEFAULT_VALUE);
    function highlight(values) {
      if (standard) box.classList.toggle('set', standard.some((v, i) => differs(v, values[i])));
    }
    function changed(values) {
      deferred = null;
      unsent = values;
      highlight(values);
      if (!frame) frame = requestAnimationFrame(() => { frame = 0; link.send(node.FULL_PATH, node.TYPE, unsent); });
    }
    const make = kind(node);
    box.classList.toggle('short', make !== numbers && make !== action && node.TYPE.length === 1);
    box.classList.toggle('pressed', make === action);
    const part = make(node, widget, changed);
    const dragging = () => part.dragging !== undefined && part.dragging();
    function receive(values) {
      if (dragging()) { deferred = values; return; }
      part.show(values);
      highlight(values);
    }
    if (part.onRelease) part.onRelease(() => { if (deferred) { const values = deferred; deferred = null; receive(values); } });
    if (standard && node.ACCESS === 3) {
      const reset = element('button', 'reset');
      reset.title = 'Reset to the default: ' + standard.join(' ');
      reset.setAttribute('aria-label', 'Reset ' + label(node) + ' to its default');
      reset.append(icon(RESET));
      reset.addEventListener('click', () => { part.show(standard); changed(standard); });
      box.append(reset);
    }
    if (withPath) box.append(element('span', 'path', node.FULL_PATH));
    if (node.VALUE) receive(flat(node.VALUE));
    const unlisten = node.ACCESS === 2 ? () => {} : link.listen(node.FULL_PATH, receive);
    return { element: box, free: unlisten };
  }

  return { row, element, label, name, sentenceCase };
})();
