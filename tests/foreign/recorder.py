"""A proxy that records the traffic as a capture for Wireshark. It needs no special rights: it writes the TCP packets itself.

In the capture the server has port 102, so that every dissector knows what it sees.
"""

import socket
import struct
import threading
import time

CLIENT, SERVER = b"\x7f\x00\x00\x02", b"\x7f\x00\x00\x01"
FIN, SYN, PSH, ACK = 1, 2, 8, 16


def checksum(header):
    total = sum(struct.unpack(f">{len(header) // 2}H", header))
    total = (total >> 16) + (total & 0xFFFF)
    return ~(total + (total >> 16)) & 0xFFFF


class Recorder:
    """Listens on a free port, and forwards everything to another port."""

    def __init__(self, server_port, path):
        self.server_port = server_port
        self.lock = threading.Lock()
        self.file = open(path, "wb")
        # Raw IP packets, in microseconds.
        self.file.write(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 0x40000, 101))
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            try:
                client, address = self.listener.accept()
            except OSError:
                return
            server = socket.create_connection(("127.0.0.1", self.server_port))
            for end in (client, server):
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            Connection(self, client, server, address[1])

    def packet(self, source, port_from, port_to, sequence, acknowledged, flags, payload=b""):
        target = SERVER if source == CLIENT else CLIENT
        tcp = struct.pack(">HHIIBBHHH", port_from, port_to, sequence, acknowledged, 0x50, flags, 65535, 0, 0) + payload
        ip = struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(tcp), 0, 0x4000, 64, 6, 0) + source + target
        ip = ip[:10] + struct.pack(">H", checksum(ip)) + ip[12:]
        now = time.time_ns() // 1000
        data = ip + tcp
        self.file.write(struct.pack("<IIII", now // 1000000, now % 1000000, len(data), len(data)) + data)

    def close(self):
        self.listener.close()
        with self.lock:
            self.file.close()


class Connection:
    """One client: each direction has a thread; both record through one lock, so that the order is correct."""

    def __init__(self, recorder, client, server, port):
        self.recorder = recorder
        self.port = port
        # The next sequence numbers of the client and of the server.
        self.next = {CLIENT: 1000, SERVER: 2000}
        with recorder.lock:
            self.record(CLIENT, SYN)
            self.record(SERVER, SYN | ACK)
            self.record(CLIENT, ACK)
        for source, here, there in ((CLIENT, client, server), (SERVER, server, client)):
            threading.Thread(target=self.pass_on, args=(source, here, there), daemon=True).start()

    def record(self, source, flags, payload=b""):
        other = SERVER if source == CLIENT else CLIENT
        ports = (self.port, 102) if source == CLIENT else (102, self.port)
        acknowledged = self.next[other] if flags & ACK else 0
        if not self.recorder.file.closed:
            self.recorder.packet(source, *ports, self.next[source], acknowledged, flags, payload)
        self.next[source] += len(payload) + (1 if flags & (SYN | FIN) else 0)

    def pass_on(self, source, here, there):
        while True:
            try:
                data = here.recv(65536)
            except OSError:
                data = b""
            with self.recorder.lock:
                for start in range(0, len(data), 1400):
                    self.record(source, PSH | ACK, data[start : start + 1400])
                if not data:
                    self.record(source, FIN | ACK)
            try:
                if not data:
                    there.shutdown(socket.SHUT_WR)
                    return
                there.sendall(data)
            except OSError:
                return
