"""A minimal OSC and WebSocket client for these rows."""
import base64
import os
import socket
import struct


def padded(data):
    return data + b"\0" * (4 - len(data) % 4)


def message(address, *arguments):
    tags, body = ",", b""
    for value in arguments:
        if isinstance(value, float):
            tags, body = tags + "f", body + struct.pack(">f", value)
        elif isinstance(value, int):
            tags, body = tags + "i", body + struct.pack(">i", value)
        else:
            tags, body = tags + "s", body + padded(value.encode())
    return padded(address.encode()) + padded(tags.encode()) + body


def bundle(messages):
    return b"#bundle\0" + struct.pack(">Q", 1) + b"".join(struct.pack(">I", len(m)) + m for m in messages)


def decoded(data):
    """Returns (address, arguments) of a message, or of the first message of a bundle."""
    while data.startswith(b"#bundle"):
        data = data[20:]

    def text(at):
        end = data.index(b"\0", at)
        return data[at:end].decode(errors="replace"), at + (end - at) // 4 * 4 + 4
    address, at = text(0)
    tags, at = text(at)
    values = []
    for tag in tags[1:]:
        if tag in "if":
            values.append(struct.unpack_from(">" + tag, data, at)[0])
            at += 4
        elif tag in "hd":
            values.append(struct.unpack_from(">" + ("q" if tag == "h" else "d"), data, at)[0])
            at += 8
        elif tag in "sS":
            value, at = text(at)
            values.append(value)
        else:
            values.append(tag == "T")
    return address, values


class Client:
    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.connect(("127.0.0.1", port))

    def send(self, address, *arguments):
        self.raw(message(address, *arguments))

    def raw(self, data):
        try:
            self.socket.send(data)
        except ConnectionRefusedError:
            pass

    def ask(self, address, *arguments, tries=200):
        """Sends the message repeatedly until a reply arrives."""
        for _ in range(tries):
            self.send(address, *arguments)
            self.socket.settimeout(0.3)
            try:
                return decoded(self.socket.recv(65536))
            except (TimeoutError, ConnectionRefusedError):
                continue
        return None

    def ping(self):
        self.drain()
        answer = self.ask("/ping", 1)
        return answer is not None

    def drain(self):
        self.socket.setblocking(False)
        try:
            while True:
                self.socket.recv(65536)
        except OSError:
            pass


class WebSocket:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=30)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        answer = b""
        while b"\r\n\r\n" not in answer:
            got = self.socket.recv(4096)
            if not got:
                break
            answer += got
        self.open = answer.startswith(b"HTTP/1.1 101")

    def send(self, data, kind=2):
        """Sends one masked frame; kind 2: OSC, 1: text."""
        length = len(data)
        head = bytes([0x80 | kind])
        head += bytes([0x80 | length]) if length < 126 else bytes([0x80 | 126]) + struct.pack(">H", length)
        mask = os.urandom(4)
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def close(self):
        self.socket.close()
