// Reads the tree with npm's oscquery; listens and sets values with npm's ws and osc.
import { spawn } from 'node:child_process';
import { createSocket } from 'node:dgram';
import { writeFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import oscquery from 'oscquery';
import WebSocket from 'ws';
import osc from 'osc';

const SCENE = `
params { { "wind", 2, min = 0, max = 10 }, { "style", "calm", choices = { "calm", "wild" } }, { "where", vec3(0, 0, 1) } }
local shape = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("arm")
body:add_part("base", shape, { mass = 0 })
osc:on("/more", function() body:copy("two") end)
osc:on("/less", function() sim:body("two"):remove() end)
`;
writeFileSync('s.lua', SCENE);
const limber = spawn(process.argv[2], ['s.lua', '--osc-in', '127.0.0.1:0', '--osc-out', 'off'], { stdio: ['ignore', 'ignore', 'pipe'] });
process.on('exit', () => limber.kill());

let passed = 0;
function must(condition, name) {
  if (!condition) { console.log('FAILED: ' + name); process.exit(1); }
  console.log('ok: ' + name);
  passed++;
}

let oscPort = 0;
let port = 0;
for await (const line of createInterface({ input: limber.stderr })) {
  oscPort ||= Number(line.match(/OSC in 127.0.0.1:(\d+)/)?.[1] || 0);
  port ||= Number(line.match(/remote panel http:\/\/127.0.0.1:(\d+)/)?.[1] || 0);
  if (line.includes('playing headless')) break;
}
must(oscPort && port, 'Limber is running');

const discovery = new oscquery.OSCQueryDiscovery();
const service = await discovery.queryNewService('127.0.0.1', port);
must(service.hostInfo.name.startsWith('Limber') && service.hostInfo.oscPort === oscPort, 'HOST_INFO is valid');
const methods = service.flat();
must(methods.length > 40, `${methods.length} nodes are read`);
must(service.resolvePath('/scene/wind').getValue(0) === 2, 'a value');
const method = (path) => methods.find((m) => m.full_path === path);
const wind = method('/scene/wind');
must(wind.arguments[0].range.min === 0 && wind.arguments[0].range.max === 10, 'a range');
must(wind.access === oscquery.OSCQAccess.READWRITE, 'access');
must(method('/scene/where').arguments.length === 3, 'three numbers');
must(JSON.stringify(method('/scene/style').arguments[0].range.vals) === '["calm","wild"]', 'choices');

const received = [];
const pathEvents = [];
let wake = () => {};
const socket = new WebSocket(`ws://127.0.0.1:${port}/`);
await new Promise((open) => socket.on('open', open));
socket.on('message', (data, binary) => {
  if (binary) received.push(osc.readPacket(data, { metadata: true })); else pathEvents.push(JSON.parse(data.toString()));
  wake();
});
async function until(condition, name) {
  const timeout = setTimeout(() => must(false, name), 30000);
  while (!condition()) await new Promise((resolve) => { wake = resolve; });
  clearTimeout(timeout);
  must(true, name);
}
socket.send(JSON.stringify({ COMMAND: 'LISTEN', DATA: '/scene/wind' }));
await until(() => received.some((m) => m.address === '/scene/wind' && m.args[0].value === 2), 'LISTEN gives the value');
const udp = createSocket('udp4');
const packet = (address, ...args) => Buffer.from(osc.writePacket({ address, args }, { metadata: true }));
udp.send(packet('/scene/wind', { type: 'i', value: 5 }), oscPort, '127.0.0.1');
await until(() => received.some((m) => m.args[0]?.value === 5), 'a change by UDP is received');
received.length = 0;
socket.send(packet('/scene/wind', { type: 'f', value: 7.5 }));
// messages by UDP and WebSocket have no defined order
async function hasValue(value) {
  for (let tries = 0; tries < 1000; tries++) {
    if ((await (await fetch(`http://127.0.0.1:${port}/scene/wind?VALUE`)).json()).VALUE[0] === value) return true;
  }
  return false;
}
must(await hasValue(7.5), 'set by the WebSocket');
udp.send(packet('/scene/wind', { type: 'f', value: 8 }), oscPort, '127.0.0.1');
await until(() => received.some((m) => m.args[0]?.value === 8), 'the next change is received');
must(!received.some((m) => m.args[0]?.value === 7.5), 'no echo of its own change');
await service.update();
must(service.resolvePath('/scene/wind').getValue(0) === 8, 'the tree has the same value');
socket.send(packet('/more'));
await until(() => pathEvents.some((n) => n.COMMAND === 'PATH_ADDED' && n.DATA === '/physics/body/two'), 'PATH_ADDED');
socket.send(packet('/less'));
await until(() => pathEvents.some((n) => n.COMMAND === 'PATH_REMOVED' && n.DATA === '/physics/body/two'), 'PATH_REMOVED');
console.log(`${passed} passed`);
process.exit(0);
