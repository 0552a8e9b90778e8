// Makes an E57 file of scans (ASTM E2807), each with its points and the place of its scanner in m.

const kPage = 1020; // bytes of data; their CRC follows

function crc32c(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit += 1) crc = (crc >>> 1) ^ (crc & 1 ? 0x82f63b78 : 0);
  }
  return ~crc >>> 0;
}

function pagesOf(data) {
  const pages = [];
  for (let at = 0; at < data.length; at += kPage) {
    const page = Buffer.alloc(kPage + 4);
    data.copy(page, 0, at, at + kPage);
    page.writeUInt32BE(crc32c(page.subarray(0, kPage)), kPage);
    pages.push(page);
  }
  return Buffer.concat(pages);
}

/** Where a byte of the data is in the file. */
const placed = (at) => at + 4 * Math.floor(at / kPage);

/** A section of one packet: x, y and z of at most 2000 points. */
function section(points, at) {
  const packet = Buffer.alloc(12 + 24 * points.length);
  packet.writeUInt8(1, 0);
  packet.writeUInt16LE(packet.length - 1, 2);
  packet.writeUInt16LE(3, 4);
  for (let k = 0; k < 3; k += 1) {
    packet.writeUInt16LE(8 * points.length, 6 + 2 * k);
    points.forEach((point, i) => packet.writeDoubleLE(point[k], 12 + 8 * (k * points.length + i)));
  }
  const head = Buffer.alloc(32);
  head.writeUInt8(1, 0);
  head.writeBigUInt64LE(BigInt(head.length + packet.length), 8);
  head.writeBigUInt64LE(BigInt(placed(at + head.length)), 16);
  return Buffer.concat([head, packet]);
}

function described({ points, scanner: [x, y, z] }, at) {
  const columns = ["cartesianX", "cartesianY", "cartesianZ"].map((name) => `<${name} type="Float"/>`).join("");
  return `<vectorChild><pose><translation><x>${x}</x><y>${y}</y><z>${z}</z></translation></pose><points type="CompressedVector"
    fileOffset="${placed(at)}" recordCount="${points.length}"><prototype>${columns}</prototype></points></vectorChild>`;
}

export function e57(scans) {
  const head = Buffer.alloc(48);
  const parts = [head];
  let at = head.length;
  let children = "";
  for (const scan of scans) {
    children += described(scan, at);
    parts.push(section(scan.points, at));
    at += parts.at(-1).length;
  }
  const xml = Buffer.from(`<e57Root><data3D>${children}</data3D></e57Root>`);
  head.write("ASTM-E57");
  head.writeUInt32LE(1, 8);
  head.writeBigUInt64LE(BigInt(Math.ceil((at + xml.length) / kPage) * (kPage + 4)), 16);
  head.writeBigUInt64LE(BigInt(placed(at)), 24);
  head.writeBigUInt64LE(BigInt(xml.length), 32);
  head.writeBigUInt64LE(1024n, 40);
  return pagesOf(Buffer.concat([...parts, xml]));
}
