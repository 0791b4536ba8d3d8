// Bar: a slider with a number field beside it. The scale of wide ranges is nonlinear, so that typical values are not
// all at one end.
'use strict';

const bars = (() => {
  const STEPS = 1000;
  const THUMB = 14;  // pixels, as in style.css

  // Returns functions that map a value to its position on the bar (0 .. 1) and back.
  function scale(min, max, typical) {
    const bound = Math.max(Math.abs(min), Math.abs(max));
    const size = Math.abs(typical) || 1;
    const span = max - min;
    if (span <= 200 || size > bound / 20) return { to: (v) => (v - min) / span, from: (p) => min + p * span };
    // the typical magnitude is at 40 % of the way from the middle, or from the lower end
    const power = Math.log((size - (min > 0 ? min : 0)) / bound) / Math.log(0.4);
    if (min >= 0) {
      return { to: (v) => Math.pow(Math.max(0, (v - min) / span), 1 / power), from: (p) => min + span * Math.pow(p, power) };
    }
    return {
      to: (v) => 0.5 + 0.5 * Math.sign(v) * Math.pow(Math.abs(v) / bound, 1 / power),
      from: (p) => Math.min(max, Math.max(min, bound * Math.sign(p - 0.5) * Math.pow(Math.abs(2 * p - 1), power))),
    };
  }

  // Handles the pointer on a bar. Mouse and keys act immediately. A touch acts only after a sideways movement, relative
  // to its start: a tap sets nothing, and a vertical swipe scrolls the page (touch-action: pan-y in style.css).
  const SIDEWAYS = 8;  // pixels until a touch acts

  function trackPointer(bar, range, begin, move, end) {
    let pointer = null;  // id of the active pointer
    let from = 0;        // start of the drag, pixels
    let start = 0;       // value of the bar at the start of the drag, 0 .. 1
    let dragging = false;
    const width = () => Math.max(1, bar.getBoundingClientRect().width - THUMB);
    const place = (event) => (event.clientX - bar.getBoundingClientRect().left - THUMB / 2) / width();
    const clamp01 = (at) => Math.min(1, Math.max(0, at));
    function startDrag() {
      dragging = true;
      bar.setPointerCapture(pointer);
      begin();
    }
    function endDrag(event) {
      if (event.pointerId !== pointer) return;
      pointer = null;
      if (dragging) end();
      dragging = false;
    }
    bar.addEventListener('pointerdown', (event) => {
      if (pointer !== null || event.button !== 0) return;
      pointer = event.pointerId;
      from = event.clientX;
      start = range.value / STEPS;
      if (event.pointerType !== 'mouse') return;
      event.preventDefault();
      range.focus({ preventScroll: true });
      start = clamp01(place(event));
      startDrag();
      move(start);
    });
    bar.addEventListener('pointermove', (event) => {
      if (event.pointerId !== pointer) return;
      if (!dragging) {
        if (Math.abs(event.clientX - from) < SIDEWAYS) return;
        from = event.clientX;
        start = range.value / STEPS;
        startDrag();
      }
      move(clamp01(start + (event.clientX - from) / width()));
    });
    for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) bar.addEventListener(name, endDrag);
  }

  // Formats a value with five significant digits, which avoids texts like 0.30000001.
  function format(value, whole) {
    if (typeof value !== 'number' || !isFinite(value)) return '';
    return whole ? String(Math.round(value)) : String(Number(value.toPrecision(5)));
  }

  // Creates a bar. options: min, max, typical, whole, step, label; changed(value) is called on each user input.
  function make(options, changed) {
    const box = document.createElement('div');
    box.className = 'axis';
    const number = document.createElement('input');
    number.type = 'number';
    number.className = 'number';
    number.step = options.whole ? '1' : 'any';
    number.inputMode = options.min >= 0 ? 'decimal' : 'text';
    number.setAttribute('aria-label', options.label);
    const bounded = isFinite(options.min) && isFinite(options.max);
    if (isFinite(options.min)) number.min = options.min;
    if (isFinite(options.max)) number.max = options.max;
    let range = null;
    let stretch = null;
    if (bounded && options.max > options.min) {
      stretch = scale(options.min, options.max, options.typical);
      const bar = document.createElement('div');
      bar.className = 'bar';
      range = document.createElement('input');
      range.type = 'range';
      range.min = 0;
      range.max = STEPS;
      range.step = 1;
      range.setAttribute('aria-label', options.label);
      bar.append(range);
      box.append(bar);
    } else {
      number.classList.add('wide');
    }
    box.append(number);

    const widget = { box, dragging: false, value: NaN, show, release() {} };
    function paint(value) {
      if (!range) return;
      const at = Math.min(1, Math.max(0, stretch.to(value)));
      const zero = Math.min(1, Math.max(0, stretch.to(Math.min(options.max, Math.max(options.min, 0)))));
      range.style.setProperty('--from', Math.min(at, zero));
      range.style.setProperty('--to', Math.max(at, zero));
      if (!widget.dragging || document.activeElement !== range) range.value = Math.round(at * STEPS);
      range.setAttribute('aria-valuetext', format(value, options.whole));
    }
    function show(value) {
      widget.value = value;
      paint(value);
      if (document.activeElement !== number) number.value = format(value, options.whole);
    }
    function hold() { widget.dragging = true; }
    function release() {
      if (!widget.dragging) return;
      widget.dragging = false;
      widget.release();
    }
    if (range) {
      const set = (at) => {
        const value = stretch.from(at);
        widget.value = options.whole ? Math.round(value) : Number(value.toPrecision(5));
        paint(widget.value);
        number.value = format(widget.value, options.whole);
        changed(widget.value);
      };
      trackPointer(range.parentNode, range, hold, (at) => { range.value = Math.round(at * STEPS); set(at); }, release);
      for (const end of ['change', 'blur']) range.addEventListener(end, release);
      range.addEventListener('input', () => set(range.value / STEPS));
      range.addEventListener('keydown', (event) => {
        if (event.key !== 'Home' && event.key !== 'End' && !/^(Arrow|Page)/.test(event.key)) return;
        widget.dragging = false;
      });
    }
    number.addEventListener('input', () => {
      const value = Number(number.value);
      if (number.value === '' || !isFinite(value) || !number.checkValidity()) return;
      widget.value = value;
      paint(value);
      changed(value);
    });
    number.addEventListener('blur', () => show(widget.value));
    number.addEventListener('keydown', (event) => { if (event.key === 'Enter') number.blur(); });
    return widget;
  }

  return { make, format };
})();
