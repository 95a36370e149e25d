// A cloud file as arrays: storage/FORMAT.md, "Cloud".
import createDraco from "draco3d/draco_decoder_nodejs.js";
import wasmBinary from "draco3d/draco_decoder.wasm";

const kMaxPoints = 4_194_304;
const kDamaged = "this cloud file is damaged; its other files may still be right";

let loading;

function checkHead(bytes) {
    const head = String.fromCharCode(...bytes.subarray(0, 5));
    if (bytes.length < 11 || head !== "DRACO")
        throw new Error("this is no cloud file: it does not begin as one");
    if (bytes[5] !== 2 || bytes[7] !== 0)
        throw new Error("this is no cloud of points that dicot wrote");
}

/// All values of an attribute, as they stand in the file.
function valuesOf(draco, decoder, cloud, kind, type, Values, parts) {
    const id = decoder.GetAttributeId(cloud, kind);
    if (id < 0)
        throw new Error(kDamaged);
    const count = cloud.num_points() * parts;
    const size = count * Values.BYTES_PER_ELEMENT;
    const at = draco._malloc(size);
    try {
        const attribute = decoder.GetAttribute(cloud, id);
        if (attribute.num_components() !== parts
            || !decoder.GetAttributeDataArrayForAllPoints(cloud, attribute, type, size, at))
            throw new Error(kDamaged);
        return new Values(draco.HEAPU8.buffer.slice(at, at + size));
    } finally {
        draco._free(at);
    }
}

function decode(draco, bytes) {
    const decoder = new draco.Decoder();
    const buffer = new draco.DecoderBuffer();
    const cloud = new draco.PointCloud();
    try {
        buffer.Init(bytes, bytes.length);
        const status = decoder.DecodeBufferToPointCloud(buffer, cloud);
        if (!status.ok() || cloud.ptr === 0 || cloud.num_points() < 1 || cloud.num_points() > kMaxPoints)
            throw new Error(kDamaged);
        const position = valuesOf(draco, decoder, cloud, draco.POSITION, draco.DT_FLOAT32, Float32Array, 3);
        if (!position.every(Number.isFinite))
            throw new Error(kDamaged);
        return {
            count: cloud.num_points(),
            position, // metres; x right, y down, z forward
            colour: valuesOf(draco, decoder, cloud, draco.COLOR, draco.DT_UINT8, Uint8Array, 3),
            confidence: valuesOf(draco, decoder, cloud, draco.GENERIC, draco.DT_FLOAT32, Float32Array, 1),
        };
    } finally {
        draco.destroy(cloud);
        draco.destroy(buffer);
        draco.destroy(decoder);
    }
}

/// Points in the file's order. Throws an Error whose message is a sentence for people.
export async function decodeCloud(bytes) {
    checkHead(bytes);
    loading ??= createDraco({ wasmBinary });
    const draco = await loading;
    try {
        return decode(draco, bytes);
    } catch (error) {
        if (error.message === kDamaged)
            throw error;
        loading = undefined; // the decoder itself fell: the next cloud gets another one
        throw new Error(kDamaged);
    }
}
