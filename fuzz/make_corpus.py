#!/usr/bin/python3
"""Writes the seeds of the fuzz targets into corpus/NAME: tiny, synthetic files of every kind and
encoding that the readers know. Run it again after changing it; inputs that once broke a reader lie
beside them as found-* and are left alone."""

import base64
import gzip
import json
import math
import pathlib
import struct
import zlib

CORPUS = pathlib.Path(__file__).resolve().parent / "corpus"
POINTS = [(0.0, 0.0, 0.5), (0.25, 0.0, 0.5), (0.0, 0.25, 0.625), (0.25, 0.25, 0.75)]
COLORS = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (10, 20, 30)]


def seed(target, name, data):
    folder = CORPUS / target
    folder.mkdir(parents=True, exist_ok=True)
    data = data.encode() if isinstance(data, str) else data
    (folder / name).write_bytes(data)
    if target not in ("any", "array", "cdr", "client_message", "depth", "e57", "frame_list", "haply_frame", "mcap", "poses",
                      "potree", "remote_frame", "remote_state", "sequence", "trajectory"):
        seed("any", f"{target}-{name}", data)


def ply():
    head = "ply\nformat {} 1.0\ncomment a seed\nelement vertex 4\n"
    plain = "property float x\nproperty float y\nproperty float z\n"
    seed("ply", "ascii", head.format("ascii") + plain + "property float intensity\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
         + "".join(f"{x} {y} {z} 0.5\n" for x, y, z in POINTS) + "3 0 1 2\n")
    seed("ply", "strips", head.format("ascii") + plain
         + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
         + "".join(f"{x} {y} {z}\n" for x, y, z in POINTS) + "9 0 1 2 3 -1 3 1 0 -1\n")
    rich = ("property uchar red\nproperty double z\nproperty list uchar short extra\n"
            "property float nx\nproperty float ny\nproperty float nz\nproperty double x\n"
            "property uchar green\nproperty double y\nproperty uchar blue\nend_header\n")
    for order, name in (("<", "binary_little_endian"), (">", "binary_big_endian")):
        rows = b"".join(
            struct.pack(order + "BdB2hfffdBdB", r, z, 2, 7, 8, 0, 0, 1, x, g, y, b)
            for (x, y, z), (r, g, b) in zip(POINTS, COLORS))
        seed("ply", name, (head.format(name) + rich).encode() + rows)
    rows = b"".join(struct.pack("<BiiB", 2, 0, 1, 9) for _ in range(2))
    before = head.format("binary_little_endian").replace(
        "element vertex", "element edge 2\nproperty list uchar int ends\nproperty uchar mark\n"
        "element vertex")
    seed("ply", "element_before", (before + plain + "end_header\n").encode() + rows
         + b"".join(struct.pack("<3f", *p) for p in POINTS))
    seed("ply", "crlf_utm", (head.format("ascii") + plain.replace("float", "double")
         + "end_header\n").replace("\n", "\r\n")
         + "".join(f"{x + 4e5} {y + 5.5e6} {z}\r\n" for x, y, z in POINTS))


def lzf(data):
    """LZF of literals, and a back reference where eight bytes repeat at a distance of eight."""
    out, i = b"", 0
    while i < len(data):
        if i >= 8 and len(data) - i >= 8 and data[i:i + 8] == data[i - 8:i]:
            out += bytes([6 << 5, 7])
        else:
            chunk = data[i:i + 8]
            out += bytes([len(chunk) - 1]) + chunk
        i += 8
    return out


def pcd():
    def head(fields, sizes, types, counts, width, height, data, viewpoint="0 0 0 1 0 0 0"):
        return (f"# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {fields}\n"
                f"SIZE {sizes}\nTYPE {types}\nCOUNT {counts}\nWIDTH {width}\nHEIGHT {height}\n"
                f"VIEWPOINT {viewpoint}\nPOINTS {width * height}\nDATA {data}\n")
    xyz = ("x y z", "4 4 4", "F F F", "1 1 1")
    seed("pcd", "ascii", head(*xyz, 4, 1, "ascii")
         + "".join(f"{x} {y} {z}\n" for x, y, z in POINTS[:3]) + "nan nan nan\n")
    seed("pcd", "binary", head(*xyz, 4, 1, "binary").encode()
         + b"".join(struct.pack("<3f", *p) for p in POINTS))
    fields = ("x y z rgb normal_x normal_y normal_z intensity _", "4 4 4 4 4 4 4 4 1",
              "F F F F F F F F U", "1 1 1 1 1 1 1 1 3")
    rows = [struct.pack("<3fI4f3B", x, y, z, r << 16 | g << 8 | b, 0, 0, 1, 0.5, 1, 2, 3)
            for (x, y, z), (r, g, b) in zip(POINTS, COLORS)]
    seed("pcd", "binary_rich", head(*fields, 2, 2, "binary", "0 0 1 0 1 0 0").encode()
         + b"".join(rows))
    columns = b"".join(struct.pack("<4f", *[p[k] for p in POINTS]) for k in range(3))
    packed = lzf(columns)
    seed("pcd", "compressed", head(*xyz, 2, 2, "binary_compressed").encode()
         + struct.pack("<2I", len(packed), len(columns)) + packed)
    seed("pcd", "old", "COLUMNS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 2\nDATA ascii\n"
         "0 0 1 4.2108e+06\n0 1 1 2.3418052e-38\n")


def las_header(minor, point_format, record, count, offset=None):
    size = 375 if minor == 4 else 235 if minor == 3 else 227
    head = bytearray(size)
    head[0:4] = b"LASF"
    head[24:26] = bytes([1, minor])
    struct.pack_into("<HII", head, 94, size, offset or size, 0)
    legacy = 0 if point_format & 63 >= 6 else count
    struct.pack_into("<BHI", head, 104, point_format, record, legacy)
    struct.pack_into("<6d", head, 131, 0.01, 0.01, 0.01, 500000, 4600000, 100)
    if minor == 4:
        struct.pack_into("<Q", head, 247, count)
    return bytes(head)


LAS_RECORDS = {0: 20, 1: 28, 2: 26, 3: 34, 4: 57, 5: 63, 6: 30, 7: 36, 8: 38, 9: 59, 10: 67}
# Well-known text: plan in metres, heights in feet.
LAS_SYSTEM = (b'COMPD_CS["a",PROJCS["b",GEOGCS["c",UNIT["degree",0.0174532925]],UNIT["metre",1],'
              b'AUTHORITY["EPSG","26910"]],VERT_CS["d",UNIT["US survey foot",0.3048006096]]]\0')
LAS_COLORS = {2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30}


def las_record(user, number, data):
    return struct.pack("<H16sHH32s", 0, user, number, len(data), b"") + data


def las():
    for fmt, record in LAS_RECORDS.items():
        minor = 4 if fmt >= 6 else min(fmt, 3)
        rows = b""
        for i, (x, y, z) in enumerate(POINTS):
            row = bytearray(record)
            struct.pack_into("<3iH", row, 0, int(x * 100), int(y * 100), int(z * 100), 1000 + i)
            row[15] = (4 if fmt >= 6 else 128) if i == 3 else 2
            if fmt in LAS_COLORS:
                struct.pack_into("<3H", row, LAS_COLORS[fmt], *[257 * c for c in COLORS[i]])
            rows += row
        seed("las", f"format_{fmt}", las_header(minor, fmt, record, len(POINTS)) + rows)
        if fmt == 0:
            text = las_record(b"LASF_Projection", 2112, LAS_SYSTEM)
            head = bytearray(las_header(minor, fmt, record, len(POINTS), 227 + len(text)))
            struct.pack_into("<I", head, 100, 1)
            seed("las", "heights_in_feet", bytes(head) + text + rows)


# LAZ: format, extra bytes, points and bytes of each chunk, and the chunks with the table of their
# sizes, as the encoder of tests/io makes them.
LAZ_CHUNKS = (
    (1, 0, [(1, 32), (6, 70), (5, 67)],
     "2IYBAEMNAwC5CwAA4QABBAAAAAAAAAAAAAAAQQAAAAAAhwEARg0DALULAADhAAEEAAAAAAAAAAAAAABBQhY6KS+Lo/3UfKIhed"
     "RDM1NJJE7DeXLQnMvHoWfcaof9kgywg6MnTgAALYgBAEsNAwCrCwAA5AASBAKyGNzIMgAAAAAAQUoVOrXSAsTfPG/cnWW7HUNP"
     "ZvFULdR+U8+XLex/2EZoa86AAAAAAAAAAAADAAAABJNvuR16Qy32AA=="),
    (3, 2, [(6, 105), (6, 108)],
     "0IYBAEANAwC0CwAA0gAJAAAAAAAAAAAAAAAAQUMBQwFDAQADwGtCRFSj4ZxUeUvFLftuDur+UyxQEHXAiKcAadngJaDd06NmPr"
     "zOIF/1ZFffIUccbwF0J/TE05dt2zSq03sVDLUAAAAACYgBADUNAwC9CwAA4gAKAAEAAACgDwAAAAAAQYECgQKBAgQDyHGek68d"
     "yUYf7WXzvqMn+yy0Okk//3hxG5algEAvQJ0DZh7lE9maVDRqk0So+u5F6Wz6mXfoUnUR/kd7KdzJ0eVtSSi3owAAAAAAAAIAAA"
     "A8mkmShgA="),
    (6, 0, [(6, 127), (6, 139)],
     "1YYBAEINAwC3CwAAAAAAAAAAw/sAAAAAAAAAAABBBgAAABUAAAAIAAAAAAAAAAAAAAAKAAAACQAAAAAAAAAAAAAACQAAABBnI5"
     "st5cWbosgbZohOec2aBpQAABVTcdhr2AwAhP46InuSWB0AAK40JSR1wVAAABPADnUPnz5gAPSHAQBEDQMAuwsAANsAhQAAAKn/"
     "AAD4KgAAAAAAQQYAAAATAAAACAAAAAkAAAAAAAAACwAAAAUAAAAJAAAAAAAAAAgAAAAgaoHlDMQWBkURvIXNnwLs1MAACAvG6/"
     "0dTgAYGAwMC/P0AAA6yANJiB6UIcAAAGmkCUwAACgoFBPr7AAAFX24Fa7qIAAAAAAAAgAAAD3wks8yAA=="),
    (8, 2, [(6, 200), (6, 195)],
     "0IYBAD0NAwC4CwAA5AAAAAAAAAAAAAAAAAAAAABBAABwAAAAEo4AAwYAAAAVAAAACAAAAAkAAAAAAAAACAAAAAAAAAAAAAAAAA"
     "AAAAsAAAATAAAACgAAAAkAAAAJAAAAIGZjbO0HuRO/W2re3Mx9Rj/XzIAABBwlVhKopAAAAAAYF/P0AAACZKgD8oHAABap90NL"
     "tgzmnFAAgiC1vDznhJiN9hL3Cqrbz/gAADL2xujGYQAAAAAAAAX9AgF9gAD+A30BBP5+gADkhwEATQ0DALELAADYAEQgGAAAAA"
     "AACC4AAAAAAEHx/vH+8f4eAAcCBgAAABUAAAAIAAAAAAAAAAcAAAAHAAAABwAAAAAAAAAAAAAACQAAABYAAAAAAAAACQAAAAkA"
     "AAAuIkrTEGyBnICThdOgjkV/9GAUNAAaQya73XLDAAAIYHfPgAAAAFV3YEgAk5n7Ct2gABQg+vUPnz5gAPjZAZ3+PsBH4T9aGf"
     "PLDVf+YcgIAAAAAPr/h3/9gAAE+/6F/n4AgAAAAAAAAgAAAEQWDvWmAA=="),
)
LAZ_ITEMS = {1: [(6, 20), (7, 8)], 3: [(6, 20), (7, 8), (8, 6), (0, 2)], 6: [(10, 30)],
             8: [(10, 30), (12, 8), (14, 2)]}


def laz_file(fmt, extra, sizes, chunks, before=b""):
    """`before`: a record of the header. Returns the bytes, and the place of the first chunk."""
    version = 2 if fmt < 6 else 3
    points = 0xffffffff if fmt == 1 else sizes[0][0]
    items = b"".join(struct.pack("<3H", kind, size, version) for kind, size in LAZ_ITEMS[fmt])
    records = before + las_record(b"laszip encoded", 22204, struct.pack(
        "<2H2BH2I2qH", version, 0, 3, 0, 0, 0, points, -1, -1, len(LAZ_ITEMS[fmt])) + items)
    minor = 4 if fmt >= 6 else 2
    offset = len(las_header(minor, fmt, 0, 0)) + len(records)
    head = bytearray(las_header(minor, fmt | 128, LAS_RECORDS[fmt] + extra, sum(n for n, _ in sizes),
                                offset))
    struct.pack_into("<I", head, 100, 2 if before else 1)
    table = offset + 8 + sum(size for _, size in sizes)
    return bytes(head) + records + struct.pack("<q", table) + base64.b64decode(chunks), offset + 8


def laz():
    for fmt, extra, sizes, chunks in LAZ_CHUNKS:
        seed("laz", f"format_{fmt}", laz_file(fmt, extra, sizes, chunks)[0])
    seed("laz", "without_description", las_header(2, 128, 20, 4) + bytes(40))

    def copc(place):
        info = struct.pack("<5d2Q2d", 0, 0, 0, 8, 1, place, 64, 0, 1) + bytes(88)
        return laz_file(*next(entry for entry in LAZ_CHUNKS if entry[0] == 6),
                        before=las_record(b"copc", 1, info))
    data, first = copc(0)
    (points, size), (points_2, size_2) = LAZ_CHUNKS[2][2]
    pages = struct.pack("<4iQ2i", 0, 0, 0, 0, first, size, points)
    pages += struct.pack("<4iQ2i", 1, 1, 0, 0, len(data) + 64, 32, -1)
    pages += struct.pack("<4iQ2i", 1, 1, 0, 0, first + size, size_2, points_2)
    seed("copc", "two_pages", copc(len(data))[0] + pages)


def depth():
    width, height = 4, 3
    samples = [0, 65535, 500, 510, 520, 530, 540, 550, 560, 570, 580, 60000]
    rows = struct.pack(">12H", *samples)
    seed("pgm", "maxval_65535", b"P5\n# a seed\n4 3\n65535\n" + rows)
    seed("pgm", "maxval_10000", b"P5 4 3 10000\n" + rows)
    seed("depth", "pgm", b"P5 4 3 65535\n" + rows)
    plane = [1000 + 3 * (i % 16) + i // 16 for i in range(256)]
    seed("depth", "pgm_swapped", b"P5 16 16 65535\n" + struct.pack("<256H", *plane))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    lines = b"".join(b"\0" + rows[8 * i:8 * i + 8] for i in range(height))
    for name, bits, data in (("depth", 16, lines), ("grey8", 8, bytes(15))):
        png = (b"\x89PNG\r\n\x1a\n"
               + chunk(b"IHDR", struct.pack(">2I5B", width, height, bits, 0, 0, 0, 0))
               + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))
        seed("png", name, png)
        seed("depth", "png_" + name, png)


def text():
    seed("xyz", "plain", "".join(f"{x} {y} {z}\n" for x, y, z in POINTS))
    seed("xyz", "intensity", "# a comment\n" + "".join(f"{x}\t{y}\t{z}\t7\n" for x, y, z in POINTS))
    seed("xyz", "named", "x,y,z,Intensity,R,G,B\n"
         + "".join(f"{x},{y},{z},,{r},{g},{b}\n"
                   for (x, y, z), (r, g, b) in zip(POINTS, COLORS)))
    seed("xyz", "comment_names", "//X Y Z Nx Ny Nz\n"
         + "".join(f"{x} {y} {z} 0 0 1\n" for x, y, z in POINTS))
    seed("xyz", "pts", "4\n" + "".join(f"{x} {y} {z} -12 {r} {g} {b}\n"
                                      for (x, y, z), (r, g, b) in zip(POINTS, COLORS)))
    seed("xyz", "normals_colors", "".join(f"{x};{y};{z};0;0;1;{r};{g};{b}\n"
                                          for (x, y, z), (r, g, b) in zip(POINTS, COLORS)))
    seed("xyz", "tabs", "\t".join("xyz") + "\n" + "".join(f"{x}\t\t{z}\n{x}\t{y}\t{z}\n" for x, y, z in POINTS))
    seed("xyz", "decimal_commas", "sep=;\n" + "".join(f'"{x}";{y};{z}\n'.replace(".", ",") for x, y, z in POINTS))
    seed("xyz", "commas_and_blanks", "".join(f"{x}, {y}, {z}\n".replace(".", ",") for x, y, z in POINTS))
    seed("xyz", "units", "# units: mm\nX [ft],Y [ft],Z (NAVD88 ft)\n" + "".join(f"{x},{y},{z}\n" for x, y, z in POINTS))
    seed("xyz", "counted", "".join(f"{i} {x} {y} {z}D0\n" for i, (x, y, z) in enumerate(POINTS)))
    seed("xyz", "degrees", "lat,lon,alt\n" + "".join(f"{x + 60},{y + 9},{z}\n" for x, y, z in POINTS))
    seed("xyz", "scans", "".join(f"2\n{x} {y} {z} 1\n{y} {x} {z} 2\n" for x, y, z in POINTS))
    seed("any", "ptx-scan", "1\n5\n9 8 7\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n9 8 7 1\n"
         + "0 0 0 0 0 0 0\n" + "".join(f"{x} {y} {z} 0.5 {r} {g} {b}\n"
                                       for (x, y, z), (r, g, b) in zip(POINTS, COLORS)))
    seed("obj", "plain", "# a seed\nmtllib a.mtl\no thing\n"
         + "".join(f"v {x} {y} {z}\nvn 0 0 2\n" for x, y, z in POINTS) + "f 1//1 2//2 3//3\n")
    seed("obj", "colors", "".join(f"v {x} {y} {z} {r / 255} {g / 255} {b / 255}\n"
                                  for (x, y, z), (r, g, b) in zip(POINTS, COLORS)))
    seed("obj", "faces", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1/1 2/2/1 3//1 4\nf -1 -2 -4\nf 1 1 2\n")
    seed("trajectory", "plain", "t,hip_x,hip_y,hip_z,more\n0,0,0,0.1,a\n0.001,0,0,0.099,b\n")


def arrays():
    for version, size in ((1, "<H"), (2, "<I")):
        for order in ("False", "True"):
            head = f"{{'descr': '<f4', 'fortran_order': {order}, 'shape': (4, 3), }}\n".encode()
            seed("array", f"version{version}_{order.lower()}", b"\x93NUMPY" + bytes([version, 0])
                 + struct.pack(size, len(head)) + head + b"".join(struct.pack("<3f", *p) for p in POINTS))
    seed("array", "kitti", b"".join(struct.pack("<4f", *p, 0.5) for p in POINTS))


def stl():
    corners = [POINTS[0], POINTS[1], POINTS[2], POINTS[1], POINTS[3], POINTS[2]]
    seed("stl", "ascii", "solid a\n" + "".join(
        "facet normal 0 0 1\n outer loop\n" + "".join(f"  vertex {x} {y} {z}\n" for x, y, z in corners[i:i + 3])
        + " endloop\nendfacet\n" for i in (0, 3)) + "endsolid a\n")
    seed("stl", "binary", b"a seed".ljust(80) + struct.pack("<I", 2) + b"".join(
        struct.pack("<3f", 0, 0, 1) + b"".join(struct.pack("<3f", *p) for p in corners[i:i + 3]) + b"\0\0"
        for i in (0, 3)))


def gltf():
    data = b"".join(struct.pack("<3f", *p) for p in POINTS) + struct.pack("<6H", 0, 1, 2, 1, 3, 2) \
        + b"".join(bytes([*c, 255]) for c in COLORS)
    scene = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1, 2], "scale": [1, 2, 1]}, {"mesh": 0, "translation": [0, 1, 0]},
                  {"mesh": 0, "rotation": [0, 0, 1, 0]}],
        "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "COLOR_0": 2}, "indices": 1, "material": 0},
            {"attributes": {"POSITION": 0}, "mode": 5}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1]}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
                      {"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4", "normalized": True}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
                        {"buffer": 0, "byteOffset": 60, "byteLength": 16, "byteStride": 4}],
        "buffers": [{"byteLength": len(data)}]}

    def glb(text):
        text += b" " * (-len(text) % 4)
        return (b"glTF" + struct.pack("<2I", 2, 28 + len(text) + len(data)) + struct.pack("<I", len(text)) + b"JSON"
                + text + struct.pack("<I", len(data)) + b"BIN\0" + data)
    seed("gltf", "glb", glb(json.dumps(scene).encode()))
    scene["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    seed("gltf", "embedded", json.dumps(scene))
    scene["buffers"][0]["uri"] = "data.bin"
    seed("gltf", "beside", json.dumps(scene))


def packed():
    plain = "".join(f"{x} {y} {z}\n" for x, y, z in POINTS).encode()
    one = gzip.compress(plain, mtime=0)
    seed("gzip", "xyz", one)
    seed("gzip", "two_members", one + gzip.compress(plain, mtime=0))
    seed("gzip", "stored", gzip.compress(plain, compresslevel=0, mtime=0))


def e57():
    """E57 files without the CRCs of their pages, which the target adds."""
    def columns(names, kind):
        return "".join(f"<{name} type={kind}/>" for name in names)

    def scan(at, points, prototype, more=""):
        return (f'<vectorChild><name>a</name>{more}<points type="CompressedVector" fileOffset="{at}" '
                f'recordCount="{points}"><prototype>{prototype}</prototype></points></vectorChild>')

    def packet(*streams):
        data = struct.pack("<H", len(streams)) + b"".join(struct.pack("<H", len(each)) for each in streams)
        data += b"".join(streams)
        data += bytes(-len(data) % 4)
        return struct.pack("<BBH", 1, 0, len(data) + 3) + data

    def file(packets, *scans):
        size = 32 + len(packets)
        data = struct.pack("<B7xQQQ", 1, size, 48 + 32, 0) + packets
        xml = f"<e57Root><data3D>{''.join(scans)}</data3D><images2D><vectorChild/></images2D></e57Root>".encode()
        head = struct.pack("<8sIIQQQQ", b"ASTM-E57", 1, 0, 1024, 48 + size, len(xml), 1024)
        return head + data + xml

    xs, ys, zs = ([p[k] for p in POINTS] for k in range(3))
    doubles = [struct.pack("<4d", *each) for each in (xs, ys, zs)]
    xyz = ("cartesianX", "cartesianY", "cartesianZ")
    pose = "<pose><rotation><w>0.6</w><z>0.8</z></rotation><translation><x>5</x></translation></pose>"
    seed("e57", "doubles", file(packet(*doubles), scan(48, 4, columns(xyz, '"Float"'), pose)))
    uneven = packet(doubles[0], b"", doubles[2][:9]) + struct.pack("<BBH4x", 0, 0, 7) + packet(
        b"", doubles[1], doubles[2][9:]) + struct.pack("<BBH", 2, 0, 3)
    seed("e57", "uneven", file(uneven, scan(48, 4, columns(xyz, '"Float"'))))
    spherical = columns(("sphericalRange", "sphericalAzimuth", "sphericalElevation"), '"Float" precision="single"')
    singles = [struct.pack("<4f", *each) for each in (zs, xs, ys)]
    state = '<sphericalInvalidState type="Integer" minimum="0" maximum="2"/>'
    seed("e57", "spherical", file(packet(*singles, b"\x60"), scan(48, 4, spherical + state)))
    scaled = columns(xyz, '"ScaledInteger" minimum="0" maximum="7" scale="0.125" offset="1"')
    colors = columns(("colorRed", "colorGreen", "colorBlue"), '"Integer" minimum="0" maximum="255"')
    bits = sum(value << 3 * i for i, value in enumerate((0, 2, 5, 7))).to_bytes(2, "little")
    seed("e57", "scaled", file(packet(bits, bits, bits, *(bytes(each) for each in zip(*COLORS))),
                               scan(48, 4, scaled + colors), scan(0, 0, "")))


def sequences():
    camera = '"fx": 500, "fy": 510, "cx": 320, "cy": 240'
    seed("sequence", "least", "{" + camera + "}")
    seed("sequence", "every_field", "{" + camera + """, "width": 640, "height": 480,
 "distortion": [0.1, 0.2, 0.3], "depth_unit_m": 0.0002, "fps": 15, "invalid": [0, 7, 65535],
 "images": "d", "frames": "list.txt", "stamps": [0, 0.5], "pose": "poses.log: colour",
 "pose_direction": "world_to_camera", "T_pose_camera": [1, 2, 3, 0, 0, 1, 0],
 "byte_order": "little", "static_camera": false, "intrinsics_note": "guessed"}""")
    seed("frame_list", "depth", "# depth maps\n1.5 depth/a.png\n2.5 depth/b.png\n")
    seed("frame_list", "associations", "1 rgb/a.png 1.1 depth/b.png\n2 depth/c.png 2.1 rgb/d.png\n")
    seed("poses", "tum", "# timestamp tx ty tz qx qy qz qw\n1.5 1 2 3 0 0 0 1\n2.5 4 5 6 0 0 1 0\n")
    seed("poses", "order", "0 0 1\n1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n"
         "3\t3\t4\n 0 -1 0 1\n 1 0 0 2\n 0 0 1 3\n 0 0 0 1\n")
    seed("poses", "number", "# Depth-to-color camera extrinsic matrix\n"
         "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n# pose for frame-000012\n"
         "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n")


def remote():
    def state(flags=0, version=1, x=0.1, velocity=0.0, reserved=0):
        return struct.pack("<4sHHQd3d3dII", b"plpS", version, flags, 7, 1.5, x, 0.2, -0.3,
                           velocity, 0, 0, 5, reserved)
    seed("remote_state", "place", state())
    seed("remote_state", "velocity", state(flags=1, velocity=-0.5))
    seed("remote_state", "leaving", state(flags=2))
    seed("remote_state", "not_a_number", state(x=float("nan")))
    seed("remote_state", "too_far", state(x=1e9))
    seed("remote_state", "newer", state(version=3, reserved=1))
    turns = struct.pack("<4d3dd", 0.5, -0.5, 0.5, 0.5, 1, -2, 3, 0.02)
    seed("remote_state", "turns", state(version=2, flags=29) + turns)
    seed("remote_state", "no_rotation", state(version=2, flags=1) + bytes(64))

    def frame(flags=0, version=1, size=(6, 7), unit=1e-3, fx=300.0, stamp=1.5, w=1.0, depth=None):
        steps = [0, 65535, 700, 701, 65534, 1] * 7
        return struct.pack("<4sHHII18d", b"plpD", version, flags, *size, unit, fx, 301, 2.5, 3, 0.1, -0.2, 0.01, 0.02, 0,
                           stamp, 1, 2, 3, 0, 0, 0, w) + (depth or struct.pack("<42H", *steps))
    metres = struct.pack("<42f", *([0.7, 0, -1, float("nan"), float("inf"), 1e-40] * 7))
    seed("remote_frame", "two", frame() + frame(stamp=2))
    seed("remote_frame", "all", frame(flags=3) + frame(flags=7, unit=1, depth=metres))
    seed("remote_frame", "cut", frame(flags=4, depth=metres)[:-1])
    seed("remote_frame", "not_a_number", frame(fx=float("nan")))
    seed("remote_frame", "too_large", frame(size=(8192, 8192)))
    seed("remote_frame", "turned_too_far", frame(flags=1, w=0.5))
    seed("remote_frame", "newer", frame(flags=8, version=2))


def client_messages():
    for name, rest in (("hello", '"token":"00ff","points":500000'), ("release", '"device":0'),
                       ("hand", '"device":0,"position":[0.1,-2,3e-3],"buttons":3'),
                       ("set_number", '"key":"stiffness","value":750.5'),
                       ("set_choice", '"key":"field","value":"balanced"'),
                       ("set_switch", '"key":"friction","value":true'),
                       ("preset", '"name":"wood"'), ("pause", '"on":true'), ("record", '"on":false'), ("seek", '"time":2.5'),
                       ("play", '"on":true,"speed":0.5'),
                       ("points", '"points":1000'), ("ping", '"id":7')):
        seed("client_message", name, '{"type":"%s",%s}' % (name.split("_")[0], rest))
    seed("client_message", "reset", '{"type":"reset"}')


def haply():
    def frame(place='{"x":0.104,"y":-0.036,"z":-0.061}', velocity='{"x":0,"y":0.1,"z":-2e-3}',
              grip='"wireless_verse_grip":[{"device_id":"61576","state":{"orientation":{"w":1},'
                   '"buttons":{"a":true,"b":false,"c":true}}}]'):
        return ('{"inverse3":[{"device_id":"04EA","config":{"handedness":"right"},"state":'
                '{"cursor_position":%s,"cursor_velocity":%s,"control_mode":"idle"},'
                '"status":{"calibrated":true,"power_supply":true}}],%s}' % (place, velocity, grip))
    seed("haply_frame", "whole", frame())
    seed("haply_frame", "cable", frame(grip='"verse_grip":[{"state":{"button":true,"hall":3}}]'))
    seed("haply_frame", "null", frame(place='{"x":null,"y":0,"z":0}'))
    seed("haply_frame", "far", frame(velocity='{"x":1e300,"y":0,"z":0}'))
    seed("haply_frame", "none", '{"inverse3":[],"wireless_verse_grip":[]}')
    seed("haply_frame", "cut", frame()[:100])


def mcap():
    magic = b"\x89MCAP0\r\n"

    def text(words):
        return struct.pack("<I", len(words)) + words

    def record(op, content):
        return struct.pack("<BQ", op, len(content)) + content

    def zstd(data):  # one block that is not compressed
        return (b"\x28\xb5\x2f\xfd\xa0" + struct.pack("<I", len(data))
                + (len(data) << 3 | 1).to_bytes(3, "little") + data)

    def lz4(data):  # the same
        return (b"\x04\x22\x4d\x18\x60\x40\x82" + struct.pack("<I", len(data) | 1 << 31) + data
                + bytes(4))
    schema = record(3, struct.pack("<H", 1) + text(b"std_msgs/msg/Float64") + text(b"ros2msg")
                    + text(b"float64 data\n"))
    channel = record(4, struct.pack("<HH", 1, 1) + text(b"/a") + text(b"cdr")
                     + text(text(b"offered_qos_profiles") + text(b"")))
    messages = [record(5, struct.pack("<HIQQ", 1, i, 1000 * i, 1000 * i) + b"\0\1\0\0" + bytes(8))
                for i in (2, 1, 4)]
    head = magic + record(1, text(b"ros2") + text(b"seed"))

    def end(data, indexes=b"", chunks=0):
        data += record(15, bytes(4))
        statistics = record(11, struct.pack("<QHIIIIQQ", 3, 1, 1, 0, 0, chunks, 1000, 4000)
                            + text(struct.pack("<HQ", 1, 3)))
        summary = schema + channel + statistics + indexes
        foot = struct.pack("<BQQQ", 2, 20, len(data), 0)
        return data + summary + foot + struct.pack("<I", zlib.crc32(summary + foot)) + magic

    def chunked(kind, pack):
        records = schema + channel + b"".join(messages)
        packed = pack(records)
        times = struct.pack("<QQ", 1000, 4000)
        chunk = record(6, times + struct.pack("<QI", len(records), zlib.crc32(records)) + text(kind)
                       + struct.pack("<Q", len(packed)) + packed)
        index = record(7, struct.pack("<H", 1) + text(b"".join(
            struct.pack("<QQ", 1000 * i, len(schema + channel) + 43 * k)
            for k, i in enumerate((2, 1, 4)))))
        place = record(8, times + struct.pack("<QQ", len(head), len(chunk))
                       + text(struct.pack("<HQ", 1, len(head + chunk)))
                       + struct.pack("<Q", len(index)) + text(kind)
                       + struct.pack("<QQ", len(packed), len(records)))
        return end(head + chunk + index, place, 1)
    for name, pack in (("zstd", zstd), ("lz4", lz4), ("", bytes)):
        seed("mcap", name or "plain", chunked(name.encode(), pack))
    seed("mcap", "loose", end(head + schema + channel + b"".join(messages)))
    notes = struct.pack("<QQ", 1, 2) + text(b"a.txt") + text(b"text/plain") + struct.pack("<Q", 3) + b"abc"
    seed("mcap", "attached", head + record(9, notes + struct.pack("<I", zlib.crc32(notes)))
         + record(12, text(b"made") + text(text(b"by") + text(b"hand"))) + schema + channel + messages[0])


class Cdr:
    """A message of ROS 2 as bytes: its values, each aligned to its size, behind a head of four bytes."""

    def __init__(self, order="<"):
        self.order = order
        self.data = b""

    def put(self, codes, *values):
        for code, value in zip(codes, values):
            size = struct.calcsize(code)
            self.data += bytes(-len(self.data) % size) + struct.pack(self.order + code, value)
        return self

    def text(self, words):
        self.put("I", len(words) + 1)
        self.data += words.encode() + b"\0"
        return self

    def bytes(self, data):
        self.put("I", len(data))
        self.data += data
        return self

    def header(self):
        return self.put("iI", 5, 250_000_000).text("camera")

    def seed(self, name):
        seed("cdr", name, (b"\0\1\0\0" if self.order == "<" else b"\0\0\0\0") + self.data)


def messages():
    depths = struct.pack("<4H", 500, 0, 1000, 65535)
    for order, name in (("<", "image"), (">", "image_big_endian")):
        Cdr(order).header().put("II", 2, 2).text("16UC1").put("BI", order == ">", 4).bytes(depths).seed(name)
    Cdr().header().put("II", 1, 2).text("32FC1").put("BI", 0, 8).bytes(struct.pack("<2f", 0.5, 1)).seed("image_float")
    image = (CORPUS / "png" / "depth").read_bytes()
    Cdr().header().text("16UC1; png compressed").bytes(image).seed("png")
    head = struct.pack("<iff", 0, 0.5, 0.25)
    Cdr().header().text("32FC1; compressedDepth png").bytes(head + image).seed("compressed_depth")
    cloud = Cdr().header().put("III", 1, 2, 4)
    for name, offset, kind in (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("rgb", 12, 7)):
        cloud.text(name).put("IBI", offset, kind, 1)
    points = b"".join(struct.pack("<fffI", x, y, z, 0x102030) for x, y, z in POINTS[:2])
    cloud.put("BII", 0, 16, 32).bytes(points).put("B", 1).seed("cloud")
    for model, coefficients in (("plumb_bob", [0.1, 0.01, 0, 0, 0]),
                                ("rational_polynomial", [0.5, -0.1, 0, 0, 0.02, 0.45, -0.05, 0.01])):
        info = Cdr().header().put("II", 480, 640).text(model).put("I", len(coefficients))
        info.put("d" * len(coefficients), *coefficients)
        info.put("d" * 9, 525, 0, 320, 0, 525, 240, 0, 0, 1).put("d" * 9, 1, 0, 0, 0, 1, 0, 0, 0, 1)
        info.put("d" * 12, 525, 0, 320, 0, 0, 525, 240, 0, 0, 0, 1, 0).put("IIIIIIB", 0, 0, 0, 0, 0, 0, 0).seed(model)
    tree = Cdr().put("I", 2)
    for parent, child in (("world", "base"), ("base", "camera")):
        tree.put("iI", 5, 0).text(parent).text(child).put("d" * 7, 1, 2, 3, 0, 0, 0, 1)
    tree.seed("transforms")
    Cdr().header().put("d" * 7, 1, 2, 3, 0, 0, 0, 1).seed("pose")
    Cdr().header().put("Iff", 2, 0.5, -1).put("Iii", 2, 0, 1).seed("joy")
    Cdr().header().put("Q", 7).put("d" * 19, 0, 0, 0.6, 0.8, 0.02, 0, 0, 1.5, 0, 0.125, -0.25, 3, 0.5, 0, 0, 0, 0.1, -0.2, 2).seed("tool_step")
    Cdr().header().put("I", 1).text("elbow").put("Id", 1, 0.5).put("Id", 1, 0).put("I", 0).seed("joints")
    Cdr().header().put("IB", 1, 2).text("guard").text("off").text("").put("I", 1).text("key").text("value").seed("diagnostics")


def splats():
    """A flat square of 6 x 6 round splats, half opaque, in each format; large enough for a shell."""
    places = [(0.02 * i, 0.02 * j, 0.0) for i in range(6) for j in range(6)]
    sigmas = (0.001, 0.02, 0.02)
    n = len(places)
    logs = [math.log(x) for x in sigmas]
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {n}\n"
    names = ("x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3").split()
    columns = "".join(f"property float {name}\n" for name in names)
    turn = (0.5 ** 0.5, 0, 0.5 ** 0.5, 0)  # w x y z: the short axis along z
    seed("splat_ply", "trained", (head + columns + "end_header\n").encode() + b"".join(
        struct.pack("<14f", *p, 1, 0, -1, 2, *logs, *turn) for p in places))
    names = [f"{end}_{axis}" for what in ("", "scale_") for end in ("min", "max")
             for axis in (what + k for k in "xyz")]
    chunk = "".join(f"property float {name}\n" for name in names)
    packed = "".join(f"property uint packed_{name}\n" for name in ("position", "rotation", "scale", "color"))
    rows = b"".join(struct.pack("<4I", (j * 409) << 21 | (i * 204) << 11,
                                512 << 20 | 1023 << 10 | 512, 0, 0xc86432d0)
                    for i in range(6) for j in range(6))
    seed("splat_ply", "compressed", head.replace("element", f"element chunk 1\n{chunk}element").encode()
         + (packed + "end_header\n").encode()
         + struct.pack("<12f", 0, 0, 0, 0.1, 0.1, 0.01, *logs, *logs) + rows)
    seed("splat", "plain", b"".join(
        struct.pack("<6f8B", *p, *sigmas, 200, 100, 50, 220, 218, 128, 218, 128) for p in places))
    for version in (1, 2, 3):
        seed("spz", f"version{version}", spz_header(version, n)
             + b"".join(spz_columns(version, places, logs)))
    columns = spz_columns(4, places, logs)
    streams = [zstd_stored(column) for column in columns]
    table = b"".join(struct.pack("<QQ", len(s), len(c)) for s, c in zip(streams, columns))
    seed("spz", "version4", spz_header(4, n) + struct.pack("<I12x", 32) + table + b"".join(streams))


def spz_header(version, count):
    return b"NGSP" + struct.pack("<II4B", version, count, 0, 12, 0, 5 if version == 4 else 0)


def spz_columns(version, places, logs):
    """Positions, alphas, colours, scales, rotations."""
    def position(p):
        if version == 1:
            return struct.pack("<3e", *p)
        return b"".join(round(x * 4096).to_bytes(3, "little", signed=True) for x in p)
    turn = struct.pack("<I", 3 << 30 | 511 << 10) if version >= 3 else bytes([128, 218, 128])
    n = len(places)
    return [b"".join(map(position, places)), bytes([220]) * n, bytes([160, 128, 96]) * n,
            bytes(round(16 * (x + 10)) for x in logs) * n, turn * n]


def zstd_stored(data):
    """A zstd frame of one raw block."""
    return (struct.pack("<IBI", 0xfd2fb528, 0xa0, len(data))
            + (len(data) << 3 | 1).to_bytes(3, "little") + data)


def potree():
    """A root and a child of two points each, in either encoding, and a proxy to a chunk of its own."""
    types = {"position": ("int32", 3, 4), "intensity": ("uint16", 1, 2), "rgb": ("uint16", 3, 2)}
    attributes = [{"name": name, "size": n * size, "numElements": n, "elementSize": size, "type": kind}
                  for name, (kind, n, size) in types.items()]
    points = [tuple(round(1000 * x) for x in p) for p in POINTS]

    def interleave(numbers, first):
        return sum((x >> (first + bit) & 1) << (3 * bit + k) for bit in range(16) for k, x in enumerate(numbers))

    def node(packed, some):
        if not packed:
            return b"".join(struct.pack("<3iH3H", *points[i], 7, *COLORS[i]) for i in some)
        return brotli_stored(
            b"".join(struct.pack("<QQ", interleave(points[i], 16), interleave(points[i], 0)) for i in some)
            + struct.pack("<2H", 7, 8) + b"".join(struct.pack("<Q", interleave(COLORS[i], 0)) for i in some))

    for encoding in ("DEFAULT", "BROTLI"):
        root, child = (node(encoding == "BROTLI", some) for some in ((0, 3), (1, 2)))
        hierarchy = (struct.pack("<BBIQQ", 0, 2, 2, 0, len(root)) + struct.pack("<BBIQQ", 2, 0, 2, 44, 22)
                     + struct.pack("<BBIQQ", 1, 0, 2, len(root), len(child)))
        metadata = json.dumps({
            "version": "2.0", "points": 4, "hierarchy": {"firstChunkSize": 44}, "offset": [0, 0, 0],
            "scale": [0.001] * 3, "spacing": 0.01, "boundingBox": {"min": [0, 0, 0], "max": [1, 1, 1]},
            "encoding": encoding, "attributes": attributes}, separators=(",", ":")).encode()
        seed("potree", encoding.lower(), struct.pack("<2H", len(metadata), len(hierarchy)) + metadata + hierarchy
             + root + child)


def brotli_stored(data):
    """A brotli stream of one block that is not compressed, and an empty last one."""
    return (len(data) - 1 << 4 | 1 << 20).to_bytes(3, "little") + data + b"\x03"


for make in (ply, pcd, las, laz, depth, text, arrays, stl, gltf, packed, e57, sequences, remote, client_messages, haply, mcap,
             messages, splats, potree):
    make()
