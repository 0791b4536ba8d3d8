// Controls score.lua and receives its streams with one of npm's OSC libraries: node score.mjs osc|node-osc|osc-js IN OUT
const [library, into, out] = [process.argv[2], Number(process.argv[3]), Number(process.argv[4])];
const host = '127.0.0.1';

let printed = '';
function receive(address, args) {
  const line = address === '/physics/joint/pos' ? `pos ${args.join(' ')}` : address === '/score' ? `score ${args[0]}` : '';
  if (line && !printed.includes(line)) { printed += line; console.log(line); }
}

// each library chooses its own type tags for integers, fractions, booleans and texts
const SCORE = [
  ['/physics/sim/gravity', -3],
  ['/physics/part/friction', 'arm', 'tip', 0.75],
  ['/physics/body/*/part/tip/restitution', 0.25],
  ['/physics/body/arm/motor/elbow/target', 0.5],
  ['/physics/behavior/parameter', 'arm', 'push', 'active', false],
  ['/scene/style', 'wild'],
  ['/scene/lively', true],
];
const TOGETHER = [['/scene/wind', 4.5], ['/scene/where', 1, 2, 3]];

async function withOsc() {
  const { default: osc } = await import('osc');
  const port = new osc.UDPPort({ localAddress: host, localPort: out, remoteAddress: host, remotePort: into });
  port.on('message', (m) => receive(m.address, m.args));
  port.on('ready', () => {
    const message = ([address, ...args]) => ({
      address,
      args: args.map((v) => (typeof v === 'boolean' ? { type: v ? 'T' : 'F', value: v } : v)),
    });
    SCORE.forEach((m) => port.send(message(m)));
    port.send({ timeTag: osc.timeTag(0.05), packets: TOGETHER.map(message) });
    setTimeout(() => port.send(message(['/done'])), 200);
  });
  port.open();
}

async function withNodeOsc() {
  const { Client, Server, Bundle } = await import('node-osc');
  const client = new Client(host, into);
  const server = new Server(out, host, async () => {
    for (const m of SCORE) await new Promise((sent) => { client.send(m, sent); });
    await new Promise((sent) => { client.send(new Bundle(...TOGETHER), sent); });
    client.send(['/done'], () => {});
  });
  server.on('message', ([address, ...args]) => receive(address, args));
}

async function withOscJs() {
  const { default: OSC } = await import('osc-js');
  const osc = new OSC({ plugin: new OSC.DatagramPlugin({ open: { host, port: out }, send: { host, port: into } }) });
  osc.on('/physics/joint/pos', (m) => receive(m.address, m.args));
  osc.on('/score', (m) => receive(m.address, m.args));
  osc.on('open', () => {
    SCORE.forEach((m) => osc.send(new OSC.Message(...m)));
    osc.send(new OSC.Bundle(TOGETHER.map((m) => new OSC.Message(...m)), Date.now() + 50));
    setTimeout(() => osc.send(new OSC.Message('/done')), 200);
  });
  osc.open();
}

await { osc: withOsc, 'node-osc': withNodeOsc, 'osc-js': withOscJs }[library]();
