// Connection to Limber: the tree by HTTP, values in both directions by WebSocket. Reconnects automatically.
'use strict';

const link = (() => {
  const listeners = new Map();  // path -> set of callbacks that get a value's arguments
  let socket = null;
  let retryDelay = 250;  // delay of the next reconnection attempt, ms

  const on = {
    open() {},  // connected or reconnected
    state(text, kind) {},
    pathEvent(command, path) {},
    log(lines) {},
    error(address, text) {},
  };

  function sendCommand(command, data) {
    if (socket && socket.readyState === 1) socket.send(JSON.stringify({ COMMAND: command, DATA: data }));
  }

  function listen(path, callback) {
    let set = listeners.get(path);
    if (!set) {
      listeners.set(path, set = new Set());
      sendCommand('LISTEN', path);
    }
    set.add(callback);
    return () => {
      if (!set.delete(callback) || set.size > 0 || listeners.get(path) !== set) return;
      listeners.delete(path);
      sendCommand('IGNORE', path);
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

  function receive(event) {
    if (typeof event.data !== 'string') {
      const message = osc.decode(event.data);
      if (!message) return;
      if (message.address === '/error') on.error(message.args[0], message.args[1]);
      const set = listeners.get(message.address);
      if (set) for (const callback of [...set]) callback(message.args);
      return;
    }
    const frame = JSON.parse(event.data);
    if (frame.COMMAND === 'LIMBER_LOG') on.log(frame.DATA);
    if (/^PATH_/.test(frame.COMMAND)) on.pathEvent(frame.COMMAND, frame.DATA);
  }

  function connect() {
    const newSocket = new WebSocket('ws://' + location.host + '/');
    newSocket.binaryType = 'arraybuffer';
    socket = newSocket;
    newSocket.onopen = () => {
      retryDelay = 250;
      on.state('Connected', 'open');
      sendCommand('LIMBER_LOG', true);
      for (const path of listeners.keys()) sendCommand('LISTEN', path);
      on.open();
    };
    newSocket.onmessage = receive;
    newSocket.onclose = () => {
      if (socket !== newSocket) return;
      on.state('Not connected', 'lost');
      setTimeout(connect, retryDelay);
      retryDelay = Math.min(2 * retryDelay, 4000);
    };
  }

  return { on, connect, listen, send, get };
})();
