// Encodes and decodes the OSC packets sent over the WebSocket.
'use strict';

const osc = (() => {
  const decoder = new TextDecoder();
  const encoder = new TextEncoder();

  function padded(text) {
    const bytes = encoder.encode(text);
    const out = new Uint8Array((Math.floor(bytes.length / 4) + 1) * 4);
    out.set(bytes);
    return out;
  }

  function bytes4(write) {
    const out = new Uint8Array(4);
    write(new DataView(out.buffer));
    return out;
  }

  // Encodes a message with the type tags of the tree's TYPE. T takes a boolean and N no argument.
  function encode(address, tags, args) {
    let written = '';
    const pieces = [];
    let at = 0;
    for (const tag of tags) {
      if (tag === '[' || tag === ']') {
        written += tag;
      } else if (tag === 'N') {
        written += tag;
      } else {
        const value = args[at++];
        if (tag === 'T') written += value ? 'T' : 'F';
        if (tag === 's') { written += 's'; pieces.push(padded(String(value))); }
        if (tag === 'i') { written += 'i'; pieces.push(bytes4((v) => v.setInt32(0, Math.round(value)))); }
        if (tag === 'f') { written += 'f'; pieces.push(bytes4((v) => v.setFloat32(0, value))); }
        if (tag === 'h') {
          written += 'h';
          const out = new Uint8Array(8);
          new DataView(out.buffer).setBigInt64(0, BigInt(Math.round(value)));
          pieces.push(out);
        }
      }
    }
    pieces.unshift(padded(address), padded(',' + written));
    const packet = new Uint8Array(pieces.reduce((n, p) => n + p.length, 0));
    let to = 0;
    for (const piece of pieces) { packet.set(piece, to); to += piece.length; }
    return packet;
  }

  // Decodes a packet to {address, args}; returns null if it is malformed.
  function decode(buffer) {
    const bytes = new Uint8Array(buffer);
    const view = new DataView(buffer);
    let at = 0;
    function text() {
      let end = at;
      while (end < bytes.length && bytes[end] !== 0) end++;
      const out = decoder.decode(bytes.subarray(at, end));
      at = (Math.floor(end / 4) + 1) * 4;
      return out;
    }
    try {
      const address = text();
      const args = [];
      for (const tag of text().slice(1)) {
        if (tag === 'T' || tag === 'F') args.push(tag === 'T');
        if (tag === 's') args.push(text());
        if (tag === 'i') { args.push(view.getInt32(at)); at += 4; }
        if (tag === 'f') { args.push(Number(view.getFloat32(at).toPrecision(7))); at += 4; }
        if (tag === 'h') { args.push(Number(view.getBigInt64(at))); at += 8; }
      }
      return { address, args };
    } catch (error) {
      return null;
    }
  }

  return { encode, decode };
})();
