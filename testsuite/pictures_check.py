# SPDX-License-Identifier: Apache-2.0
"""Checks the picture readers on files made here, byte by byte, from the format descriptions.

In: nothing. Out: exit status 0, or an assertion that names the format.
"""

import os
import struct
import tempfile
import zlib

import pictures


def read_bytes(data):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture")
        with open(path, "wb") as file:
            file.write(data)
        return pictures.read_picture(path)


def make_tiff(order, bits, form, samples, width, height, raw, compression=1):
    entries = [(256, 3, 1, width), (257, 3, 1, height), (258, 3, 1, bits), (259, 3, 1, compression),
               (277, 3, 1, samples), (278, 3, 1, height), (339, 3, 1, form)]
    entries += [(273, 4, 1, 8), (279, 4, 1, len(raw))]
    entries.sort()
    out = (b"II*\0" if order == "<" else b"MM\0*") + struct.pack(order + "I", 8 + len(raw)) + raw
    out += struct.pack(order + "H", len(entries))
    for tag, kind, count, value in entries:
        out += struct.pack(order + "HHI", tag, kind, count)
        out += struct.pack(order + ("HH" if kind == 3 else "I"), *((value, 0) if kind == 3 else (value,)))
    return out + b"\0\0\0\0"


def make_png(kind, lines, width, channels):
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
    header = struct.pack(">IIBBBBB", width, len(lines), 8, {3: 2, 4: 6, 1: 0}[channels], 0, 0, 0)
    body = zlib.compress(b"".join(bytes([kind]) + bytes(line) for line in lines))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def check_tiff():
    values = [0.5, -1.0, 3.25, 1e30, 0.0, 7.0]
    for order in "<>":
        raw = struct.pack(order + "6f", *values)
        for compression, packed in ((1, raw), (8, zlib.compress(raw))):
            picture = read_bytes(make_tiff(order, 32, 3, 3, 2, 1, packed, compression))
            expected = struct.unpack("<6f", struct.pack("<6f", *values))
            assert picture.at(0, 0) + picture.at(1, 0) == list(expected), "float TIFF"
    picture = read_bytes(make_tiff("<", 8, 1, 1, 3, 1, bytes([0, 51, 255])))
    assert [round(v, 6) for v in picture.rows[0]] == [0.0, 0.2, 1.0] and picture.levels == 255, "8-bit TIFF"
    assert pictures.unpack_bits(bytes([2, 1, 2, 3, 254, 9])) == bytes([1, 2, 3, 9, 9, 9]), "PackBits"
    # 256, 'A', 'B', 258 (= "AB"), 257 in 9-bit codes.
    bits = "".join(f"{code:09b}" for code in (256, 65, 66, 258, 257))
    packed = bytes(int(bits[i:i + 8].ljust(8, "0"), 2) for i in range(0, len(bits), 8))
    assert pictures.unpack_lzw(packed) == b"ABAB", "LZW"


def check_png():
    plain = [[10, 20, 30, 40, 50, 60], [11, 22, 33, 44, 55, 66]]
    differences = [[10, 20, 30, 30, 30, 30], [11, 22, 33, 33, 33, 33]]
    for kind, lines in ((0, plain), (1, differences)):
        picture = read_bytes(make_png(kind, lines, 2, 3))
        assert [round(v * 255) for v in picture.rows[1]] == plain[1], f"PNG filter {kind}"
    picture = read_bytes(make_png(2, [plain[0], [1, 2, 3, 4, 5, 6]], 2, 3))
    assert [round(v * 255) for v in picture.rows[1]] == [11, 22, 33, 44, 55, 66], "PNG filter 2"


def make_exr(compression):
    def attribute(name, kind, body):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(body)) + body
    channels = b"".join(name + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in (b"B", b"G", b"R"))
    window = struct.pack("<4i", 0, 0, 1, 0)
    header = b"\x76\x2f\x31\x01" + struct.pack("<I", 2)
    header += attribute(b"channels", b"chlist", channels + b"\0")
    header += attribute(b"compression", b"compression", bytes([compression]))
    header += attribute(b"dataWindow", b"box2i", window) + b"\0"
    raw = struct.pack("<6f", 3, 6, 2, 5, 1, 4)  # planes B G R of two pixels
    if compression:
        halves = raw[0::2] + raw[1::2]
        coded = bytes([halves[0]] + [(b - a + 128) & 255 for a, b in zip(halves, halves[1:])])
        packed = zlib.compress(coded)
        raw = packed if len(packed) < len(raw) else raw
    start = len(header) + 8
    return header + struct.pack("<Q", start) + struct.pack("<iI", 0, len(raw)) + raw


def check_exr():
    for compression in (0, 3):
        picture = read_bytes(make_exr(compression))
        assert picture.channels == ["r", "g", "b"], "EXR channel order"
        assert picture.at(0, 0) == [1, 2, 3] and picture.at(1, 0) == [4, 5, 6], "EXR values"


if __name__ == "__main__":
    check_tiff()
    check_png()
    check_exr()
