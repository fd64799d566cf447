# SPDX-License-Identifier: Apache-2.0
"""Reads the pictures that Perigee writes, with nothing but the Python standard library.

In: a TIFF, PNG, OpenEXR, zfile or PPM file. Out: a Picture, values as floats, row 0 at the top. Integer formats are
scaled to 0..1 (255 or 65535 is 1); the raw integers are in Picture.levels. The readers share no code with the
writers, so a wrong file cannot look right. Sources: TIFF 6.0; PNG (ISO 15948); OpenEXR file layout.
"""

import struct
import zlib


class PictureError(Exception):
    """The file is missing, damaged, or uses a feature the readers do not know."""


class Picture:
    """width x height pixels of named channels; `rows[y][x * n + c]` is one value."""

    def __init__(self, width, height, channels, rows, levels=None):
        self.width = width
        self.height = height
        self.channels = channels
        self.rows = rows
        self.levels = levels  # 255 or 65535 for integer files, None for float
        self.tags = {}
        self.parts = []  # OpenEXR: names of the parts
        self.kinds = {}  # OpenEXR: "e" half, "f" float, by the name of the channel in the file

    def layer(self, name):
        """The channels whose names are `name` or begin with `name.`, as a picture: R G B, X Y Z W, numbers in order."""
        def place(i):
            return [int(part) if part.isdigit() else "RGBXYZWST".find(part)
                    for part in self.channels[i][len(name) + 1:].split(".")]
        chosen = sorted((i for i, c in enumerate(self.channels) if c == name or c.startswith(name + ".")), key=place)
        if not chosen:
            raise PictureError(f"no channel {name} among {', '.join(self.channels)}")
        n = len(self.channels)
        rows = [[row[x * n + c] for x in range(self.width) for c in chosen] for row in self.rows]
        return Picture(self.width, self.height, [self.channels[c] for c in chosen], rows, self.levels)

    def at(self, x, y):
        n = len(self.channels)
        if not (0 <= x < self.width and 0 <= y < self.height):
            raise PictureError(f"pixel ({x}, {y}) lies outside {self.width}x{self.height}")
        return self.rows[y][x * n:(x + 1) * n]


def read_picture(path):
    """Reads by content, not by suffix."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise PictureError(f"cannot read {path}: {error.strerror}") from error
    try:
        if data[:8] == b"\x89PNG\r\n\x1a\n":
            return read_png(data)
        if data[:4] in (b"II*\0", b"MM\0*"):
            return read_tiff(data)
        if data[:4] == b"\x76\x2f\x31\x01":
            return read_exr(data)
        if data[:4] == struct.pack("<I", 0x2F0867AB):
            return read_zfile(data)
        if data[:2] in (b"P5", b"P6"):
            return read_map(data)
    except (struct.error, IndexError, zlib.error) as error:
        raise PictureError(f"{path} is damaged: {error}") from error
    raise PictureError(f"{path} is neither TIFF, PNG, OpenEXR, zfile nor a portable map")


# --- PNG ------------------------------------------------------------------------------------------

PNG_CHANNELS = {0: ["y"], 2: ["r", "g", "b"], 4: ["y", "a"], 6: ["r", "g", "b", "a"]}


def read_png(data):
    header, packed, offset = None, b"", 8
    while offset < len(data):
        length, kind = struct.unpack_from(">I4s", data, offset)
        body = data[offset + 8:offset + 8 + length]
        (crc,) = struct.unpack_from(">I", data, offset + 8 + length)
        if crc != zlib.crc32(kind + body):
            raise PictureError("PNG: wrong checksum")
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        offset += 12 + length
    width, height, bits, color, _, _, interlace = header
    if bits not in (8, 16) or color not in PNG_CHANNELS or interlace:
        raise PictureError(f"PNG: {bits} bits, colour type {color}, interlace {interlace} are not read")
    channels = PNG_CHANNELS[color]
    pixel_bytes = len(channels) * bits // 8
    lines = png_unfilter(zlib.decompress(packed), width * pixel_bytes, height, pixel_bytes)
    scale = 1.0 / (2 ** bits - 1)
    code = ">%d%s" % (width * len(channels), "B" if bits == 8 else "H")
    rows = [[value * scale for value in struct.unpack(code, line)] for line in lines]
    return Picture(width, height, channels, rows, 2 ** bits - 1)


def png_unfilter(data, row_bytes, height, pixel_bytes):
    """Undoes the five row filters (ISO 15948, 9.2)."""
    lines, above, offset = [], bytearray(row_bytes), 0
    for _ in range(height):
        kind, line = data[offset], bytearray(data[offset + 1:offset + 1 + row_bytes])
        offset += 1 + row_bytes
        for i in range(row_bytes) if kind else ():
            left = line[i - pixel_bytes] if i >= pixel_bytes else 0
            corner = above[i - pixel_bytes] if i >= pixel_bytes else 0
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = above[i]
            elif kind == 3:
                guess = (left + above[i]) // 2
            else:
                guess = paeth(left, above[i], corner)
            line[i] = (line[i] + guess) & 255
        lines.append(bytes(line))
        above = line
    return lines


def paeth(left, up, corner):
    estimate = left + up - corner
    by_left, by_up, by_corner = abs(estimate - left), abs(estimate - up), abs(estimate - corner)
    if by_left <= by_up and by_left <= by_corner:
        return left
    return up if by_up <= by_corner else corner


# --- TIFF -----------------------------------------------------------------------------------------

TIFF_TYPES = {1: "B", 2: "s", 3: "H", 4: "I", 5: "II", 6: "b", 7: "B", 8: "h", 9: "i", 10: "ii",
              11: "f", 12: "d"}


def read_tiff(data):
    order = "<" if data[:2] == b"II" else ">"
    (directory,) = struct.unpack_from(order + "I", data, 4)
    tags = tiff_tags(data, order, directory)
    width, height = tags[256][0], tags[257][0]
    samples = tags.get(277, (1,))[0]
    bits, form = tags.get(258, (1,))[0], tags.get(339, (1,))[0]
    if tags.get(284, (1,))[0] != 1:
        raise PictureError("TIFF: separate planes are not read")
    code = {(8, 1): "B", (16, 1): "H", (32, 1): "I", (32, 3): "f", (64, 3): "d", (16, 3): "e",
            (8, 2): "b", (16, 2): "h", (32, 2): "i"}.get((bits, form))
    if code is None:
        raise PictureError(f"TIFF: {bits} bits of sample format {form} are not read")
    levels = None if form == 3 else 2 ** (bits if form == 1 else bits - 1) - 1
    scale = 1.0 if levels is None else 1.0 / levels
    rows = []
    for block_width, lines in tiff_blocks(data, tags, width, height, samples * bits // 8):
        for line in lines:
            line = tiff_unpredict(line, tags.get(317, (1,))[0], samples, bits, order)
            values = struct.unpack(f"{order}{block_width * samples}{code}", line)
            rows.append([value * scale for value in values] if levels else list(values))
    picture = Picture(width, height, tiff_channels(samples), rows[:height], levels)
    picture.tags = tags
    return picture


def tiff_tags(data, order, offset):
    (count,) = struct.unpack_from(order + "H", data, offset)
    tags = {}
    for i in range(count):
        entry = offset + 2 + 12 * i
        tag, kind, length = struct.unpack_from(order + "HHI", data, entry)
        code = TIFF_TYPES.get(kind)
        if code is None:
            continue
        size = struct.calcsize(order + code) * length
        at = entry + 8 if size <= 4 else struct.unpack_from(order + "I", data, entry + 8)[0]
        if code == "s":
            tags[tag] = data[at:at + length].rstrip(b"\0").decode("latin-1")
        else:
            tags[tag] = struct.unpack_from(f"{order}{code * length}", data, at)
    return tags


def tiff_channels(samples):
    return {1: ["y"], 2: ["y", "a"], 3: ["r", "g", "b"], 4: ["r", "g", "b", "a"],
            5: ["r", "g", "b", "a", "z"]}.get(samples, [f"c{i}" for i in range(samples)])


def tiff_blocks(data, tags, width, height, pixel_bytes):
    """Yields (width, rows of bytes) top to bottom; tiles are joined into full-width strips first."""
    compression = tags.get(259, (1,))[0]
    if 322 in tags:
        yield from tiff_tiles(data, tags, width, pixel_bytes, compression)
        return
    for at, size in zip(tags[273], tags[279]):
        raw = tiff_inflate(data[at:at + size], compression)
        row = width * pixel_bytes
        yield width, [raw[i:i + row] for i in range(0, len(raw) - row + 1, row)]


def tiff_tiles(data, tags, width, pixel_bytes, compression):
    tile_width, tile_height = tags[322][0], tags[323][0]
    across = (width + tile_width - 1) // tile_width
    row = tile_width * pixel_bytes
    blocks = list(zip(tags[324], tags[325]))
    for start in range(0, len(blocks), across):
        raw = [tiff_inflate(data[at:at + size], compression) for at, size in blocks[start:start + across]]
        yield width, [b"".join(part[y * row:(y + 1) * row] for part in raw)[:width * pixel_bytes]
                      for y in range(tile_height)]


def tiff_inflate(raw, compression):
    if compression == 1:
        return raw
    if compression in (8, 32946):
        return zlib.decompress(raw)
    if compression == 32773:
        return unpack_bits(raw)
    if compression == 5:
        return unpack_lzw(raw)
    raise PictureError(f"TIFF: compression {compression} is not read")


def unpack_bits(raw):
    out, i = bytearray(), 0
    while i < len(raw):
        count = raw[i]
        if count < 128:
            out += raw[i + 1:i + 2 + count]
            i += 2 + count
        else:
            if count > 128:
                out += raw[i + 1:i + 2] * (257 - count)
            i += 2 if count > 128 else 1
    return bytes(out)


def unpack_lzw(raw):
    """TIFF's LZW: codes most significant bit first, width grows one code early (TIFF 6.0, section 13)."""
    table, out, width, previous = None, bytearray(), 9, None
    buffer, held, at = 0, 0, 0
    while True:
        while held < width and at < len(raw):
            buffer, held, at = (buffer << 8) | raw[at], held + 8, at + 1
        if held < width:
            return bytes(out)
        code = (buffer >> (held - width)) & ((1 << width) - 1)
        held -= width
        buffer &= (1 << held) - 1
        if code == 257:
            return bytes(out)
        if code == 256:
            table, width, previous = [bytes([i]) for i in range(256)] + [b"", b""], 9, None
            continue
        if previous is None:
            entry = table[code]
        else:
            entry = table[code] if code < len(table) else previous + previous[:1]
            table.append(previous + entry[:1])
        out += entry
        previous = entry
        width = 9 if len(table) < 511 else 10 if len(table) < 1023 else 11 if len(table) < 2047 else 12


def tiff_unpredict(line, predictor, samples, bits, order):
    if predictor == 1:
        return line
    size = bits // 8
    if predictor == 2:
        code = f"{order}{len(line) // size}{'?BH?I'[size]}"
        values = list(struct.unpack(code, line))
        for i in range(samples, len(values)):
            values[i] = (values[i] + values[i - samples]) & (2 ** bits - 1)
        return struct.pack(code, *values)
    if predictor == 3:  # byte planes, most significant first, then byte differences
        flat = bytearray(line)
        for i in range(samples, len(flat)):
            flat[i] = (flat[i] + flat[i - samples]) & 255
        count = len(flat) // size
        planes = [flat[p * count:(p + 1) * count] for p in range(size)]
        if order == "<":
            planes.reverse()
        return bytes(byte for group in zip(*planes) for byte in group)
    raise PictureError(f"TIFF: predictor {predictor} is not read")


# --- OpenEXR --------------------------------------------------------------------------------------

EXR_CODES = {0: ("I", 4), 1: ("e", 2), 2: ("f", 4)}
EXR_BLOCK_LINES = {0: 1, 1: 1, 2: 1, 3: 16}  # none, RLE, ZIPS, ZIP


def read_exr(data):
    """All parts of a file as one picture, which must agree in size. tags: those of the first part."""
    flags = struct.unpack_from("<I", data, 4)[0]
    if flags & 0x0A00:
        raise PictureError("OpenEXR: tiled and deep files are not read")
    multi_part = bool(flags & 0x1000)
    headers, offset = [], 8
    while not headers or (multi_part and data[offset]):
        header, offset = exr_header(data, offset)
        headers.append(header)
    offset += multi_part
    channels, columns = [], []
    for header in headers:
        part_channels, lines, offset = exr_part(data, header, offset, multi_part)
        channels += part_channels
        columns.append(lines)
    if len({len(lines) for lines in columns}) != 1:
        raise PictureError("OpenEXR: parts differ in height")
    names, order = exr_order(channels)
    rows = []
    for parts in zip(*columns):
        row = [values for part in parts for values in part]
        rows.append([row[c][x] for x in range(len(row[0])) for c in order])
    picture = Picture(len(rows[0]) // len(order), len(rows), names, rows)
    picture.tags = headers[0]
    picture.parts = [header["name"].decode("latin-1") for header in headers if "name" in header]
    picture.kinds = {name: code for name, code, _ in channels}
    return picture


def exr_part(data, header, offset, multi_part):
    """Its channels, per line a list of their values, and where the next part's table begins."""
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = header["compression"][0]
    if compression not in EXR_BLOCK_LINES:
        raise PictureError(f"OpenEXR: compression {compression} is not read")
    channels = exr_channels(header["channels"])
    lines = EXR_BLOCK_LINES[compression]
    blocks = (height + lines - 1) // lines
    rows = [None] * height
    for at in struct.unpack_from(f"<{blocks}Q", data, offset):
        at += 4 * multi_part  # the number of the part
        y, size = struct.unpack_from("<iI", data, at)
        count = min(lines, height - (y - y0))
        plain = exr_inflate(data[at + 8:at + 8 + size], compression, channels, width * count)
        exr_rows(plain, channels, width, y - y0, count, rows)
    return channels, rows, offset + 8 * blocks


def exr_header(data, offset):
    header = {}
    while data[offset]:
        end = data.index(b"\0", offset)
        name = data[offset:end].decode("latin-1")
        end_type = data.index(b"\0", end + 1)
        (size,) = struct.unpack_from("<I", data, end_type + 1)
        offset = end_type + 5 + size
        header[name] = data[end_type + 5:offset]
    return header, offset + 1


def exr_channels(raw):
    channels, offset = [], 0
    while raw[offset]:
        end = raw.index(b"\0", offset)
        kind, _, xs, ys = struct.unpack_from("<iIii", raw, end + 1)
        if (xs, ys) != (1, 1):
            raise PictureError("OpenEXR: subsampled channels are not read")
        channels.append((raw[offset:end].decode("latin-1"), *EXR_CODES[kind]))
        offset = end + 17
    return channels


def exr_inflate(raw, compression, channels, pixels):
    full = pixels * sum(size for _, _, size in channels)
    if compression == 0 or len(raw) == full:
        return raw
    flat = bytearray(exr_unrle(raw) if compression == 1 else zlib.decompress(raw))
    for i in range(1, len(flat)):
        flat[i] = (flat[i - 1] + flat[i] - 128) & 255
    half = (len(flat) + 1) // 2
    out = bytearray(len(flat))
    out[0::2], out[1::2] = flat[:half], flat[half:]
    return bytes(out)


def exr_unrle(raw):
    out, i = bytearray(), 0
    while i < len(raw):
        count = raw[i] - 256 if raw[i] > 127 else raw[i]
        if count < 0:
            out += raw[i + 1:i + 1 - count]
            i += 1 - count
        else:
            out += raw[i + 1:i + 2] * (count + 1)
            i += 2
    return bytes(out)


def exr_rows(plain, channels, width, first, count, rows):
    at = 0
    for line in range(count):
        row = []
        for _, code, size in channels:
            row.append(struct.unpack_from(f"<{width}{code}", plain, at))
            at += width * size
        rows[first + line] = row


def exr_order(channels):
    """r g b a z first, then the rest in file order (which is alphabetical)."""
    names = [name for name, _, _ in channels]
    wanted = [name for name in ("R", "G", "B", "A", "Z", "Y") if name in names]
    ordered = wanted + [name for name in names if name not in wanted]
    return [n.lower() if n in wanted else n for n in ordered], [names.index(n) for n in ordered]


# --- others ---------------------------------------------------------------------------------------

def read_zfile(data):
    """Pixar's depth file; tags worldtoscreen and worldtocamera are rows of 16 floats."""
    width, height = struct.unpack_from("<hh", data, 4)
    values = struct.unpack_from(f"<{width * height}f", data, 136)
    picture = Picture(width, height, ["z"], [values[y * width:(y + 1) * width] for y in range(height)])
    picture.tags = {"worldtoscreen": struct.unpack_from("<16f", data, 8),
                    "worldtocamera": struct.unpack_from("<16f", data, 72)}
    return picture


def read_map(data):
    """Binary PGM and PPM."""
    fields, offset = [], 2
    while len(fields) < 3:
        while data[offset:offset + 1].isspace():
            offset += 1
        if data[offset:offset + 1] == b"#":
            offset = data.index(b"\n", offset)
            continue
        end = offset
        while not data[end:end + 1].isspace():
            end += 1
        fields.append(int(data[offset:end]))
        offset = end
    width, height, levels = fields
    channels = ["r", "g", "b"] if data[:2] == b"P6" else ["y"]
    row = width * len(channels)
    code = f">{row}{'H' if levels > 255 else 'B'}"
    scale = 1.0 / levels
    rows = [[v * scale for v in struct.unpack_from(code, data, offset + 1 + y * struct.calcsize(code))]
            for y in range(height)]
    return Picture(width, height, channels, rows, levels)
