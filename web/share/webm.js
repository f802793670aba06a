// Writes a video as a WebM file: encoded pictures of one track, with its duration and an index, so that players can seek.
// Pure. See the specification of Matroska (RFC 9559), of whose elements WebM is a part.

/** @typedef {{data: Uint8Array, time: number, isKey: boolean}} EncodedPicture time in milliseconds */

const ID = {
  header: [0x1a, 0x45, 0xdf, 0xa3],
  version: [0x42, 0x86],
  readVersion: [0x42, 0xf7],
  longestId: [0x42, 0xf2],
  longestSize: [0x42, 0xf3],
  kind: [0x42, 0x82],
  kindVersion: [0x42, 0x87],
  kindReadVersion: [0x42, 0x85],
  segment: [0x18, 0x53, 0x80, 0x67],
  info: [0x15, 0x49, 0xa9, 0x66],
  scale: [0x2a, 0xd7, 0xb1],
  duration: [0x44, 0x89],
  muxer: [0x4d, 0x80],
  writer: [0x57, 0x41],
  tracks: [0x16, 0x54, 0xae, 0x6b],
  track: [0xae],
  trackNumber: [0xd7],
  trackUid: [0x73, 0xc5],
  trackType: [0x83],
  codec: [0x86],
  video: [0xe0],
  width: [0xb0],
  height: [0xba],
  cues: [0x1c, 0x53, 0xbb, 0x6b],
  cue: [0xbb],
  cueTime: [0xb3],
  cuePlaces: [0xb7],
  cueTrack: [0xf7],
  cueCluster: [0xf1],
  cluster: [0x1f, 0x43, 0xb6, 0x75],
  clusterTime: [0xe7],
  block: [0xa3],
};
const NAME = "Fleetplan";
const NANOSECONDS = 1_000_000; // in a unit of time: milliseconds
const VIDEO = 1; // type of a track
const TRACK = 1; // number of the only one
const KEY = 0x80; // flag of a block that needs no other block

/**
 * The parts of a file with these pictures, in their order; the first one is a key. `codec`: such as "V_VP8"; `duration` in
 * milliseconds.
 * @param {{codec: string, width: number, height: number, duration: number}} video
 * @param {EncodedPicture[]} pictures
 */
export function writeWebm({ codec, width, height, duration }, pictures) {
  const header = element(
    ID.header,
    element(ID.version, unsigned(1)),
    element(ID.readVersion, unsigned(1)),
    element(ID.longestId, unsigned(4)),
    element(ID.longestSize, unsigned(8)),
    element(ID.kind, text("webm")),
    element(ID.kindVersion, unsigned(4)),
    element(ID.kindReadVersion, unsigned(2)),
  );
  const info = element(
    ID.info,
    element(ID.scale, unsigned(NANOSECONDS)),
    element(ID.duration, real(duration)),
    element(ID.muxer, text(NAME)),
    element(ID.writer, text(NAME)),
  );
  const tracks = element(
    ID.tracks,
    element(
      ID.track,
      element(ID.trackNumber, unsigned(TRACK)),
      element(ID.trackUid, unsigned(TRACK)),
      element(ID.trackType, unsigned(VIDEO)),
      element(ID.codec, text(codec)),
      element(ID.video, element(ID.width, unsigned(width)), element(ID.height, unsigned(height))),
    ),
  );
  const clusters = clustersOf(pictures);
  const before = lengthOf([...info, ...tracks]);
  const cues = cuesOf(clusters, before + lengthOf(cuesOf(clusters, 0))); // their length is the same wherever they lead
  return [...header, ...element(ID.segment, info, tracks, cues, ...clusters.map(({ parts }) => parts))];
}

/** The pictures from each key to the next key: [{time, parts}]. */
function clustersOf(pictures) {
  /** @type {any[]} */
  const clusters = [];
  for (const picture of pictures) {
    if (picture.isKey) clusters.push({ time: picture.time, pictures: [] });
    clusters.at(-1).pictures.push(picture);
  }
  return clusters.map(({ time, pictures: own }) => ({
    time,
    parts: element(
      ID.cluster,
      element(ID.clusterTime, unsigned(time)),
      ...own.map((each) => blockOf(each, time)),
    ),
  }));
}

function blockOf({ data, time, isKey }, begin) {
  const head = new DataView(new ArrayBuffer(4));
  head.setUint8(0, 0x80 | TRACK);
  head.setInt16(1, time - begin);
  head.setUint8(3, isKey ? KEY : 0);
  return element(ID.block, [new Uint8Array(head.buffer), data]);
}

/** The index: where each cluster is, the first one `first` bytes from the beginning of the segment. */
function cuesOf(clusters, first) {
  let place = first;
  const cues = clusters.map(({ time, parts }) => {
    const at = place;
    place += lengthOf(parts);
    return element(
      ID.cue,
      element(ID.cueTime, unsigned(time)),
      element(ID.cuePlaces, element(ID.cueTrack, unsigned(TRACK)), element(ID.cueCluster, unsigned(at))),
    );
  });
  return element(ID.cues, ...cues);
}

/** An element as parts: its id, the length of what it contains, and that. */
function element(id, ...contents) {
  const parts = contents.flat();
  return [Uint8Array.from(id), sizeOf(lengthOf(parts)), ...parts];
}

const lengthOf = (parts) => parts.reduce((sum, part) => sum + part.length, 0);

/** A length in eight bytes, of which the first one tells that there are eight. */
function sizeOf(length) {
  const size = eightBytes((view) => view.setBigUint64(0, BigInt(length)));
  size[0] = 1;
  return size;
}

const unsigned = (value) => [eightBytes((view) => view.setBigUint64(0, BigInt(Math.round(value))))];

const real = (value) => [eightBytes((view) => view.setFloat64(0, value))];

const text = (words) => [new TextEncoder().encode(words)];

function eightBytes(write) {
  const bytes = new Uint8Array(8);
  write(new DataView(bytes.buffer));
  return bytes;
}
