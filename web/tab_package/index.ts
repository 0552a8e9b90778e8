// Puts a cloud that can be touched into a page of somebody else.

export interface Options {
  /** A cloud that a formula makes, or a simulated camera: "synthetic:torus", "camera:simulated:desk". Default: a rabbit. */
  cloud?: string;
  /** A file below the folder of `page`, in place of `cloud`: "clouds/scan.ply", "runs/dip.mcap". */
  at?: string;
  /** What a link of the page has as key=value: { stiffness: 800, friction: 0.5 }. */
  settings?: Record<string, string | number | boolean>;
  /** Eye, target and what is up, m, as in a link that the page makes. */
  view?: readonly [number, number, number, number, number, number, number, number, number];
  /** Address of index.html in the package's folder `page`, where that is not served beside index.js. */
  page?: string;
  /** What the frame is called for those who do not see it. */
  title?: string;
}

export interface Touched {
  readonly frame: HTMLIFrameElement;
  /** Touches this file in place of what is there: a cloud, a mesh or splats; a recording is replayed. The page says what is wrong with it. */
  open(file: File): Promise<void>;
  /** Takes the frame away, with all memory that it had. */
  close(): void;
}

const kHere: string | undefined = import.meta.url; // undefined in some bundles

/** Fills an element with a page in which mouse, finger, keys or a game controller touch a cloud. */
export function touch(element: Element, options: Options = {}): Touched {
  const { cloud, at, settings = {}, view, title = "A cloud to touch" } = options;
  const page = options.page ?? new URL("page/index.html", kHere).href;
  const address = new URL(page, document.baseURI);
  if (cloud !== undefined) address.searchParams.set("cloud", cloud);
  if (at !== undefined) address.searchParams.set("at", at);
  const parts = Object.entries(settings).map((pair) => pair.map(encodeURIComponent).join("="));
  if (view !== undefined) parts.push(`view=${view.join()}`);
  address.hash = parts.join("&");
  const frame = document.createElement("iframe");
  Object.assign(frame, { title, src: address.href, allow: "gamepad; clipboard-write" });
  frame.style.cssText = "display: block; width: 100%; height: 100%; border: 0";
  let settled: () => void;
  const loaded = new Promise<void>((resolve) => frame.addEventListener("load", settled = () => resolve(), { once: true }));
  element.append(frame);
  return {
    frame,
    async open(file) {
      await loaded;
      frame.contentWindow?.postMessage({ palpate: "open", file }, address.origin);
    },
    close() {
      frame.remove();
      settled();
    },
  };
}
