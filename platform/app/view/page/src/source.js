// Where the page's data come from: dicot's server, or, in an exported folder, script files beside the page, because a
// page that is opened as a file may not read others.
const exported = document.documentElement.dataset.source === "files";
const awaited = new Map();

const bytesOf = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

// What a script file calls.
globalThis.dicotData = (path, base64) => awaited.get(path)?.resolve(bytesOf(base64));
globalThis.dicotFault = (path, base64) => awaited.get(path)?.reject(new Error(new TextDecoder().decode(bytesOf(base64))));

function fromScript(path) {
    return new Promise((resolve, reject) => {
        awaited.set(path, { resolve, reject });
        const script = document.createElement("script");
        script.src = `${path}.js`;
        script.onerror = () => reject(new Error(`${path} is not in this folder`));
        script.onload = () => {
            reject(new Error(`${path}.js does not hold what it should`)); // nothing, if it did
            script.remove();
            awaited.delete(path);
        };
        document.head.append(script);
    });
}

async function fromServer(path) {
    let answer;
    try {
        answer = await fetch(path);
    } catch {
        throw new Error("dicot view does not answer: was it ended? Start it again, then reload this page");
    }
    if (!answer.ok)
        throw new Error(await answer.text());
    return new Uint8Array(await answer.arrayBuffer());
}

/// The bytes of a path of the site. Throws an Error whose message is a sentence for people.
export const readBytes = exported ? fromScript : fromServer;

export async function readJson(path) {
    return JSON.parse(new TextDecoder().decode(await readBytes(path)));
}

export const isExported = exported;
