// The way to Limber: the tree by HTTP, values both ways by WebSocket; when it is lost it is looked for again.
'use strict';

const link = (() => {
  const hearers = new Map();  // path -> set of functions that take a value's arguments
  let socket = null;
  let wait = 250;  // ms until the next try

  const on = {
    open() {},          // connected, for the first time or again
    state(text, kind) {},
    notice(command, path) {},
    log(lines) {},
    error(address, text) {},
  };

  function say(command, data) {
    if (socket && socket.readyState === 1) socket.send(JSON.stringify({ COMMAND: command, DATA: data }));
  }

  function listen(path, hear) {
    let set = hearers.get(path);
    if (!set) {
      hearers.set(path, set = new Set());
      say('LISTEN', path);
    }
    set.add(hear);
    return () => {
      if (!set.delete(hear) || set.size > 0 || hearers.get(path) !== set) return;
      hearers.delete(path);
      say('IGNORE', path);
    };
  }

  function send(path, tags, args) {
    if (socket && socket.readyState === 1) socket.send(osc.encode(path, tags, args));
  }

  async function get(path, query) {
    const address = path.split('/').map(encodeURIComponent).join('/');
    const reply = await fetch(address + (query || ''), { headers: { Accept: 'application/json' } });
    if (!reply.ok) throw new Error(reply.status + ' ' + (await reply.text()).trim());
    return reply.json();
  }

  function take(event) {
    if (typeof event.data !== 'string') {
      const message = osc.decode(event.data);
      if (!message) return;
      if (message.address === '/error') on.error(message.args[0], message.args[1]);
      const set = hearers.get(message.address);
      if (set) for (const hear of [...set]) hear(message.args);
      return;
    }
    const frame = JSON.parse(event.data);
    if (frame.COMMAND === 'LIMBER_LOG') on.log(frame.DATA);
    if (/^PATH_/.test(frame.COMMAND)) on.notice(frame.COMMAND, frame.DATA);
  }

  function connect() {
    const mine = new WebSocket('ws://' + location.host + '/');
    mine.binaryType = 'arraybuffer';
    socket = mine;
    mine.onopen = () => {
      wait = 250;
      on.state('connected', 'open');
      say('LIMBER_LOG', true);
      for (const path of hearers.keys()) say('LISTEN', path);
      on.open();
    };
    mine.onmessage = take;
    mine.onclose = () => {
      if (socket !== mine) return;
      on.state('not connected', 'lost');
      setTimeout(connect, wait);
      wait = Math.min(2 * wait, 4000);
    };
  }

  return { on, connect, listen, send, get };
})();
