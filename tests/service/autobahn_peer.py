"""A peer nobody here wrote: Autobahn's WebSocket stack talks to limnd, frame by frame.

  autobahn_peer.py LIMND SCENE

Autobahn itself fails a connection whose server breaks RFC 6455; on top of that each case below has an expected end.
"""

import asyncio
import json
import re
import struct
import subprocess
import sys
import zlib

from autobahn.asyncio.websocket import WebSocketClientFactory, WebSocketClientProtocol

PATIENCE = 60.0  # seconds; a case that takes longer fails
FRAME_HEADER_BYTES = 116
HELLO = json.dumps({"op": "hello", "seq": 1, "version": 1, "client": "autobahn", "watch": False}).encode()
PING = b'{"op":"ping","seq":%d}'


class Peer(WebSocketClientProtocol):
    """Queues what arrives; the case under test reads the queue."""

    open = []  # closed after each case

    def onOpen(self):
        self.inbox = asyncio.Queue()
        Peer.open.append(self)
        self.factory.opened.set_result(self)

    def onMessage(self, payload, isBinary):
        self.inbox.put_nowait(("binary" if isBinary else "text", payload))

    def onPong(self, payload):
        self.inbox.put_nowait(("pong", payload))

    def onClose(self, wasClean, code, reason):
        if hasattr(self, "inbox"):
            self.inbox.put_nowait(("close", self.remoteCloseCode))
        elif not self.factory.opened.done():
            self.factory.opened.set_exception(ConnectionError(reason))

    async def next(self, kind, wanted=lambda payload: True):
        while True:
            got, payload = await asyncio.wait_for(self.inbox.get(), PATIENCE)
            if got == kind and wanted(payload):
                return payload
            if got == "close":
                raise AssertionError(f"closed with {payload} while waiting for {kind}")

    async def next_op(self, op):
        return json.loads(await self.next("text", lambda text: json.loads(text)["op"] == op))


async def connect(port):
    loop = asyncio.get_running_loop()
    factory = WebSocketClientFactory(f"ws://127.0.0.1:{port}/ws", protocols=["limn.v1"])
    factory.protocol = Peer
    factory.opened = loop.create_future()
    await loop.create_connection(factory, "127.0.0.1", port)
    return await asyncio.wait_for(factory.opened, PATIENCE)


async def greeted(port, watch=False):
    peer = await connect(port)
    peer.sendMessage(HELLO.replace(b"false", b"true") if watch else HELLO)
    await peer.next_op("hello")
    return peer


def rows_of_png(data):
    """Undoes filters none and sub of an 8-bit RGB PNG without help of any library that wrote it."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
            assert (depth, colour) == (8, 2)
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw = zlib.decompress(packed)
    assert len(raw) == height * (1 + 3 * width)
    return width, height


async def a_picture_converges(port):
    peer = await greeted(port, watch=True)
    edit = {"op": "set", "seq": 2, "target": "technique", "parameters": {"maxSamples": 4}}
    peer.sendMessage(json.dumps(edit).encode())
    assert (await peer.next_op("ack"))["seq"] == 2
    seq = 2
    while True:
        frame = await peer.next("binary")
        magic, version, kind, encoding, flags = struct.unpack("<4sBBBB", frame[:8])
        assert (magic, version, kind) == (b"LMN1", 1, 0)
        frame_id, ack_seq = struct.unpack("<II", frame[12:20])
        seq += 1
        peer.sendMessage(json.dumps({"op": "ackFrame", "seq": seq, "frameId": frame_id, "dropped": False}).encode())
        if flags & 4 and ack_seq == 2:
            assert encoding == 1 and flags & 2
            assert rows_of_png(frame[FRAME_HEADER_BYTES:]) == (64, 64)
            return


async def text_in_fragments_with_a_ping_between(port):
    peer = await greeted(port)
    text = PING % 2
    peer.sendFrame(opcode=1, payload=text[:5], fin=False)
    peer.sendFrame(opcode=9, payload=b"x" * 125)
    peer.sendFrame(opcode=0, payload=text[5:], fin=True)
    assert await peer.next("pong") == b"x" * 125
    assert (await peer.next_op("pong"))["seq"] == 2


async def bytes_one_at_a_time(port):
    peer = await greeted(port)
    peer.sendFrame(opcode=1, payload=PING % 2, chopsize=1, sync=True)
    assert (await peer.next_op("pong"))["seq"] == 2


def ends_with(code, *frames):
    """The server answers these frames by closing with the code; None: it may also just cut the connection."""
    async def case(port):
        peer = await greeted(port)
        for frame in frames:
            peer.sendFrame(**frame)
        while True:
            got, payload = await asyncio.wait_for(peer.inbox.get(), PATIENCE)
            if got == "close":
                assert code is None or payload == code, f"closed with {payload}"
                return
    return case


CASES = {
    "a picture converges and is lossless": a_picture_converges,
    "text in fragments with a ping between": text_in_fragments_with_a_ping_between,
    "bytes one at a time": bytes_one_at_a_time,
    "close is echoed": ends_with(1000, {"opcode": 8, "payload": struct.pack(">H", 1000)}),
    "close with a reason": ends_with(1000, {"opcode": 8, "payload": struct.pack(">H", 1000) + b"bye"}),
    "close without a code": ends_with(None, {"opcode": 8, "payload": b""}),
    "close with a code nobody may send": ends_with(None, {"opcode": 8, "payload": struct.pack(">H", 1005)}),
    "close with one byte": ends_with(None, {"opcode": 8, "payload": b"\x03"}),
    "ping of 126 bytes": ends_with(None, {"opcode": 9, "payload": b"x" * 126}),
    "fragmented ping": ends_with(None, {"opcode": 9, "payload": b"x", "fin": False}),
    "reserved bit": ends_with(None, {"opcode": 1, "payload": b"{}", "rsv": 4}),
    "reserved opcode": ends_with(None, {"opcode": 3, "payload": b""}),
    "reserved control opcode": ends_with(None, {"opcode": 11, "payload": b""}),
    "continuation of nothing": ends_with(None, {"opcode": 0, "payload": b"x"}),
    "text inside of a fragmented text": ends_with(None, {"opcode": 1, "payload": b"{", "fin": False},
                                                  {"opcode": 1, "payload": b"}"}),
    "not UTF-8": ends_with(1007, {"opcode": 1, "payload": b"\xce\xba\xe1\xbd\xb9\xcf\x83\xce\xbc\xce\xb5\xed\xa0\x80"}),
    "not UTF-8 across fragments": ends_with(1007, {"opcode": 1, "payload": b"\xce", "fin": False},
                                            {"opcode": 0, "payload": b"\xce"}),
    "binary": ends_with(1003, {"opcode": 2, "payload": b"abc"}),
}


async def server_lives(port):
    peer = await greeted(port)
    await peer.next_op("scene")


async def run_all(port):
    failed = 0
    for name, case in CASES.items():
        try:
            await case(port)
            print("ok    ", name)
        except Exception as error:  # each case is told, whatever went wrong with it
            failed += 1
            print("FAILED", name, repr(error))
        await server_lives(port)
        while Peer.open:
            Peer.open.pop().sendClose(1000)
    return failed


def main():
    limnd, scene = sys.argv[1:3]
    command = [limnd, "--scene", scene, "--listen", "127.0.0.1:0", "--size", "64x64"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            port = int(re.match(r"listening on http://127\.0\.0\.1:(\d+)/", process.stdout.readline()).group(1))
            failed = asyncio.run(run_all(port))
        finally:
            process.terminate()
    print(f"{len(CASES) - failed} of {len(CASES)} cases")
    return 1 if failed or process.returncode != 0 else 0


if __name__ == "__main__":
    sys.exit(main())
