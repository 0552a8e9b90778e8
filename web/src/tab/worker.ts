// Runs the program in a worker: steps it to the clock, and hands on what page and program say. Each cloud has an instance of
// the module of its own, so what fails takes nothing along, and all of its memory goes with it.

import type { FromWorker, ToWorker } from "./messages";
import { kFirst, preparing, type Wanted } from "./wanted";

/** The module of src/tab. */
interface Core {
  HEAPU8: Uint8Array;
  UTF8ToString(at: number): string;
  _malloc(size: number): number;
  _free(at: number): void;
  _tab_open(name: number, bytes: number, size: number, unit: number, news: number): number; // null: it is touched
  _tab_connect(now: number): number; // null, or what ended the program; as of the next two
  _tab_receive(text: number, now: number): number;
  _tab_run(now: number): number;
}
declare const Tab: (options: object) => Promise<Core>;
declare function importScripts(path: string): void;
declare function postMessage(message: FromWorker, give?: Transferable[]): void;

const kByProgram = 0; // a request: a person chose something in its settings
const kMost = 512 * 2 ** 20; // bytes of a file, as of src/tab

importScripts("tab.js");
const decoder = new TextDecoder();
const compiled = compile();
let core: Core | undefined;
let touched: Wanted | undefined;
let opening = false;

/** Compiled while it comes, where the server says what it is. */
async function compile(): Promise<WebAssembly.Module> {
  const answer = await fetch("tab.wasm");
  if (!answer.ok) throw new Error(`tab.wasm: the server answers ${answer.status}`);
  if (answer.headers.get("Content-Type") === "application/wasm") return WebAssembly.compileStreaming(answer);
  return WebAssembly.compile(await answer.arrayBuffer());
}

async function instance(): Promise<Core> {
  const module = await compiled;
  return new Promise((resolve, reject) => void Tab({
    instantiateWasm(imports: WebAssembly.Imports, done: (made: WebAssembly.Instance, module: WebAssembly.Module) => void) {
      WebAssembly.instantiate(module, imports).then((made) => done(made, module), reject);
      return {};
    },
    say(bytes: Uint8Array, text: boolean) {
      if (text) return postMessage(decoder.decode(bytes));
      const { buffer } = bytes.slice();
      postMessage(buffer, [buffer]);
    },
    close: (code: number, why: string) => postMessage({ kind: "closed", code, why }),
    open: (name: string) => void another({ name }, kByProgram),
    openAgain: (unit: number) => void another({ ...touched!, unit, news: "" }, kByProgram),
    print() {},
    printErr() {}, // what goes wrong is said on the page
  }).then(resolve, reject));
}

const seconds = () => performance.now() / 1000;
const said = (error: unknown) => (error instanceof Error ? error.message : String(error));

function put(into: Core, bytes: Uint8Array): number {
  const at = into._malloc(bytes.length + 1);
  if (at === 0) throw new Error("it needs more memory than a tab may use; the program palpate can open it");
  into.HEAPU8.set(bytes, at);
  into.HEAPU8[at + bytes.length] = 0;
  return at;
}

const textIn = (into: Core, text: string) => put(into, new TextEncoder().encode(text));

async function fetched(at: string): Promise<ArrayBuffer> {
  const answer = await fetch(at, { redirect: "error" }); // another place was not asked for
  if (!answer.ok) throw new Error(`the server answers ${answer.status} ${answer.statusText}`);
  const size = Number(answer.headers.get("Content-Length"));
  if (size > kMost) throw new Error(`it has ${size} bytes, more than ${kMost}; the program palpate can open it`);
  return answer.arrayBuffer();
}

async function read(file: File): Promise<ArrayBuffer> {
  try {
    return await file.arrayBuffer();
  } catch {
    throw new Error(`${file.name} cannot be read: it was moved or has changed since; drop it again`);
  }
}

/** Makes what is wanted what is touched. Throws in words what is wrong; what was touched then stays. */
async function open(wanted: Wanted): Promise<void> {
  const { name, at, file, unit = 0, news = "" } = wanted;
  const bytes = at !== undefined ? await fetched(at) : file !== undefined ? await read(file) : undefined;
  const next = await instance();
  const start = bytes === undefined ? 0 : put(next, new Uint8Array(bytes));
  const texts = [textIn(next, name), textIn(next, news)] as const;
  const wrong = next._tab_open(texts[0], start, bytes?.byteLength ?? 0, unit, texts[1]);
  if (wrong !== 0) throw new Error(next.UTF8ToString(wrong));
  for (const each of texts) next._free(each); // the bytes are its own
  core = next;
  touched = wanted;
}

/** Calls the program, which ends where it says why. */
function call(act: (of: Core) => number): void {
  if (core === undefined) return;
  const wrong = act(core);
  if (wrong !== 0) throw new Error(core.UTF8ToString(wrong));
}

/** Words that name what they are of. */
function told(name: string, error: unknown): string {
  const words = said(error);
  return words.includes(name) ? words : `${name}: ${words}`;
}

async function first(wanted: Wanted): Promise<void> {
  try {
    await open(wanted).catch((error: unknown) => open({ name: kFirst, news: told(wanted.name, error) }));
    postMessage({ kind: "ready" });
    loop();
  } catch (error) {
    die(error);
  }
}

async function another(wanted: Wanted, request: number): Promise<void> {
  if (opening) return postMessage({ kind: "refused", request, words: `${wanted.name} is not opened: another one is being prepared` });
  opening = true;
  const work = (over: boolean) => postMessage(JSON.stringify({ type: "notice", level: "info", text: preparing(wanted), share: 0, over }));
  if (request === kByProgram) work(false);
  try {
    await open(wanted);
    postMessage({ kind: "another", request });
  } catch (error) {
    if (request === kByProgram) work(true);
    postMessage({ kind: "refused", request, words: told(wanted.name, error) });
  } finally {
    opening = false;
  }
}

function die(error: unknown): void {
  core = undefined;
  postMessage({ kind: "died", why: said(error) });
}

function loop(): void {
  if (core === undefined) return;
  setTimeout(loop); // browsers wait 4 ms at least
  try {
    call((of) => of._tab_run(seconds()));
  } catch (error) {
    die(error);
  }
}

function receive(text: string): void {
  call((of) => {
    const at = textIn(of, text);
    const wrong = of._tab_receive(at, seconds());
    of._free(at);
    return wrong;
  });
}

onmessage = ({ data }: MessageEvent<ToWorker>) => {
  try {
    if (typeof data === "string") receive(data);
    else if (data.kind === "connect") call((of) => of._tab_connect(seconds()));
    else if (core === undefined) void first(data.wanted);
    else void another(data.wanted, data.request);
  } catch (error) {
    die(error);
  }
};
