"""Occupies the ports 9000 to 9010 until its input ends, so that a test that opens a default port fails."""
import socket
import sys

held = []
for family, address in ((socket.AF_INET, "0.0.0.0"), (socket.AF_INET6, "::")):
    for kind in (socket.SOCK_DGRAM, socket.SOCK_STREAM):
        for port in range(9000, 9011):
            try:
                taken = socket.socket(family, kind)
                if family == socket.AF_INET6:
                    taken.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
                taken.bind((address, port))
                if kind == socket.SOCK_STREAM:
                    taken.listen(1)
                held.append(taken)
            except OSError:
                pass  # used by another program, or no IPv6
sys.stdin.read()
