// The page: transport, behaviors, parameters, search and messages.
'use strict';

(() => {
  const byId = (id) => document.getElementById(id);
  const expandedPaths = new Set(['/scene', '/physics/sim']);  // paths of the expanded objects
  const isObject = (node) => node.CONTENTS !== undefined;
  const children = (node) => Object.values(node.CONTENTS || {});

  // ---- expandable objects: their contents are fetched and listened to only while they are expanded

  function objectSection(path, title, fill) {
    const box = widgets.element('details');
    const summary = widgets.element('summary');
    const contents = widgets.element('div', 'inside');
    if (title) summary.append(title);
    box.append(summary, contents);
    box.dataset.path = path;
    let rows = [];
    let version = 0;
    const free = () => { for (const r of rows.splice(0)) r.free(); };
    async function refresh() {
      const ownVersion = ++version;
      let node;
      try { node = await link.get(path, '?LIMBER_DEPTH=1'); } catch (error) { return; }
      if (ownVersion !== version || !box.open) return;
      free();
      contents.replaceChildren();
      rows = fill(node, contents);
    }
    function close() {
      version++;
      free();
      contents.replaceChildren();
    }
    box.addEventListener('toggle', () => {
      if (box.open) { expandedPaths.add(path); refresh(); } else { expandedPaths.delete(path); close(); }
    });
    box.open = expandedPaths.has(path);
    return { element: box, summary, free: close, refresh, path, children: () => rows };
  }

  // The titles of the program's own nodes, as in the panel of the window; objects have the names that users gave them.
  const TITLES = {
    '/physics/sim': 'World', '/physics/body': 'Bodies', '/physics/gear': 'Gears', '/visuals': 'View',
    '/lighting': 'Lighting', '/preset': 'Presets',
    '/midi': 'MIDI', '/take': 'Takes', '/edit': 'Undo', '/osc': 'OSC counters',
  };
  const MEMBERS = { part: 'Parts', joint: 'Joints', motor: 'Motors', behavior: 'Behaviors' };

  function titleOf(node) {
    const group = /^\/physics\/body\/[^/]+\/([^/]+)$/.exec(node.FULL_PATH);
    return TITLES[node.FULL_PATH] || (group && MEMBERS[group[1]]);
  }

  function fillProperties(node, contents) {
    const items = [];
    for (const child of children(node)) {
      const part = isObject(child) ? objectSection(child.FULL_PATH, titleOf(child) || widgets.label(child), fillProperties) : widgets.row(child);
      contents.append(part.element);
      items.push(part);
    }
    if (items.length === 0) contents.append(widgets.element('p', 'none', 'Empty'));
    return items;
  }

  // ---- parameters: the scene's first, then the world's, then the rest of the tree

  let sections = [];

  function showParameters(root) {
    for (const s of sections) s.free();
    sections = [];
    const physics = root.CONTENTS.physics;
    const top = [root.CONTENTS.scene, physics && physics.CONTENTS.sim, physics && physics.CONTENTS.body, root.CONTENTS.osc]
      .concat(children(physics || {}).filter((c) => !['sim', 'body', 'group'].includes(widgets.label(c))))
      .concat(children(root).filter((c) => !['scene', 'physics', 'osc', 'transport'].includes(widgets.label(c))));
    const place = byId('parameters');
    place.replaceChildren();
    for (const node of top) {
      if (!node || children(node).length === 0) continue;
      const section = isObject(node) ? objectSection(node.FULL_PATH, titleOf(node) || widgets.sentenceCase(widgets.label(node)), fillProperties) : widgets.row(node);
      place.append(section.element);
      sections.push(section);
    }
  }

  // ---- behaviors: groups first, then those of single bodies

  let behaviors = [];

  function behavior(active, title, of) {
    const path = active.FULL_PATH.slice(0, active.FULL_PATH.lastIndexOf('/'));
    const part = objectSection(path, null, (node, contents) => {
      const withoutActive = Object.assign({}, node, { CONTENTS: Object.assign({}, node.CONTENTS) });
      delete withoutActive.CONTENTS.active;
      return fillProperties(withoutActive, contents);
    });
    const wrap = widgets.element('label', 'toggle');
    const input = widgets.element('input');
    input.type = 'checkbox';
    wrap.append(input, widgets.element('span', '', title));
    part.element.classList.add('behavior');
    part.summary.append(wrap);
    if (of) part.summary.append(widgets.element('span', 'of', of));
    wrap.addEventListener('click', (event) => event.stopPropagation());
    input.addEventListener('change', () => link.send(active.FULL_PATH, 'T', [input.checked]));
    input.checked = active.VALUE[0];
    const unlisten = link.listen(active.FULL_PATH, (values) => { input.checked = values[0]; });
    const close = part.free;
    part.free = () => { unlisten(); close(); };
    return part;
  }

  async function showBehaviors() {
    let found;
    try { found = await link.get('/', '?LIMBER_FIND=' + encodeURIComponent('/physics/ /active')); } catch (error) { return; }
    for (const b of behaviors) b.free();
    behaviors = [];
    const place = byId('behaviors');
    place.replaceChildren();
    const rows = found.FOUND.filter((r) => /^[/]physics[/](group[/][^/]+|body[/][^/]+[/]behavior[/][^/]+)[/]active$/.test(r.FULL_PATH));
    const groups = new Set();
    const show = (row, title, of) => {
      const part = behavior(row, title, of);
      place.append(part.element);
      behaviors.push(part);
    };
    const name = (row, at) => widgets.name(row.FULL_PATH.split('/').slice(0, at + 1).join('/'));
    for (const row of rows.filter((r) => r.FULL_PATH.startsWith('/physics/group/'))) {
      groups.add(name(row, 3));
      show(row, name(row, 3), 'Group');
    }
    for (const row of rows) {
      const of = row.FULL_PATH.startsWith('/physics/body/') && !groups.has(name(row, 5));
      if (of) show(row, name(row, 5), name(row, 3));
    }
    if (behaviors.length === 0) place.append(widgets.element('p', 'none', 'No behaviors'));
    if (found.MORE) place.append(widgets.element('p', 'none', 'There are more: search for "active"'));
  }

  // ---- search: the server searches all paths

  let foundRows = [];
  let searchVersion = 0;

  async function search() {
    const words = byId('search').value.trim();
    const ownVersion = ++searchVersion;
    const place = byId('found');
    let found = { FOUND: [], MORE: false };
    if (words) {
      try { found = await link.get('/', '?LIMBER_FIND=' + encodeURIComponent(words)); } catch (error) { return; }
    }
    if (ownVersion !== searchVersion) return;
    for (const r of foundRows.splice(0)) r.free();
    place.replaceChildren();
    place.hidden = !words;
    byId('parameters').hidden = Boolean(words);
    for (const node of found.FOUND) {
      const row = widgets.row(node, true);
      foundRows.push(row);
      place.append(row.element);
    }
    if (words && foundRows.length === 0) place.append(widgets.element('p', 'none', 'No results'));
    if (found.MORE) place.append(widgets.element('p', 'none', 'There are more results; add a word'));
  }

  // ---- messages

  let errors = 0;

  function message(level, text) {
    const list = byId('messages');
    const low = list.scrollTop + list.clientHeight >= list.scrollHeight - 4;
    list.append(widgets.element('li', level, text));
    while (list.children.length > 300) list.firstChild.remove();
    if (low) list.scrollTop = list.scrollHeight;
    if (level === 'error') errors++;
    byId('errors').hidden = errors === 0;
    byId('errors').textContent = errors === 1 ? '1 error' : errors + ' errors';
  }

  function clearMessages() {
    errors = 0;
    byId('messages').replaceChildren();
    byId('errors').hidden = true;
  }

  // ---- transport

  const PAUSE = 'M4 3h3v10H4zM9 3h3v10H9z';
  const PLAY = 'M4 3v10l9-5z';
  let paused = false;

  function showPaused(values) {
    paused = Boolean(values[0]);
    byId('play').setAttribute('aria-pressed', String(paused));
    byId('play').setAttribute('aria-label', paused ? 'Play' : 'Pause');
    byId('play-shape').setAttribute('d', paused ? PLAY : PAUSE);
  }
  function showTime([seconds]) {
    const rest = (seconds % 60).toFixed(2).padStart(5, '0');
    byId('time').textContent = Math.floor(seconds / 60) + ':' + rest;
  }
  // Returns a callback that lights a lamp for 400 ms when the counter changes.
  function lamp(id) {
    let last = null;
    let timer = 0;
    return ([count]) => {
      if (last !== null && count !== last) {
        byId(id).classList.add('lit');
        clearTimeout(timer);
        timer = setTimeout(() => byId(id).classList.remove('lit'), 400);
      }
      last = count;
    };
  }
  function press(action) { link.send('/transport/' + action, 'N', []); }

  // ---- panic, presets, takes

  function pressed(id, on) { byId(id).setAttribute('aria-pressed', String(Boolean(on))); }
  function showPanic([on]) {
    pressed('panic', on);
    byId('panic').textContent = on ? 'PANIC ON' : 'PANIC';
  }
  function showPresets([names]) {
    const list = byId('presets');
    list.replaceChildren(new Option('Preset', ''));
    for (const name of names.split('\n').filter(Boolean)) list.append(new Option(name, name));
    list.disabled = list.options.length === 1;
  }
  // state of the take: its name, whether it is being replayed, whether it plays instead of the live scene
  const take = { name: '', replays: false, plays: false };
  function showTake(key) {
    return ([value]) => {
      take[key] = value;
      byId('take').textContent = take.name;
      pressed('record', take.name && !take.replays);
      pressed('play-take', take.plays);
    };
  }

  // ---- added, removed and changed paths

  let refreshTimer = 0;
  const changedPaths = new Set();

  function refreshExpanded(parts) {
    for (const part of parts) {
      if (!part.refresh || !part.element.open) continue;
      const affected = [...changedPaths].some((p) => p.slice(0, p.lastIndexOf('/')) === part.path || p === part.path);
      if (affected) part.refresh(); else refreshExpanded(part.children());
    }
  }
  function onPathEvent(command, path) {
    changedPaths.add(path);
    clearTimeout(refreshTimer);
    refreshTimer = setTimeout(() => {
      const all = [...changedPaths];
      if (all.some((p) => p === '/' || p.split('/').length <= 3)) return load();
      refreshExpanded(sections);
      refreshExpanded(behaviors);
      if (all.some((p) => /[/](behavior|group|body)([/]|$)/.test(p))) showBehaviors();
      changedPaths.clear();
    }, 200);
  }

  async function load() {
    changedPaths.clear();
    try {
      showParameters(await link.get('/', '?LIMBER_DEPTH=3'));
      await showBehaviors();
      if (byId('search').value) search();
    } catch (error) {
      message('error', 'Reading the tree failed: ' + error.message);
    }
  }

  link.on.open = () => { clearMessages(); load(); };
  link.on.state = (text, kind) => {
    byId('link').textContent = text;
    byId('link').className = 'link ' + kind;
  };
  link.on.pathEvent = onPathEvent;
  link.on.log = (lines) => { for (const line of lines) message(line.LEVEL, line.TEXT); };
  link.on.error = (address, text) => message('error', address + ': ' + text);

  byId('play').addEventListener('click', () => press(paused ? 'play' : 'pause'));
  byId('step').addEventListener('click', () => press('step'));
  byId('reset').addEventListener('click', () => press('reset'));
  byId('clear').addEventListener('click', clearMessages);
  byId('panic').addEventListener('click', () => press('panic'));
  byId('presets').addEventListener('change', () => {
    const list = byId('presets');
    if (list.value) link.send('/preset/recall', 's', [list.value]);
    list.value = '';  // so that the same preset can be selected again
  });
  byId('record').addEventListener('click', () => link.send(take.name && !take.replays ? '/take/stop' : '/take/record', '', []));
  byId('play-take').addEventListener('click', () => link.send(take.plays ? '/take/stop' : '/take/play', '', []));
  let typing = 0;
  byId('search').addEventListener('input', () => { clearTimeout(typing); typing = setTimeout(search, 150); });
  document.addEventListener('keydown', (event) => {
    const free = document.activeElement === document.body || document.activeElement === null;
    if (event.key === ' ' && free) { event.preventDefault(); press(paused ? 'play' : 'pause'); }
    if (event.key === '/' && free) { event.preventDefault(); byId('search').focus(); }
  });

  link.listen('/physics/sim/paused', showPaused);
  link.listen('/physics/sim/time', showTime);
  link.listen('/physics/sim/tick', ([tick]) => { byId('tick').textContent = tick; });
  link.listen('/transport/speed_reached', ([speed]) => { byId('speed').textContent = speed.toFixed(2); });
  link.listen('/physics/sim/panicked', showPanic);
  link.listen('/preset/names', showPresets);
  link.listen('/take/name', showTake('name'));
  link.listen('/take/replays', showTake('replays'));
  link.listen('/take/plays', showTake('plays'));
  link.listen('/osc/received', lamp('in'));
  link.listen('/osc/sent', lamp('out'));
  link.connect();
})();
